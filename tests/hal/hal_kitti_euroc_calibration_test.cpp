// Calibrations of KITTI odometry and of EuRoC.
#include <gtest/gtest.h>

#include <cmath>

#include "calibration/calibration.h"
#include "outcome_matchers.h"
#include "support/temp_folder.h"

namespace accrete::hal {
namespace {

using test::TempFolder;

const std::string kP0 = "P0: 700 0 600 0 0 710 180 0 0 0 1 0\n";
const std::string kP1 = "P1: 700 0 600 -350 0 710 180 0 0 0 1 0\n";

TEST(Kitti, GreyPairWithTwoLinesOnly) {
  const TempFolder folder;
  Calibration c;
  ASSERT_TRUE(succeeds(
      read_kitti_calibration(folder.write("calib.txt", "\xef\xbb\xbf" + kP0 + "\r\n" + kP1), KittiPair::kGrey, c)));
  EXPECT_EQ(c.rig.left.fx_px, 700);
  EXPECT_EQ(c.rig.left.cy_px, 180);
  EXPECT_DOUBLE_EQ(c.rig.T_r_l.translation[0], -0.5);
  EXPECT_EQ(c.rig.left.width_px, 0);
  EXPECT_TRUE(c.knows_body);
  EXPECT_EQ(norm(c.T_l_b.translation), 0);
  EXPECT_TRUE(fails(read_kitti_calibration(folder / "calib.txt", KittiPair::kColour, c), Status::kNotFound,
                    {"calib.txt", "P2", "image_2", "--calibration"}));
}

TEST(Kitti, ColourPairUsesAllThreeComponentsOfTheFourthColumn) {
  // t = K^-1 P[:,3]: z from the last row, and x and y lose cx z and cy z.
  const TempFolder folder;
  Calibration c;
  const std::string p2 = "P2: 700 0 600 44 0 700 180 -2 0 0 1 0.01\n",
                    p3 = "P3: 700 0 600 -340 0 700 180 1 0 0 1 0.004\n";
  ASSERT_TRUE(succeeds(
      read_kitti_calibration(folder.write("calib.txt", kP0 + kP1 + p2 + p3 + "Tr: 1 0\n"), KittiPair::kColour, c)));
  const Vec3 t2{(44 - 600 * 0.01) / 700, (-2 - 180 * 0.01) / 700, 0.01};
  const Vec3 t3{(-340 - 600 * 0.004) / 700, (1 - 180 * 0.004) / 700, 0.004};
  EXPECT_LT(norm(c.T_l_b.translation - t2), 1e-15);
  EXPECT_LT(norm(c.rig.T_r_l.translation - (t3 - t2)), 1e-15);
}

TEST(Kitti, RefusesWithTheLine) {
  const TempFolder folder;
  Calibration c;
  const auto read = [&](const std::string& text) {
    return read_kitti_calibration(folder.write("calib.txt", text), KittiPair::kGrey, c);
  };
  EXPECT_TRUE(fails(read(kP0 + "P1: 700 0 600 -350 0 710 180 0 0 0 1\n"), Status::kDataLoss,
                    {"calib.txt, line 2: P1", "11 numbers", "12"}));
  EXPECT_TRUE(fails(read(kP0 + "P1: 700 0 600 nan 0 710 180 0 0 0 1 0\n"), Status::kInvalidArgument,
                    {"line 2: P1", "value 4", "'nan'"}));
  EXPECT_TRUE(fails(read(kP0 + "P1: 700 1 600 -350 0 710 180 0 0 0 1 0\n"), Status::kInvalidArgument,
                    {"line 2: P1", "rectified"}));
  EXPECT_TRUE(
      fails(read(kP0 + "P1: 0 0 600 -350 0 710 180 0 0 0 1 0\n"), Status::kInvalidArgument, {"P1", "focal length"}));
  EXPECT_TRUE(fails(read(kP0 + kP1 + kP0), Status::kDataLoss, {"line 3: P0", "second time"}));
  EXPECT_TRUE(fails(read(kP0 + "P1: 700 0 600 350 0 710 180 0 0 0 1 0\n"), Status::kInvalidArgument,
                    {"calib.txt", "baseline is negative"}));
  EXPECT_TRUE(fails(read(kP0 + "P1: 700 0 600 0 0 710 180 0 0 0 1 0\n"), Status::kInvalidArgument,
                    {"calib.txt", "baseline is 0"}));
  EXPECT_TRUE(fails(read("nothing of ours\n"), Status::kNotFound, {"calib.txt", "P0"}));
}

TEST(Calibrations, AreToldApartByTheirContent) {
  const TempFolder folder;
  Calibration c;
  ASSERT_TRUE(succeeds(read_calibration_file(folder.write("whatever.yml", kP0 + kP1), KittiPair::kGrey, c)));
  EXPECT_NE(c.convention.find("KITTI"), std::string::npos);
}

std::string sensor(const std::string& T_BS, const std::string& model = "radial-tangential",
                   const std::string& coefficients = "-0.28, 0.07, 0.0002, 1.8e-05") {
  return "# comment\nsensor_type: camera\ncomment: VI-Sensor cam0 (MT9M034)\nT_BS:\n  cols: 4\n  rows: 4\n  data: [" +
         T_BS +
         "]\nrate_hz: 20\nresolution: [752, 480]\ncamera_model: pinhole\nintrinsics: [458.654, 457.296, 367.215, "
         "248.375]\n"
         "distortion_model: " +
         model + "\ndistortion_coefficients: [" + coefficients + "]\n";
}

// The camera's x is the body's y, its y the body's z, its z the body's x; cam1 0.11 m along the camera's x.
const std::string kCam0 = "0, 0, 1, 0.3, 1, 0, 0, 0.1, 0, 1, 0, -0.2, 0, 0, 0, 1";
const std::string kCam1 = "0, 0, 1, 0.3, 1, 0, 0, 0.21, 0, 1, 0, -0.2, 0, 0, 0, 1";

class Euroc : public testing::Test {
 protected:
  void SetUp() override {
    if (!ACCRETE_HAS_YAML) GTEST_SKIP() << "this build leaves YAML out";
  }
  Outcome read(const std::string& left, const std::string& right) {
    return read_euroc_pair(folder_.write("cam0/sensor.yaml", left), folder_.write("cam1/sensor.yaml", right), c_);
  }
  TempFolder folder_;
  Calibration c_;
};

TEST_F(Euroc, ReadsThePair) {
  ASSERT_TRUE(succeeds(read(sensor(kCam0), sensor(kCam1))));
  EXPECT_EQ(c_.rig.left.width_px, 752);
  EXPECT_EQ(c_.rig.left.cy_px, 248.375);
  EXPECT_EQ(c_.rig.left.distortion, Distortion::kBrownConrady);
  EXPECT_EQ(c_.rig.left.coefficients[3], 1.8e-05);
  EXPECT_LT(norm(c_.rig.T_r_l.translation - Vec3{-0.11, 0, 0}), 1e-15);
  // A point ahead of the body lies ahead of the camera.
  const Vec3 p = c_.T_l_b * Vec3{1.3, 0.1, -0.2};
  EXPECT_LT(norm(p - Vec3{0, 0, 1}), 1e-15);
  EXPECT_TRUE(c_.knows_body);
  ASSERT_TRUE(succeeds(read(sensor(kCam0, "equidistant"), sensor(kCam1, "none", ""))));
  EXPECT_EQ(c_.rig.left.distortion, Distortion::kKannalaBrandt);
  EXPECT_EQ(c_.rig.right.distortion, Distortion::kNone);
}

TEST_F(Euroc, RefusesWithFileAndKey) {
  EXPECT_TRUE(fails(read(sensor(kCam1), sensor(kCam0)), Status::kInvalidArgument,
                    {"cam0/sensor.yaml", "baseline is negative"}));
  EXPECT_TRUE(fails(read(sensor(kCam0), sensor(kCam0)), Status::kInvalidArgument, {"baseline is 0"}));
  EXPECT_TRUE(fails(read(sensor(kCam0), sensor("1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1")),
                    Status::kInvalidArgument, {"cam1/sensor.yaml, line 4: T_BS", "no rotation"}));
  EXPECT_TRUE(fails(read(sensor("1, 0, 0, 0"), sensor(kCam1)), Status::kInvalidArgument,
                    {"cam0/sensor.yaml", "T_BS", "4 values", "16"}));
  EXPECT_TRUE(fails(read(sensor("1,0,0,0, 0,1,0,0, 0,0,1,0, 5,0,0,1"), sensor(kCam1)), Status::kInvalidArgument,
                    {"T_BS", "0 0 0 1"}));
  EXPECT_TRUE(fails(read(sensor(kCam0, "radial-tangential", ".nan, 0, 0, 0"), sensor(kCam1)), Status::kInvalidArgument,
                    {"cam0/sensor.yaml", "distortion_coefficients", "'.nan'"}));
  EXPECT_TRUE(fails(read(sensor(kCam0, "fov"), sensor(kCam1)), Status::kUnsupported, {"'fov'", "equidistant"}));
  EXPECT_TRUE(fails(read("rate_hz: 200\n", sensor(kCam1)), Status::kNotFound, {"cam0/sensor.yaml", "intrinsics"}));
}

TEST(Yaml, ABuildWithoutItSaysSo) {
  if (ACCRETE_HAS_YAML) GTEST_SKIP() << "this build has YAML";
  Calibration c;
  const TempFolder folder;
  EXPECT_TRUE(fails(read_calibration_file(folder.write("a.yml", "a: 1\n"), KittiPair::kGrey, c), Status::kUnsupported,
                    {"a.yml", "ACCRETE_WITH_YAML"}));
}

}  // namespace
}  // namespace accrete::hal
