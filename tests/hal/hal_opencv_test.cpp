// OpenCV's stereo calibrations.
#include <gtest/gtest.h>

#include "calibration/calibration.h"
#include "outcome_matchers.h"
#include "tiny_recording.h"

namespace accrete::hal {
namespace {

using test::TempFolder;

class OpenCv : public testing::Test {
 protected:
  void SetUp() override {
    if (!ACCRETE_HAS_YAML) GTEST_SKIP() << "this build leaves YAML out";
  }
  Outcome read(const std::string& text) {
    const std::filesystem::path files[] = {folder_.write("stereo.yml", text)};
    return read_opencv_stereo(files, calibration_);
  }
  Outcome read(const StereoYml& yml) { return read(yml.text()); }

  TempFolder folder_;
  Calibration calibration_;
};

TEST_F(OpenCv, ReadsEveryValue) {
  ASSERT_TRUE(succeeds(read(StereoYml{})));
  const StereoRig& rig = calibration_.rig;
  EXPECT_EQ(rig.left.width_px, 4);
  EXPECT_EQ(rig.right.height_px, 3);
  EXPECT_EQ(rig.left.fx_px, 10);
  EXPECT_EQ(rig.left.fy_px, 11);
  EXPECT_EQ(rig.left.cx_px, 1.5);
  EXPECT_EQ(rig.right.cy_px, 1.1);
  EXPECT_EQ(rig.left.distortion, Distortion::kBrownConrady);
  EXPECT_EQ(rig.left.coefficients[1], 0.01);
  EXPECT_EQ(rig.left.coefficients[4], 0.003);
  EXPECT_EQ(rig.right.distortion, Distortion::kNone);  // all zero
  EXPECT_EQ(rig.T_r_l.translation, (Vec3{-0.1, 0, 0}));
  EXPECT_TRUE(calibration_.guesses.empty());
  EXPECT_FALSE(calibration_.knows_body);
}

TEST_F(OpenCv, AcceptsByteOrderMarkAndCarriageReturns) {
  std::string text = "\xef\xbb\xbf";
  for (const char c : StereoYml{}.text()) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  ASSERT_TRUE(succeeds(read(text)));
  EXPECT_EQ(calibration_.rig.left.fx_px, 10);
}

TEST_F(OpenCv, AcceptsAliasesAndNestedLists) {
  ASSERT_TRUE(
      succeeds(read("%YAML 1.2\n---\nimage_size: [4, 3]\nunits: m\nK1: [[10, 0, 1], [0, 10, 1], [0, 0, 1]]\n"
                    "dist_1: [0.1, 0, 0, 0, 0]\ncamera_matrix_2: [10, 0, 1, 0, 10, 1, 0, 0, 1]\n"
                    "distCoeffs2: []\nR: [1, 0, 0, 0, 1, 0, 0, 0, 1]\nT: [-0.1, 0, 0]\n")));
  EXPECT_EQ(calibration_.rig.left.fy_px, 10);
  EXPECT_EQ(calibration_.rig.left.height_px, 3);
}

TEST_F(OpenCv, TakesTheSizeFromTheImagesWhenThereIsNone) {
  StereoYml yml;
  yml.head = "units: m\n";
  ASSERT_TRUE(succeeds(read(yml)));
  EXPECT_EQ(calibration_.rig.left.width_px, 0);
  EXPECT_TRUE(says(calibration_.guesses, {"stereo.yml", "no image size"}));
}

TEST_F(OpenCv, TwoFilesCompleteEachOther) {
  const StereoYml yml;
  const std::string all = yml.text();
  const std::size_t cut = all.find("R: ");
  const std::filesystem::path files[] = {folder_.write("intrinsics.yml", all.substr(0, cut)),
                                         folder_.write("extrinsics.yml", all.substr(cut))};
  ASSERT_TRUE(succeeds(read_opencv_stereo(files, calibration_)));
  EXPECT_EQ(calibration_.rig.right.fx_px, 12);
}

TEST_F(OpenCv, Units) {
  StereoYml yml;
  yml.head = "image_width: 4\nimage_height: 3\nunits: mm\n";
  yml.T = "-83.2, 0.9, -0.1";
  ASSERT_TRUE(succeeds(read(yml)));
  EXPECT_NEAR(calibration_.rig.T_r_l.translation[0], -0.0832, 1e-15);
  yml.head = "image_width: 4\nimage_height: 3\n";
  EXPECT_TRUE(fails(read(yml), Status::kInvalidArgument, {"stereo.yml", "83.", "units: mm", "units: m"}));
  yml.T = "-0.1, 0, 0";
  ASSERT_TRUE(succeeds(read(yml)));
  EXPECT_TRUE(says(calibration_.guesses, {"stereo.yml", "metres are assumed", "units"}));
  yml.head = "image_width: 4\nimage_height: 3\nunits: parsec\n";
  EXPECT_TRUE(fails(read(yml), Status::kUnsupported, {"stereo.yml, line 3", "'parsec'", "m, cm or mm"}));
}

TEST_F(OpenCv, NumbersOfCoefficients) {
  StereoYml yml;
  for (const char* k : {"0.1,0,0,0", "0.1,0,0,0,0", "0.1,0,0,0,0,0,0,0", "0.1,0,0,0,0,0,0,0,0,0,0,0",
                        "0.1,0,0,0,0,0,0,0,0,0,0,0,0,0"}) {
    yml.D1 = k;
    EXPECT_TRUE(succeeds(read(yml))) << k;
    EXPECT_EQ(calibration_.rig.left.coefficients[0], 0.1);
  }
  yml.D1 = "0.1,0,0";
  EXPECT_TRUE(
      fails(read(yml), Status::kInvalidArgument, {"stereo.yml, line", "D1", "3 coefficients", "4, 5, 8 or 12"}));
  yml.D1 = "0.1,0,0,0,0,0,0,0,0,0,0,0,0.01,0";
  EXPECT_TRUE(fails(read(yml), Status::kUnsupported, {"D1", "tilted sensor", "calibrate without"}));
}

TEST_F(OpenCv, FourCoefficientsAreAGuessUnlessTheModelIsNamed) {
  StereoYml yml;
  yml.D1 = yml.D2 = "0.1, 0.01, 0.001, 0.002";
  ASSERT_TRUE(succeeds(read(yml)));
  EXPECT_EQ(calibration_.rig.left.distortion, Distortion::kBrownConrady);
  EXPECT_TRUE(says(calibration_.guesses, {"stereo.yml", "4 coefficients", "model: fisheye"}));
  for (const char* model :
       {"model: fisheye\n", "fisheye: 1\n", "distortion_model: equidistant\n", "model: Kannala-Brandt\n"}) {
    yml.head = std::string("image_width: 4\nimage_height: 3\nunits: m\n") + model;
    ASSERT_TRUE(succeeds(read(yml))) << model;
    EXPECT_EQ(calibration_.rig.left.distortion, Distortion::kKannalaBrandt);
    EXPECT_TRUE(calibration_.guesses.empty());
  }
  yml.D1 = "0.1,0,0,0,0";
  EXPECT_TRUE(fails(read(yml), Status::kInvalidArgument, {"D1", "5 coefficients", "fisheye", "4"}));
  yml.head = "units: m\nmodel: omni\n";
  EXPECT_TRUE(fails(read(yml), Status::kUnsupported, {"D1", "'omni'", "equidistant"}));
}

TEST_F(OpenCv, RefusesValuesThatCannotBeRight) {
  struct Case {
    const char* what;
    std::string StereoYml::*member;
    const char* text;
    std::vector<std::string_view> pieces;
  };
  const Case cases[] = {
      {"NaN", &StereoYml::M1, ".nan, 0., 1.5, 0., 11., 1., 0., 0., 1.", {"M1", "value 1", "'.nan'", "finite"}},
      {"NaN, OpenCV's way", &StereoYml::D1, "0.1, .Nan, 0., 0.", {"D1", "value 2", "finite"}},
      {"infinite", &StereoYml::T, "-.Inf, 0., 0.", {"T", "value 1", "finite"}},
      {"a word", &StereoYml::R, "1., 0., 0., 0., one, 0., 0., 0., 1.", {"R", "value 5", "'one'"}},
      {"focal length", &StereoYml::M2, "12., 0., 1.6, 0., -13., 1.1, 0., 0., 1.", {"right camera", "-13", "positive"}},
      {"transposed", &StereoYml::M1, "10., 0., 0., 0., 11., 0., 1.5, 1., 1.", {"M1", "no camera matrix"}},
      {"too short", &StereoYml::M1, "10., 0., 1.5", {"M1", "3 values", "9"}},
      {"scaled", &StereoYml::R, "2., 0., 0., 0., 2., 0., 0., 0., 2.", {"R", "no rotation", "differs", "3"}},
      {"mirrored", &StereoYml::R, "1., 0., 0., 0., 1., 0., 0., 0., -1.", {"R", "no rotation", "mirrors"}},
      {"zero baseline", &StereoYml::T, "0., 0., 0.", {"baseline is 0 m", "check the translation"}},
      {"negative baseline",
       &StereoYml::T,
       "0.1, 0., 0.",
       {"baseline is negative", "0.1 m", "Swap the eyes", "T[0] < 0"}},
      {"above each other", &StereoYml::T, "0., -0.1, 0.", {"no rig that works", "0.1"}},
  };
  for (const Case& c : cases) {
    StereoYml yml;
    yml.*c.member = c.text;
    const Outcome o = read(yml);
    EXPECT_TRUE(fails(o, Status::kInvalidArgument, {"stereo.yml"})) << c.what;
    for (const std::string_view piece : c.pieces) EXPECT_TRUE(fails(o, Status::kInvalidArgument, {piece})) << c.what;
  }
}

TEST_F(OpenCv, SaysWhatIsMissing) {
  const std::string all = StereoYml{}.text();
  for (const char* key : {"M1", "D1", "M2", "D2", "R", "T"}) {
    std::string text = all;
    text.replace(text.find(std::string("\n") + key + ":") + 1, 1, "x");
    EXPECT_TRUE(fails(read(text), Status::kNotFound, {"stereo.yml", key, "M1 D1 M2 D2 R T"})) << key;
  }
  EXPECT_TRUE(fails(read("cam0:\n  intrinsics: [1, 2, 3, 4]\n"), Status::kUnsupported, {"stereo.yml", "Kalibr"}));
}

TEST_F(OpenCv, SaysWhatIsNoYaml) {
  EXPECT_TRUE(
      fails(read("<?xml version=\"1.0\"?>\n<opencv_storage>"), Status::kUnsupported, {"stereo.yml", "XML", ".yml"}));
  EXPECT_TRUE(fails(read("just words"), Status::kDataLoss, {"stereo.yml", "no YAML map"}));
  EXPECT_TRUE(fails(read("a: [1, 2\nb: 3\n"), Status::kDataLoss, {"stereo.yml, line", "no YAML"}));
  EXPECT_TRUE(fails(read("R: 1\nT: 2\nR: 3\n"), Status::kDataLoss, {"stereo.yml, line 3: R", "second time"}));
  EXPECT_FALSE(read("a: " + std::string(20000, '[')).ok());
  EXPECT_FALSE(read(std::string(20000, '[')).ok());
  EXPECT_FALSE(read("a: &a [b, b]\nc: &c [*a, *a]\nM1: [*c, *c, *c, *c]\n").ok());
  std::string deep;
  for (int i = 0; i < 2000; ++i) deep += std::string(static_cast<std::size_t>(i), ' ') + "a:\n";
  EXPECT_FALSE(read(deep.substr(0, 900'000)).ok());
  EXPECT_TRUE(fails(read(std::string(2'000'000, ' ')), Status::kCapacityExceeded, {"stereo.yml", "2000000 bytes"}));
}

TEST_F(OpenCv, RefusesImpossibleSizes) {
  StereoYml yml;
  yml.head = "image_width: 0\nimage_height: 3\n";
  EXPECT_TRUE(fails(read(yml), Status::kInvalidArgument, {"stereo.yml", "no image size"}));
  yml.head = "image_width: 4.5\nimage_height: 3\n";
  EXPECT_TRUE(fails(read(yml), Status::kInvalidArgument, {"image_width: 4.5", "no image size"}));
  yml.head = "image_width: 4\nimage_height: 3.5\n";
  EXPECT_TRUE(fails(read(yml), Status::kInvalidArgument, {"image_height: 3.5", "no image size"}));
  yml.head = "image_width: 4\n";
  EXPECT_TRUE(fails(read(yml), Status::kNotFound, {"image_height"}));
}

}  // namespace
}  // namespace accrete::hal
