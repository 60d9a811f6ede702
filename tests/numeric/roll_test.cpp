#include <gtest/gtest.h>

#include "filter/roll_kernel.h"
#include "filter/update.h"
#include "numeric/dice.h"
#include "numeric/lane_bridge.h"

namespace accrete {
namespace {

using namespace oracle;

constexpr float kSigma = 0.8727F;  // 50 degrees

Edge rolled(const Edge& x, double roll) {
  Edge y = x;
  y.R = x.R * exp_so3({roll, 0, 0});
  return y;
}
Edge with_uncorrelated_roll(Dice& dice) {
  Edge x = dice.edge();
  x.P.row(3).setZero();
  x.P.col(3).setZero();
  x.P(3, 3) = 0.76;
  return x;
}
Edge updated_roll(const Edge& x, int times = 1) {
  std::vector<GeometryBlock> block(1);
  for (std::size_t l = 0; l < 16; ++l) store(record_of(x), block[0], l);
  const std::uint32_t slot = 2;
  UpdateOutcome outcome = UpdateOutcome::kBehind;
  for (int k = 0; k < times; ++k) {
    update_roll(block, {&slot, 1}, Pose().aligned(), Optics().aligned(), kSigma, {&outcome, 1});
    EXPECT_EQ(outcome, UpdateOutcome::kUpdated);
  }
  return state_of(load(block[0], 2));
}
// Angle about the tangent between local z and the line of sight, normal to the tangent.
double roll_error(const Edge& x) {
  const Vector3d ray = x.p - Vector3d(0.5 * Optics().baseline, 0, 0);
  return std::atan2(-ray.dot(x.R.col(1)), ray.dot(x.R.col(2)));
}

TEST(Roll, angle_is_that_of_atan2) {
  for (double angle = -3.13; angle < 3.14; angle += 0.01)
    EXPECT_NEAR(roll_towards(-std::sin(angle) * 3, std::cos(angle) * 3), angle, 1e-3);
  EXPECT_EQ(roll_towards(0.0F, 0.0F), 0.0F);
  EXPECT_TRUE(std::isfinite(roll_towards(1e-4F, -1.0F)));
}

TEST(Roll, is_the_scalar_kalman_update_of_the_roll) {
  Dice dice(1);
  for (int k = 0; k < 100; ++k) {
    const Edge x = rolled(with_uncorrelated_roll(dice), dice.uniform(-2.5, 2.5));
    const Edge y = updated_roll(x);
    const double gain = 0.76 / (0.76 + double{kSigma} * double{kSigma});
    EXPECT_NEAR(roll_error(y), (1 - gain) * roll_error(x), 2e-3);
    EXPECT_NEAR(y.P(3, 3), 0.76 * (1 - gain), 1e-5);
  }
}

TEST(Roll, turns_towards_the_viewer_and_narrows) {
  Dice dice(2);
  const Edge x = rolled(with_uncorrelated_roll(dice), 1.5);
  const Edge y = updated_roll(x, 20);
  EXPECT_LT(std::abs(roll_error(y)), 0.15);
  EXPECT_NEAR(y.P(3, 3), 1 / (1 / 0.76 + 20 / (double{kSigma} * double{kSigma})), 1e-4);
}

// The line and its uncertainty are the same before and after: only their description has turned.
TEST(Roll, moves_nothing_that_was_measured) {
  Dice dice(3);
  for (int k = 0; k < 100; ++k) {
    Edge x = rolled(dice.edge(), dice.uniform(-2, 2));
    const Edge y = updated_roll(x);
    EXPECT_LT((y.p - x.p).norm(), 1e-7);
    EXPECT_LT((y.R.col(0) - x.R.col(0)).norm(), 1e-6);
    // Position in the map and tilts as displacements of the tangent there, with their correlation.
    const auto in_map = [](const Edge& s) {
      Eigen::Matrix<double, 6, 6> J = Eigen::Matrix<double, 6, 6>::Zero();
      J.topLeftCorner<3, 3>() = s.R;
      J.block<3, 1>(3, 4) = -s.R.col(2);
      J.block<3, 1>(3, 5) = s.R.col(1);
      return Matrix6d(J * s.P * J.transpose());
    };
    EXPECT_LT((in_map(y) - in_map(x)).norm(), 2e-5 * in_map(x).norm());
    EXPECT_GT(smallest_scaled_eigenvalue(y.P), 0);
  }
}

TEST(Roll, is_reversal_invariant) {
  Dice dice(4);
  for (int k = 0; k < 50; ++k) {
    const Edge x = state_of(record_of(rolled(dice.edge(), dice.uniform(-2, 2))));
    const Edge y = updated_roll(state_of(reversed(record_of(x))));
    const Edge z = state_of(reversed(record_of(y)));
    EXPECT_LT((z.R - updated_roll(x).R).norm(), 1e-5);
    EXPECT_LT((z.P - updated_roll(x).P).norm(), 1e-5);
  }
}

TEST(Roll, behind_the_cameras_nothing_happens) {
  Dice dice(5);
  Edge x = dice.edge();
  x.p.z() = -1;
  std::vector<GeometryBlock> block(1);
  store(record_of(x), block[0], 0);
  const Geometry before = load(block[0], 0);
  const std::uint32_t slot = 0;
  UpdateOutcome outcome = UpdateOutcome::kUpdated;
  update_roll(block, {&slot, 1}, Pose().aligned(), Optics().aligned(), kSigma, {&outcome, 1});
  EXPECT_EQ(outcome, UpdateOutcome::kBehind);
  EXPECT_EQ(load(block[0], 0).quaternion, before.quaternion);
}

}  // namespace
}  // namespace accrete
