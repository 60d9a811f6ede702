// StereoRig and AlignedRig of accrete/camera.h.
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "accrete/camera.h"

namespace accrete {
namespace {

Quaternion about(Vec3 axis, double angle) {
  axis = (std::sin(angle / 2) / norm(axis)) * axis;
  return {axis[0], axis[1], axis[2], std::cos(angle / 2)};
}

StereoRig parallel() {
  StereoRig rig;
  rig.left = rig.right = {640, 480, 800, 800, 320, 240, Distortion::kNone, {}};
  rig.T_r_l.translation = {-0.12, 0, 0};
  return rig;
}

// Verged by 12 degrees, rolled by 5, right camera 2 cm lower and 3 cm ahead, other focal lengths.
StereoRig crooked() {
  StereoRig rig = parallel();
  rig.right.fx_px = 900;
  rig.right.fy_px = 910;
  const Quaternion R_l_r = about({0, 1, 0}, -0.21) * about({0, 0, 1}, 0.087) * about({1, 0, 0}, 0.03);
  rig.T_r_l = Transform<Left, Right>{R_l_r, {0.12, 0.02, 0.03}}.inverse();
  return rig;
}

TEST(Rig, AlignedRigOfAParallelOneIsItself) {
  const AlignedRig a = align(parallel());
  EXPECT_DOUBLE_EQ(a.focal_px, 800);
  EXPECT_DOUBLE_EQ(a.baseline_m, 0.12);
  const Mat3 identity{1, 0, 0, 0, 1, 0, 0, 0, 1};
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_NEAR(a.R_a_l[i], identity[i], 1e-15);
    EXPECT_NEAR(a.R_a_r[i], identity[i], 1e-15);
  }
}

TEST(Rig, CorrespondingPointsHaveEqualRowsAndTheDisparityOfTheirDepth) {
  const StereoRig rig = crooked();
  ASSERT_EQ(validate(rig), Status::kOk);
  const AlignedRig a = align(rig);
  EXPECT_DOUBLE_EQ(a.focal_px, 0.25 * (800 + 800 + 900 + 910));
  EXPECT_NEAR(a.baseline_m, std::sqrt(0.12 * 0.12 + 0.02 * 0.02 + 0.03 * 0.03), 1e-15);
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> side(-0.4, 0.4), depth(0.3, 3);
  for (int i = 0; i < 1000; ++i) {
    const double z = depth(rng);
    const Vec3 l{side(rng) * z, side(rng) * z, z};
    const Vec3 al = a.R_a_l * l, ar = a.R_a_r * (rig.T_r_l * l);
    ASSERT_GT(al[2], 0);
    EXPECT_NEAR(al[2], ar[2], 1e-14);
    const double f = a.focal_px;
    EXPECT_NEAR(f * al[1] / al[2], f * ar[1] / ar[2], 1e-10);
    EXPECT_NEAR(f * al[0] / al[2] - f * ar[0] / ar[2], f * a.baseline_m / al[2], 1e-10);
  }
}

TEST(Rig, AlignedAxesAreRotationsAndLookBetweenTheEyes) {
  const StereoRig rig = crooked();
  const AlignedRig a = align(rig);
  EXPECT_TRUE(to_quaternion(a.R_a_l, 1e-14).ok());
  EXPECT_TRUE(to_quaternion(a.R_a_r, 1e-14).ok());
  const Vec3 left = a.R_a_l * Vec3{0, 0, 1}, right = a.R_a_r * Vec3{0, 0, 1};
  EXPECT_NEAR(left[1], -right[1], 1e-14);  // the mean of the two directions has no component along y
}

TEST(Rig, RefusesWhatIsNoRig) {
  StereoRig rig = parallel();
  EXPECT_EQ(validate(rig), Status::kOk);
  for (const Vec3 t : {Vec3{0.12, 0, 0},                  // inverted, or the eyes swapped
                       Vec3{0, 0, 0}, Vec3{-1e-9, 0, 0},  // no baseline
                       Vec3{0, -0.12, 0},                 // one above the other
                       Vec3{-0.01, 0, -0.12},             // one behind the other
                       Vec3{std::numeric_limits<double>::quiet_NaN(), 0, 0}}) {
    rig.T_r_l.translation = t;
    EXPECT_EQ(validate(rig), Status::kInvalidArgument) << t[0] << ' ' << t[1] << ' ' << t[2];
  }
  rig = parallel();
  rig.T_r_l.rotation = {0, 0, 0, 1.1};
  EXPECT_EQ(validate(rig), Status::kInvalidArgument);
  rig = parallel();
  rig.T_r_l = Transform<Left, Right>{about({0, 1, 0}, 3.0), {0.12, 0, 0}}.inverse();  // looks backwards
  EXPECT_EQ(validate(rig), Status::kInvalidArgument);
  rig = parallel();
  rig.right.fx_px = -1;
  EXPECT_EQ(validate(rig), Status::kInvalidArgument);
}

}  // namespace
}  // namespace accrete
