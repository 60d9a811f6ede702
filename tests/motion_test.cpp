#include "accrete/motion.h"

#include <gtest/gtest.h>

#include <limits>

namespace accrete {
namespace {

const Quaternion kQuarterAboutY{0, std::sqrt(0.5), 0, std::sqrt(0.5)};

TEST(Motion, ObjectAndCameraPosesGiveTheMapSeenFromTheLeftCamera) {
  const Transform<Left, Object> T_l_o{kQuarterAboutY, {1, 2, 3}};
  const Motion object = Motion::object({7}, T_l_o);
  EXPECT_EQ(object.mode, MotionMode::kObjectMoves);
  EXPECT_EQ(object.error, PoseError::kAbsolute);
  EXPECT_EQ(object.t.ns, 7);
  EXPECT_LT(norm(object.T_l_m * Vec3{1, 0, 0} - T_l_o * Vec3{1, 0, 0}), 1e-15);

  const Transform<World, Left> T_w_l{kQuarterAboutY, {1, 2, 3}};
  const Motion camera = Motion::camera({7}, T_w_l);
  EXPECT_EQ(camera.mode, MotionMode::kCameraMoves);
  EXPECT_EQ(camera.error, PoseError::kIncremental);
  EXPECT_LT(norm(camera.T_l_m * (T_w_l * Vec3{4, 5, 6}) - Vec3{4, 5, 6}), 1e-14);
}

TEST(Motion, ValidateAcceptsExactMotionsAndDefiniteCovariancesOfAnyScale) {
  Motion m = Motion::object({0}, {kQuarterAboutY, {1, 2, 3}});
  EXPECT_EQ(validate(m), Status::kOk);  // zero: exactly known
  for (const double scale : {1e-12, 1e-6, 1.0, 1e6}) {
    m.covariance = diagonal_pose_covariance(3e-4 * scale, 1e-3 / scale);
    EXPECT_EQ(validate(m), Status::kOk) << scale;
    m.covariance[1] = m.covariance[6] = 9e-8 * scale * scale * (1 - 1e-6);
    EXPECT_EQ(validate(m), Status::kOk) << scale;
  }
}

TEST(Motion, ValidateRefusesSingularCovariances) {
  Motion m = Motion::object({0}, {kQuarterAboutY, {1, 2, 3}});
  m.covariance = diagonal_pose_covariance(3e-4, 1e-3);
  m.covariance[1] = m.covariance[6] = 9e-8;  // one error is the other
  EXPECT_EQ(validate(m), Status::kInvalidArgument);
  m.covariance[1] = m.covariance[6] = 9e-8 * (1 - 1e-10);  // or nearly so
  EXPECT_EQ(validate(m), Status::kInvalidArgument);
  m.covariance = diagonal_pose_covariance(0, 1e-3);
  EXPECT_EQ(validate(m), Status::kInvalidArgument);
  m.covariance = diagonal_pose_covariance(1e-3, 1e-3);
  m.covariance[21] = 0;
  EXPECT_EQ(validate(m), Status::kInvalidArgument);
  m.covariance.fill(1);  // rank one
  EXPECT_EQ(validate(m), Status::kInvalidArgument);
}

TEST(Motion, ValidateRefuses) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Motion good = Motion::object({0}, {kQuarterAboutY, {1, 2, 3}});
  Motion m = good;
  m.T_l_m.translation[1] = nan;
  EXPECT_EQ(validate(m), Status::kInvalidArgument);
  m = good;
  m.T_l_m.rotation = {0, 0, 0, 1.0001};
  EXPECT_EQ(validate(m), Status::kInvalidArgument);
  m = good;
  m.T_l_m.rotation.x = nan;
  EXPECT_EQ(validate(m), Status::kInvalidArgument);
  m = good;
  m.covariance = diagonal_pose_covariance(1e-3, 1e-3);
  m.covariance[1] = 5e-7;  // not symmetric
  EXPECT_EQ(validate(m), Status::kInvalidArgument);
  m.covariance[1] = m.covariance[6] = 1.01e-6;  // correlation above one
  EXPECT_EQ(validate(m), Status::kInvalidArgument);
  m.covariance = diagonal_pose_covariance(1e-3, 1e-3);
  m.covariance[0] = -1e-6;
  EXPECT_EQ(validate(m), Status::kInvalidArgument);
  m.covariance[0] = 0;
  m.covariance[1] = m.covariance[6] = 1e-9;  // correlated with an error that does not exist
  EXPECT_EQ(validate(m), Status::kInvalidArgument);
  m.covariance[0] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(validate(m), Status::kInvalidArgument);
  // Pairwise correlations of -0.6 among three: each pair is fine, the whole is not.
  m.covariance = diagonal_pose_covariance(1, 1);
  for (const int i : {0, 1, 2})
    for (const int j : {0, 1, 2})
      if (i != j) m.covariance[static_cast<std::size_t>(6 * i + j)] = -0.6;
  EXPECT_EQ(validate(m), Status::kInvalidArgument);
}

}  // namespace
}  // namespace accrete
