// Interpolation of poses, and the constant motion.
#include <gtest/gtest.h>

#include <limits>

#include "accrete/hal/recording.h"
#include "motion/pose_motion.h"
#include "outcome_matchers.h"

namespace accrete::hal {
namespace {

constexpr std::int64_t kMs = 1'000'000;

Quaternion about_z(double angle) { return {0, 0, std::sin(angle / 2), std::cos(angle / 2)}; }

// 0, 20, 40 ms, then a hole until 200 ms: 1 m and 0.1 rad each 20 ms.
std::vector<StampedPose> track() {
  return {{{0}, about_z(0), {0, 0, 1}, 1},
          {{20 * kMs}, about_z(0.1), {1, 0, 1}, 2},
          {{40 * kMs}, about_z(0.2), {2, 0, 1}, 3},
          {{200 * kMs}, about_z(1.0), {10, 0, 1}, 4}};
}

TEST(PoseMotion, InterpolatesAlongTheArc) {
  PoseMotion source(track(), {}, "poses.txt");
  Motion m;
  ASSERT_TRUE(succeeds(source.at({25 * kMs}, m)));
  EXPECT_EQ(m.t.ns, 25 * kMs);
  EXPECT_EQ(m.mode, MotionMode::kObjectMoves);
  EXPECT_NEAR(m.T_l_m.translation[0], 1.25, 1e-15);
  EXPECT_NEAR(rotation_angle(m.T_l_m.rotation), 0.125, 1e-15);
  EXPECT_EQ(validate(m), Status::kOk);
  EXPECT_TRUE(m.covariance_is_default);
  ASSERT_TRUE(succeeds(source.at({40 * kMs}, m)));
  EXPECT_EQ(m.T_l_m.translation[0], 2);
}

TEST(PoseMotion, BridgesNoLongGapAndExtrapolatesNothing) {
  PoseMotion source(track(), {}, "poses.txt");
  Motion m;
  EXPECT_TRUE(fails(source.at({100 * kMs}, m), Status::kNotFound,
                    {"0.1 s", "poses.txt", "gap of 0.16 s", "0.05 s", "--max-pose-gap"}));
  EXPECT_TRUE(fails(source.at({-kMs}, m), Status::kNotFound, {"-0.001 s", "covers 0 s to 0.2 s"}));
  EXPECT_TRUE(fails(source.at({201 * kMs}, m), Status::kNotFound, {"0.201 s", "covers"}));
  // Stamps that were rounded to milliseconds still meet their poses, the nearer one of two.
  ASSERT_TRUE(succeeds(source.at({200 * kMs + 400'000}, m)));
  EXPECT_EQ(m.T_l_m.translation[0], 10);
  ASSERT_TRUE(succeeds(source.at({40 * kMs + 400'000}, m)));
  EXPECT_EQ(m.T_l_m.translation[0], 2);
  EXPECT_FALSE(source.at({200 * kMs + 600'000}, m).ok());
  PoseMotionSettings wide;
  wide.max_gap_ns = 160 * kMs;
  PoseMotion patient(track(), wide, "poses.txt");
  ASSERT_TRUE(succeeds(patient.at({120 * kMs}, m)));
  EXPECT_NEAR(m.T_l_m.translation[0], 6, 1e-14);
  EXPECT_FALSE(PoseMotion({}, {}, "poses.txt").at({0}, m).ok());
}

TEST(PoseMotion, CarriesModeErrorAndCovariance) {
  PoseMotionSettings s;
  s.mode = MotionMode::kCameraMoves;
  s.error = PoseError::kAbsolute;
  s.covariance = diagonal_pose_covariance(0.01, 0.02);
  s.covariance_is_default = false;
  PoseMotion source(track(), s, "poses.txt");
  Motion m;
  ASSERT_TRUE(succeeds(source.at({20 * kMs}, m)));
  EXPECT_EQ(m.mode, MotionMode::kCameraMoves);
  EXPECT_EQ(m.error, PoseError::kAbsolute);
  EXPECT_DOUBLE_EQ(m.covariance[35], 4e-4);
  EXPECT_FALSE(m.covariance_is_default);
  // T_world_left was given: the camera's own place in the world is its origin.
  EXPECT_LT(norm(m.T_l_m * Vec3{1, 0, 1}), 1e-15);
}

TEST(ConstantMotion, AnswersAtEveryTime) {
  std::unique_ptr<MotionSource> source;
  ASSERT_TRUE(succeeds(constant_motion(Motion::object({0}, {about_z(0.3), {1, 2, 3}}), source)));
  Motion m;
  ASSERT_TRUE(succeeds(source->at({77}, m)));
  EXPECT_EQ(m.t.ns, 77);
  EXPECT_EQ(m.T_l_m.translation, (Vec3{1, 2, 3}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(fails(constant_motion(Motion::object({0}, {about_z(0), {nan, 2, 3}}), source), Status::kInvalidArgument,
                    {"constant motion"}));
  EXPECT_EQ(source, nullptr);
}

}  // namespace
}  // namespace accrete::hal
