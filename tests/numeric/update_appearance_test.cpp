#include <gtest/gtest.h>

#include <limits>

#include "filter/appearance_kernel.h"
#include "filter/update.h"
#include "numeric/dice.h"
#include "numeric/lane_bridge.h"

namespace accrete {
namespace {

using namespace oracle;
using Vector7d = Eigen::Matrix<double, 7, 1>;
using Matrix7d = Eigen::Matrix<double, 7, 7>;

struct Look {
  Vector7d mean;
  Matrix7d P;
};
Look random_look(Dice& dice, double sigma_phase = 0.3, double sigma_colour = 0.1) {
  Look x;
  x.mean << dice.uniform(-3.1, 3.1), dice.uniform(0, 1), dice.uniform(0, 1), dice.uniform(0, 1), dice.uniform(0, 1),
      dice.uniform(0, 1), dice.uniform(0, 1);
  VectorXd sigma = VectorXd::Constant(7, sigma_colour);
  sigma[0] = sigma_phase;
  x.P = dice.covariance(sigma);
  return x;
}
AppearanceState record_of(const Look& x) {
  AppearanceState a;
  a.mean.phase = static_cast<float>(x.mean[0]);
  for (std::size_t i = 0; i < 3; ++i) {
    a.mean.left[i] = static_cast<float>(x.mean[static_cast<Eigen::Index>(1 + i)]);
    a.mean.right[i] = static_cast<float>(x.mean[static_cast<Eigen::Index>(4 + i)]);
  }
  for (int i = 0; i < 7; ++i)
    for (int j = i; j < 7; ++j) a.covariance[packed_index(7, i, j)] = static_cast<float>(x.P(i, j));
  return a;
}
Look look_of(const AppearanceState& a) {
  Look x;
  x.mean << a.mean.phase, a.mean.left[0], a.mean.left[1], a.mean.left[2], a.mean.right[0], a.mean.right[1],
      a.mean.right[2];
  for (int i = 0; i < 7; ++i)
    for (int j = i; j < 7; ++j) x.P(i, j) = x.P(j, i) = a.covariance[packed_index(7, i, j)];
  return x;
}
Vector7d vector_of(const Appearance& a) { return look_of({a, {}}).mean; }

AppearanceState update(const AppearanceState& a, const Appearance& z, float sigma_phase, float sigma_colour,
                       float q_phase = 0, float q_colour = 0, UpdateOutcome* outcome = nullptr) {
  std::vector<AppearanceBlock> block(1);
  for (std::size_t l = 0; l < 16; ++l) store(a, block[0], l);
  const std::uint32_t slot = 9;
  UpdateOutcome o;
  update_appearance(block, {&slot, 1}, {&z, 1}, {&sigma_phase, 1}, {&sigma_colour, 1}, {&sigma_colour, 1},
                    {&q_phase, 1}, {&q_colour, 1}, {&o, 1});
  if (outcome != nullptr) *outcome = o;
  EXPECT_EQ(load(block[0], 8).mean.phase, a.mean.phase);  // the neighbours
  return load(block[0], 9);
}

Appearance observation(Dice& dice, const Look& x, double sigma_phase, double sigma_colour) {
  Appearance z;
  z.phase = static_cast<float>(std::remainder(x.mean[0] + sigma_phase * dice.normal(), 2 * M_PI));
  for (std::size_t i = 0; i < 3; ++i) {
    z.left[i] = static_cast<float>(x.mean[static_cast<Eigen::Index>(1 + i)] + sigma_colour * dice.normal());
    z.right[i] = static_cast<float>(x.mean[static_cast<Eigen::Index>(4 + i)] + sigma_colour * dice.normal());
  }
  return z;
}

// The whole 13-dimensional state: sigma points of pose and appearance together, all eleven residuals at once. The seven
// of the appearance come out as the linear update gives them, because the covariance is block-diagonal.
TEST(UpdateAppearance, is_the_appearance_part_of_the_13_dimensional_unscented_update) {
  Dice dice(1);
  const Optics optics;
  for (int k = 0; k < 30; ++k) {
    const Edge pose_state = dice.edge(2e-3, 0.15, 0.8);
    const Look look = random_look(dice);
    const std::vector<Observation> o = {
        {0, dice.observe(pose_state, Pose(), optics, 0, 0.5, 0.05, 2)},
        {optics.baseline, dice.observe(pose_state, Pose(), optics, optics.baseline, 0.5, 0.05, 2)}};
    const Appearance z = observation(dice, look, 0.2, 0.05);
    const double sigma_phase = 0.25, sigma_colour = 0.04, q_phase = 4e-3, q_colour = 2e-4;

    MatrixXd P = MatrixXd::Zero(13, 13);
    P.topLeftCorner<6, 6>() = pose_state.P;
    P.bottomRightCorner<7, 7>() = look.P;
    P(6, 6) += q_phase;
    for (int i = 7; i < 13; ++i) P(i, i) += q_colour;
    const Moments m = unscented(P, [&](const VectorXd& d) {
      VectorXd r(11);
      r.head<4>() = residuals(moved(pose_state, d.head<6>()), Pose(), optics, o);
      r.tail<7>() = vector_of(z) - (look.mean + d.tail<7>());
      r[4] = std::remainder(r[4], 2 * M_PI);
      return r;
    });
    MatrixXd S = m.covariance;
    S.diagonal() += (VectorXd(11) << 0.25, 2.5e-3, 0.25, 2.5e-3, sigma_phase * sigma_phase,
                     VectorXd::Constant(6, sigma_colour * sigma_colour))
                        .finished();
    const MatrixXd K = -m.cross * S.inverse();
    const VectorXd step = K * m.mean;
    const MatrixXd posterior = P - K * S * K.transpose();

    LaneAppearance<double> lane;
    double value[7], noise[7], process[7];
    for (int i = 0; i < 7; ++i) {
      lane.mean[i] = look.mean[i];
      for (int j = i; j < 7; ++j) lane.P(i, j) = look.P(i, j);
      value[i] = vector_of(z)[i];
      noise[i] = i == 0 ? sigma_phase * sigma_phase : sigma_colour * sigma_colour;
      process[i] = i == 0 ? q_phase : q_colour;
    }
    ASSERT_TRUE(update_appearance(lane, value, noise, process));
    for (int i = 0; i < 7; ++i)
      EXPECT_NEAR(std::remainder(lane.mean[i] - look.mean[i] - step[6 + i], 2 * M_PI), 0, 1e-6);
    EXPECT_LT((to_matrix(lane.P) - posterior.bottomRightCorner<7, 7>()).norm(), 1e-12);
    EXPECT_LT((posterior.topRightCorner<6, 7>()).norm(), 1e-12);  // and the blocks stay apart
  }
}

TEST(UpdateAppearance, float_lanes_agree_with_the_kalman_update_in_double) {
  Dice dice(2);
  for (int k = 0; k < 100; ++k) {
    const AppearanceState a = record_of(random_look(dice));
    const Look x = look_of(a);
    const Appearance z = observation(dice, x, 0.2, 0.05);
    const Look y = look_of(update(a, z, 0.25F, 0.04F, 4e-3F, 2e-4F));
    Matrix7d P = x.P, R = Matrix7d::Identity() * 0.04 * 0.04;
    P.diagonal().array() += 2e-4;
    P(0, 0) += 4e-3 - 2e-4;
    R(0, 0) = 0.0625;
    const Matrix7d K = P * (P + R).inverse();
    Vector7d innovation = vector_of(z) - x.mean;
    innovation[0] = std::remainder(innovation[0], 2 * M_PI);
    Vector7d expected = x.mean + K * innovation;
    for (int i = 0; i < 7; ++i) EXPECT_NEAR(std::remainder(y.mean[i] - expected[i], 2 * M_PI), 0, 2e-6);
    EXPECT_LT((y.P - (P - K * P)).norm(), 1e-5 * P.norm());
  }
}

// From a prior that is a million times less certain than what is seen to one that is a million times more certain, and
// correlated: in float, in sigmas of the posterior.
TEST(UpdateAppearance, any_ratio_of_prior_to_noise_is_as_in_double) {
  Dice dice(6);
  for (int k = 0; k < 400; ++k) {
    const double ratio = std::pow(10.0, dice.uniform(-3, 3));  // of standard deviations
    const Look look = random_look(dice, 0.1 * ratio, 0.02 * ratio);
    LaneAppearance<float> lane;
    float value[7], noise[7], process[7] = {};
    Matrix7d P, R = Matrix7d::Zero();
    Vector7d mean, innovation;
    for (int i = 0; i < 7; ++i) {
      const double sigma = (i == 0 ? 0.1 : 0.02) * dice.uniform(0.5, 2);
      lane.mean[i] = static_cast<float>(i == 0 ? 0.0 : look.mean[i]);
      value[i] = lane.mean[i] + static_cast<float>(sigma * std::min(ratio, 10.0) * dice.normal());
      noise[i] = static_cast<float>(sigma * sigma);
      R(i, i) = double{noise[i]};
      mean[i] = double{lane.mean[i]};
      innovation[i] = double{value[i]} - mean[i];
      for (int j = i; j < 7; ++j) P(i, j) = P(j, i) = double{lane.P(i, j) = static_cast<float>(look.P(i, j))};
    }
    innovation[0] = std::remainder(innovation[0], 2 * M_PI);
    const Matrix7d K = P * (P + R).inverse(), posterior = K * R;
    ASSERT_TRUE(update_appearance(lane, value, noise, process));
    const Vector7d sigma = posterior.diagonal().cwiseSqrt(), expected = mean + K * innovation;
    for (int i = 0; i < 7; ++i) {
      const double difference = double{lane.mean[i]} - expected[i];
      // Three roundings of what is added up, and half a digit of the mean itself.
      EXPECT_NEAR(i == 0 ? std::remainder(difference, 2 * M_PI) : difference, 0,
                  1e-3 * sigma[i] + 1e-7 * (std::abs(expected[i]) + std::abs(innovation[i])));
      for (int j = i; j < 7; ++j)
        EXPECT_NEAR(double{lane.P(i, j)}, posterior(i, j), 1e-3 * sigma[i] * sigma[j]) << ratio;
    }
  }
}

TEST(UpdateAppearance, the_phase_goes_the_short_way_round) {
  Look x;
  x.mean << 3.1, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5;
  x.P = Matrix7d::Identity() * 0.01;
  Appearance z{-3.1F, {0.5F, 0.5F, 0.5F}, {0.5F, 0.5F, 0.5F}};
  const float phase = update(record_of(x), z, 0.1F, 0.1F).mean.phase;
  EXPECT_NEAR(std::abs(phase), M_PI, 1e-5);  // half-way between 3.1 and -3.1, and in (-pi, pi]
  EXPECT_LE(phase, 3.1415928F);
  EXPECT_GT(phase, -3.1415928F);
}

TEST(UpdateAppearance, wrapped_phase_stays_in_its_interval) {
  for (float a = -9.4F; a < 9.4F; a += 0.01F) {
    const float w = wrap_phase(a);
    EXPECT_LE(w, kHalfTurn);
    EXPECT_GE(w, -kHalfTurn);
    EXPECT_NEAR(std::remainder(double{a} - double{w}, 2 * M_PI), 0, 1e-6);
  }
  EXPECT_EQ(wrap_phase(-kHalfTurn), kHalfTurn);
}

TEST(UpdateAppearance, is_reversal_invariant) {
  Dice dice(3);
  for (int k = 0; k < 50; ++k) {
    const AppearanceState a = record_of(random_look(dice));
    const Appearance z = observation(dice, look_of(a), 0.4, 0.1);
    const Look x = look_of(update(a, z, 0.25F, 0.04F, 1e-3F, 1e-4F));
    const Look y = look_of(reversed(update(reversed(a), reversed(z), 0.25F, 0.04F, 1e-3F, 1e-4F)));
    EXPECT_LT((x.mean - y.mean).norm(), 1e-5);
    EXPECT_LT((x.P - y.P).norm(), 1e-6);
  }
}

TEST(UpdateAppearance, covariances_stay_positive_definite) {
  Dice dice(4);
  for (int k = 0; k < 1000; ++k) {
    Look x = random_look(dice, std::pow(10, dice.uniform(-3, 0)), std::pow(10, dice.uniform(-4, 0)));
    AppearanceState a = record_of(x);
    for (int n = 0; n < 5; ++n) {
      UpdateOutcome outcome;
      a = update(a, observation(dice, x, 0.3, 0.1), static_cast<float>(std::pow(10, dice.uniform(-4, 1))),
                 static_cast<float>(std::pow(10, dice.uniform(-4, 1))), static_cast<float>(dice.uniform(0, 1e-3)), 0,
                 &outcome);
      ASSERT_GT(smallest_scaled_eigenvalue(look_of(a).P), 0);
      ASSERT_TRUE(look_of(a).mean.allFinite());
    }
  }
}

TEST(UpdateAppearance, a_failure_leaves_every_bit) {
  Dice dice(5);
  AppearanceState a = record_of(random_look(dice));
  Appearance z = observation(dice, look_of(a), 0.1, 0.1);
  UpdateOutcome outcome;
  z.left[1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(update(a, z, 0.1F, 0.1F, 1, 1, &outcome).covariance, a.covariance);
  EXPECT_EQ(outcome, UpdateOutcome::kNotPositiveDefinite);
  z.left[1] = 0;
  a.covariance[packed_index(7, 3, 3)] = -2;
  EXPECT_EQ(update(a, z, 0.1F, 0.1F, 0, 0, &outcome).mean.phase, a.mean.phase);
  EXPECT_EQ(outcome, UpdateOutcome::kNotPositiveDefinite);
}

}  // namespace
}  // namespace accrete
