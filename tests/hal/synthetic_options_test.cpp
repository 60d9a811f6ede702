// The synthetic scene: repeatability, noise as asked for, and options that make no sense.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "hal/synthetic_images.h"

namespace accrete::hal {
namespace {

std::uint64_t hash(const std::vector<std::uint8_t>& bytes) {  // FNV-1a
  std::uint64_t h = 0xcbf29ce484222325ULL;
  for (const std::uint8_t b : bytes) h = (h ^ b) * 0x100000001b3ULL;
  return h;
}

TEST(Synthetic, TheSameSeedGivesTheSameBytes) {
  SyntheticOptions o;
  o.frames = 3;
  const Film a = shoot("box", o), b = shoot("box", o);
  ASSERT_EQ(a.shots.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(a.shots[i].left.rgb, b.shots[i].left.rgb);
    EXPECT_EQ(a.shots[i].right.rgb, b.shots[i].right.rgb);
  }
  EXPECT_NE(a.shots[0].left.rgb, a.shots[0].right.rgb);
  o.seed = 2;
  EXPECT_NE(shoot("box", o).shots[0].left.rgb, a.shots[0].left.rgb);
}

// A change of the scene or of its arithmetic shows here; every compiler and processor must agree.
TEST(Synthetic, TheDefaultPicturesAreTheOnesOnRecord) {
  SyntheticOptions o;
  o.frames = 2;
  const Film film = shoot("box", o);
  EXPECT_EQ(hash(film.shots[1].left.rgb), 0x6c073e16ef06692bULL) << std::hex << hash(film.shots[1].left.rgb);
  EXPECT_EQ(hash(film.shots[1].right.rgb), 0x97fcdb0aece2c074ULL) << std::hex << hash(film.shots[1].right.rgb);
}

TEST(Synthetic, ImageNoiseIsWhatWasAskedFor) {
  SyntheticOptions o;
  o.frames = 1;
  o.noise_levels = 0;
  const Film clean = shoot("box-plain", o);
  o.noise_levels = 3;
  const Film noisy = shoot("box-plain", o);
  double sum = 0, squares = 0, product = 0;
  std::size_t n = 0;
  const auto& a = clean.shots[0].left.rgb;
  const auto& b = noisy.shots[0].left.rgb;
  for (std::size_t i = 0; i + 3 < a.size(); ++i, ++n) {
    const double d = double(b[i]) - a[i];
    sum += d;
    squares += d * d;
    product += d * (double(b[i + 3]) - a[i + 3]);
  }
  const double count = static_cast<double>(n);
  EXPECT_NEAR(sum / count, 0, 0.25);  // even areas: the clean picture rounds all of them the same way
  EXPECT_NEAR(std::sqrt(squares / count), std::sqrt(9 + 2.0 / 12), 0.1);  // two roundings
  EXPECT_NEAR(product / squares, 0, 0.03);                                // neighbours know nothing of each other
}

TEST(Synthetic, PoseNoiseIsIndependentAndItsCovarianceSaysSo) {
  SyntheticOptions o;
  o.frames = 400;
  std::unique_ptr<StereoSource> stereo;
  std::unique_ptr<MotionSource> exact, noisy;
  ASSERT_TRUE(open_synthetic("box", o, stereo, exact).ok());
  o.pose_noise_m = 3e-4;
  o.pose_noise_rad = 1e-3;
  ASSERT_TRUE(open_synthetic("box", o, stereo, noisy).ok());
  double shift = 0, turn = 0, product = 0;
  Vec3 before{};
  for (int i = 0; i < 400; ++i) {
    Motion a, b;
    ASSERT_TRUE(exact->at({i * 33'333'333LL}, a).ok());
    ASSERT_TRUE(noisy->at({i * 33'333'333LL}, b).ok());
    EXPECT_EQ(validate(b), Status::kOk);
    EXPECT_EQ(b.error, PoseError::kAbsolute);
    EXPECT_FALSE(b.covariance_is_default);
    EXPECT_DOUBLE_EQ(b.covariance[0], 9e-8);
    EXPECT_DOUBLE_EQ(b.covariance[35], 1e-6);
    EXPECT_DOUBLE_EQ(a.covariance[0], 0);
    const Vec3 d = b.T_l_m.translation - a.T_l_m.translation;
    const double angle = rotation_angle(b.T_l_m.rotation * conjugate(a.T_l_m.rotation));
    shift += dot(d, d);
    turn += angle * angle;
    product += dot(d, before);
    before = d;
  }
  EXPECT_NEAR(std::sqrt(shift / 1200), 3e-4, 3e-5);
  EXPECT_NEAR(std::sqrt(turn / 1200), 1e-3, 1e-4);
  EXPECT_LT(std::abs(product / shift), 0.15);
}

TEST(Synthetic, AFullTurnEndsWhereItBegan) {
  SyntheticOptions o;
  o.frames = 61;
  o.degrees_per_frame = 6;
  std::unique_ptr<StereoSource> stereo;
  std::unique_ptr<MotionSource> motion;
  ASSERT_TRUE(open_synthetic("box", o, stereo, motion).ok());
  Motion first, next, last;
  ASSERT_TRUE(motion->at({0}, first).ok());
  ASSERT_TRUE(motion->at({33'333'333}, next).ok());
  ASSERT_TRUE(motion->at({60 * 33'333'333LL}, last).ok());
  EXPECT_NEAR(rotation_angle(first.T_l_m.rotation * conjugate(last.T_l_m.rotation)), 0, 1e-6);
  EXPECT_NEAR(rotation_angle(first.T_l_m.rotation * conjugate(next.T_l_m.rotation)), 6 * 3.14159265 / 180, 1e-6);
}

TEST(Synthetic, MotionExistsAtItsFramesOnly) {
  SyntheticOptions o;
  std::unique_ptr<StereoSource> stereo;
  std::unique_ptr<MotionSource> motion;
  ASSERT_TRUE(open_synthetic("box", o, stereo, motion).ok());
  EXPECT_EQ(stereo->size(), 60U);
  Motion m;
  EXPECT_TRUE(motion->at({33'400'000}, m).ok());
  for (const std::int64_t t :
       {std::int64_t{15'000'000}, std::int64_t{-5'000'000}, std::int64_t{60} * 33'333'333, INT64_MIN, INT64_MAX}) {
    const Outcome outcome = motion->at({t}, m);
    EXPECT_EQ(outcome.status, Status::kNotFound);
    EXPECT_NE(outcome.message.find(std::to_string(t)), std::string::npos);
  }
}

TEST(Synthetic, SaysWhatIsWrongWithTheOptions) {
  std::unique_ptr<StereoSource> stereo;
  std::unique_ptr<MotionSource> motion;
  const Outcome unknown = open_synthetic("bix", {}, stereo, motion);
  EXPECT_EQ(unknown.status, Status::kNotFound);
  for (const SyntheticScene& scene : synthetic_scenes())
    EXPECT_NE(unknown.message.find(scene.name), std::string::npos) << unknown.message;

  const auto refused = [&](const char* name, auto change) {
    SyntheticOptions o;
    change(o);
    Truth truth;
    const Outcome outcome = open_synthetic(name, o, stereo, motion);
    EXPECT_EQ(synthetic_truth(name, o, truth).status, outcome.status);
    return outcome.status == Status::kInvalidArgument && outcome.message.size() > 20;
  };
  EXPECT_TRUE(refused("box", [](auto& o) { o.frames = 0; }));
  EXPECT_TRUE(refused("box", [](auto& o) { o.frames = 2'000'000'000; }));
  EXPECT_TRUE(refused("box", [](auto& o) { o.noise_levels = -1; }));
  EXPECT_TRUE(refused("box", [](auto& o) { o.noise_levels = NAN; }));
  EXPECT_TRUE(refused("box", [](auto& o) { o.pose_noise_m = 1; }));
  EXPECT_TRUE(refused("box", [](auto& o) { o.pose_noise_rad = INFINITY; }));
  EXPECT_TRUE(refused("box", [](auto& o) { o.pose_noise_rad = 1e-3; }));  // with exact positions: a singular covariance
  EXPECT_TRUE(refused("box", [](auto& o) { o.degrees_per_frame = NAN; }));
  EXPECT_TRUE(refused("room", [](auto& o) { o.degrees_per_frame = 2; }));
  EXPECT_TRUE(refused("room", [](auto& o) { o.gripper = true; }));
  EXPECT_EQ(stereo, nullptr);
}

TEST(Synthetic, WritesItsTruthAsTheScorerReadsIt) {
  SyntheticOptions o;
  o.frames = 4;
  Truth truth;
  ASSERT_TRUE(synthetic_truth("box", o, truth).ok());
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "accrete_synthetic_truth";
  std::filesystem::remove_all(folder);
  ASSERT_TRUE(write_truth(truth, folder).ok());
  for (const char* name : {"edges.csv", "extra.csv", "background.csv", "bbox.txt"})
    EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
  std::ifstream file(folder / "edges.csv");
  std::string line;
  ASSERT_TRUE(std::getline(file, line));
  EXPECT_EQ(
      line,
      "x0,y0,z0,x1,y1,z1,nx,ny,nz,mx,my,mz,left_r,left_g,left_b,right_r,right_g,right_b,kind,visible,visible_both");
  std::size_t rows = 0;
  while (std::getline(file, line)) {
    std::vector<std::string> fields;
    std::stringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) fields.push_back(cell);
    ASSERT_EQ(fields.size(), 21U) << line;
    const TruthSegment& s = truth.edges[rows++];
    EXPECT_NEAR(std::stod(fields[0]), s.p0[0], 1e-9);
    EXPECT_NEAR(std::stod(fields[5]), s.p1[2], 1e-9);
    EXPECT_NEAR(std::stod(fields[15]), s.right[0], 1e-4);
    EXPECT_EQ(fields[18], s.kind == TruthKind::kCrease ? "crease" : "albedo");
    EXPECT_EQ(fields[9].empty(), s.kind == TruthKind::kAlbedo);
  }
  EXPECT_EQ(rows, truth.edges.size());

  const Outcome outcome = write_truth(truth, folder / "edges.csv");  // a file is in the way
  EXPECT_EQ(outcome.status, Status::kUnavailable);
  EXPECT_NE(outcome.message.find("edges.csv"), std::string::npos);
}

}  // namespace
}  // namespace accrete::hal
