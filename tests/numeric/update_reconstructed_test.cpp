// The update by a reconstructed primitive against the Kalman update in double, written plainly.
#include <gtest/gtest.h>

#include "filter/reconstructed_kernel.h"
#include "filter/update.h"
#include "numeric/dice.h"
#include "numeric/lane_bridge.h"

namespace accrete {
namespace {

using namespace oracle;

// A covariance of errors in the frame of `from`, in that of `to`; `roll` is the part about the tangent of the turn from
// `to` to `from`.
Matrix6d in_frame(const Matrix6d& P, const Edge& from, const Edge& to, double roll) {
  Matrix6d J = Matrix6d::Identity();
  J.topLeftCorner<3, 3>() = to.R.transpose() * from.R;
  J.bottomRightCorner<3, 3>() = exp_so3({roll, 0, 0});
  return J * P * J.transpose();
}

// `observed` = x [+] d, with its own covariance.
Edge kalman(const Edge& x, const Edge& observed, const Vector6d& d) {
  const Matrix6d R = in_frame(observed.P, observed, x, d[3]);
  const Matrix6d K = x.P * (x.P + R).inverse();
  const Vector6d e = K * d;
  Edge y = moved(x, e);
  y.P = in_frame(K * R, x, y, -e[3]);
  return y;
}

struct Case {
  Edge x, observed;
  Vector6d d;
};
Case random_case(Dice& dice) {
  Case c;
  c.x = dice.edge();
  c.d << 2e-3 * dice.normal3(), dice.uniform(-1, 1), 0.1 * dice.normal(), 0.1 * dice.normal();
  c.observed = moved(c.x, c.d);
  Vector6d sigma;
  sigma << 1e-3, 1e-3, 4e-3, 0.8, 0.05, 0.07;
  c.observed.P = dice.covariance(sigma);
  return c;
}

double difference(const Edge& a, const Edge& b) {
  const Vector6d s = b.P.diagonal().cwiseSqrt().cwiseInverse();
  return std::max({(s.head<3>().cwiseProduct(a.p - b.p)).norm(), (a.R - b.R).norm() * s.tail<3>().minCoeff(),
                   (s.asDiagonal() * (a.P - b.P) * s.asDiagonal()).norm()});
}

TEST(UpdateReconstructed, is_the_kalman_update) {
  Dice dice(1);
  for (int k = 0; k < 200; ++k) {
    const Case c = random_case(dice);
    LaneState<double> x = to_lane<double>(c.x), z = to_lane<double>(c.observed);
    ASSERT_TRUE(update_reconstructed(x, z));
    // The chart of our own is right to 2e-7 of an angle up to 1 rad.
    EXPECT_LT(difference(to_state(x), kalman(c.x, c.observed, c.d)), 1e-4);
  }
}

TEST(UpdateReconstructed, sigma_points_would_give_the_same) {
  Dice dice(2);
  for (int k = 0; k < 20; ++k) {
    Case c = random_case(dice);
    c.d[3] = 0;
    c.observed = [&] {
      Edge z = moved(c.x, c.d);
      z.P = c.observed.P;
      return z;
    }();
    const Moments m = unscented(c.x.P, [](const VectorXd& d) { return d; });
    const MatrixXd S = m.covariance + in_frame(c.observed.P, c.observed, c.x, 0);
    const MatrixXd K = m.cross * S.inverse();
    const Matrix6d P = c.x.P - K * S * K.transpose();
    LaneState<double> x = to_lane<double>(c.x), z = to_lane<double>(c.observed);
    ASSERT_TRUE(update_reconstructed(x, z));
    Edge expected = moved(c.x, K * c.d);
    expected.P = in_frame(P, c.x, expected, -(K * c.d)[3]);
    EXPECT_LT(difference(to_state(x), expected), 1e-4);
  }
}

TEST(UpdateReconstructed, float_lanes_agree_with_the_oracle_and_touch_nothing_else) {
  Dice dice(3);
  constexpr std::size_t kN = 53;
  std::vector<GeometryBlock> blocks(8), observed((kN + 15) / 16);
  for (GeometryBlock& b : blocks)
    for (std::size_t l = 0; l < 16; ++l) store(record_of(dice.edge()), b, l);
  std::vector<Case> cases;
  std::vector<std::uint32_t> slots;
  for (std::size_t i = 0; i < kN; ++i) {
    Case c = random_case(dice);
    const auto slot = static_cast<std::uint32_t>(i < 20 ? i : 2 * i);  // neighbours, then scattered
    store(record_of(c.x), blocks[slot / 16], slot % 16);
    store(record_of(c.observed), observed[i / 16], i % 16);
    cases.push_back(c);
    slots.push_back(slot);
  }
  const std::vector<GeometryBlock> before = blocks;
  std::vector<UpdateOutcome> outcomes(kN);
  update_reconstructed(blocks, slots, observed, outcomes);
  for (std::size_t i = 0; i < kN; ++i) {
    EXPECT_EQ(outcomes[i], UpdateOutcome::kUpdated);
    const Edge y = state_of(load(blocks[slots[i] / 16], slots[i] % 16));
    EXPECT_LT(difference(y, kalman(cases[i].x, cases[i].observed, cases[i].d)), 5e-3) << i;
    EXPECT_GT(smallest_scaled_eigenvalue(y.P), 0);
  }
  for (std::uint32_t s = 0; s < 128; ++s) {
    if (std::find(slots.begin(), slots.end(), s) != slots.end()) continue;
    const Geometry a = load(before[s / 16], s % 16), b = load(blocks[s / 16], s % 16);
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.covariance, b.covariance);
  }
}

// A prior that knows nothing, and an observation that knows nothing.
TEST(UpdateReconstructed, any_ratio_of_prior_to_noise_leaves_a_covariance) {
  Dice dice(4);
  for (const double ratio : {1e-8, 1e-4, 1e4, 1e8}) {
    for (int k = 0; k < 50; ++k) {
      Case c = random_case(dice);
      c.observed.P = c.x.P / ratio;
      c.d = c.x.P.llt().matrixL() * dice.normals(6) * 0.3;
      Edge z = moved(c.x, c.d);
      z.P = c.observed.P;
      LaneState<float> x = to_lane<float>(c.x), o = to_lane<float>(z);
      ASSERT_TRUE(update_reconstructed(x, o)) << ratio;
      const Edge y = to_state(x);
      EXPECT_GT(smallest_scaled_eigenvalue(y.P), 0);
      const double smaller = std::min(1.0, 1 / ratio);
      EXPECT_NEAR(y.P.trace() / (c.x.P.trace() * smaller), 1, 0.6);
    }
  }
}

TEST(UpdateReconstructed, what_is_no_gaussian_leaves_every_bit) {
  Dice dice(5);
  const Case c = random_case(dice);
  for (const bool damage_state : {true, false}) {
    Geometry x = record_of(c.x), z = record_of(c.observed);
    (damage_state ? x : z).covariance[0] = -1;
    std::vector<GeometryBlock> blocks(1), observed(1);
    for (std::size_t l = 0; l < 16; ++l) {
      store(x, blocks[0], l);
      store(z, observed[0], l);
    }
    const std::uint32_t slot = 3;
    UpdateOutcome outcome = UpdateOutcome::kUpdated;
    update_reconstructed(blocks, {&slot, 1}, observed, {&outcome, 1});
    EXPECT_EQ(outcome, UpdateOutcome::kNotPositiveDefinite);
    EXPECT_EQ(load(blocks[0], 3).covariance, x.covariance);
    EXPECT_EQ(load(blocks[0], 3).quaternion, x.quaternion);
  }
}

}  // namespace
}  // namespace accrete
