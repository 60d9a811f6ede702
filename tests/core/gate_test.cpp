// Residuals and likelihoods of association against their definitions, sampling and symmetry.
#include "associate/gate.h"

#include <gtest/gtest.h>

#include "core/rig.h"

namespace accrete::associate {
namespace {

using test::Dice;

// A prediction with a random covariance of both eyes: about 0.5 px and 0.03 rad, correlated.
PredictedObservation random_prediction(Dice& dice) {
  PredictedObservation p;
  const auto place = [&](float& x, float& y, float& c, float& s) {
    x = static_cast<float>(dice.uniform(-200, 200));
    y = static_cast<float>(dice.uniform(-200, 200));
    const double theta = dice.uniform(-3.14, 3.14);
    c = static_cast<float>(std::cos(theta));
    s = static_cast<float>(std::sin(theta));
  };
  place(p.x_l, p.y_l, p.c_l, p.s_l);
  place(p.x_r, p.y_r, p.c_r, p.s_r);
  const double scale[4] = {0.4, 0.02, 0.4, 0.02};
  double a[4][4];
  for (auto& row : a)
    for (double& v : row) v = dice.normal();
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i; j < 4; ++j) {
      double v = 0;
      for (std::size_t k = 0; k < 4; ++k) v += a[i][k] * a[j][k];
      p.covariance[packed_index(4, i, j)] = static_cast<float>(v * scale[i] * scale[j]);
    }
  p.depth_m = 1;
  p.valid = true;
  return p;
}
PredictedObservation reversed(const PredictedObservation& p) {
  PredictedObservation r = p;
  r.c_l = -p.c_l, r.s_l = -p.s_l, r.c_r = -p.c_r, r.s_r = -p.s_r;
  const float sign[4] = {-1, 1, -1, 1};  // the normal turns round, the angle stays
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i; j < 4; ++j) r.covariance[packed_index(4, i, j)] *= sign[i] * sign[j];
  return r;
}
Residual of(const PredictedObservation& p, int eye, const LineElement& o) {
  return eye == 0 ? residual(p.x_l, p.y_l, p.c_l, p.s_l, o) : residual(p.x_r, p.y_r, p.c_r, p.s_r, o);
}
// An observation n px to the right of the predicted line, turned by `angle`, `slide` px along it.
LineElement beside(const PredictedObservation& p, int eye, double n, double angle, double slide) {
  const double x = eye == 0 ? p.x_l : p.x_r, y = eye == 0 ? p.y_l : p.y_r;
  const double c = eye == 0 ? p.c_l : p.c_r, s = eye == 0 ? p.s_l : p.s_r;
  LineElement o;
  o.x_px = static_cast<float>(x + slide * c - n * s);
  o.y_px = static_cast<float>(y + slide * s + n * c);
  o.c = static_cast<float>(c * std::cos(angle) - s * std::sin(angle));
  o.s = static_cast<float>(s * std::cos(angle) + c * std::sin(angle));
  o.sigma_n_px = 0.3F;
  o.sigma_theta = 0.03F;
  return o;
}

TEST(Gate, residual_is_offset_angle_and_slide) {
  Dice dice(1);
  for (int k = 0; k < 200; ++k) {
    const PredictedObservation p = random_prediction(dice);
    const double n = dice.uniform(-5, 5), angle = dice.uniform(-0.7, 0.7), slide = dice.uniform(-5, 5);
    for (int eye = 0; eye < 2; ++eye) {
      const Residual r = of(p, eye, beside(p, eye, n, angle, slide));
      EXPECT_NEAR(r.n_px, n, 1e-4);
      EXPECT_NEAR(r.sine, std::sin(angle), 1e-6);
      EXPECT_NEAR(r.slide_px, slide, 1e-4);
      EXPECT_FALSE(r.reversed);
    }
  }
}

TEST(Gate, residuals_and_likelihoods_are_blind_to_reversal) {
  Dice dice(2);
  const Noise noise{0.02F, 1e-4F};
  for (int k = 0; k < 200; ++k) {
    const PredictedObservation p = random_prediction(dice), q = reversed(p);
    const LineElement l = beside(p, 0, dice.normal(), dice.normal(0.05), dice.uniform(-4, 4));
    const LineElement r = beside(p, 1, dice.normal(), dice.normal(0.05), dice.uniform(-4, 4));
    const Residual a = of(p, 0, l), b = of(p, 0, accrete::reversed(l)), c = of(q, 0, l);
    EXPECT_NEAR(b.n_px, a.n_px, 1e-5);
    EXPECT_NEAR(b.sine, a.sine, 1e-6);
    EXPECT_NEAR(b.slide_px, a.slide_px, 1e-5);
    EXPECT_NE(b.reversed, a.reversed);
    EXPECT_NEAR(c.n_px, -a.n_px, 1e-5);  // of a reversed prediction: the normal has turned round
    EXPECT_NEAR(c.sine, a.sine, 1e-6);
    EXPECT_NE(c.reversed, a.reversed);
    const Likelihood both = stereo_likelihood(p, a, l, of(p, 1, r), r, noise);
    const Likelihood turned = stereo_likelihood(q, c, l, of(q, 1, r), r, noise);
    const Likelihood one = mono_likelihood(p, 0, a, l, noise), one_turned = mono_likelihood(q, 0, c, l, noise);
    EXPECT_NEAR(turned.d2, both.d2, 2e-3F * (1 + both.d2));
    EXPECT_NEAR(turned.log_g, both.log_g, 2e-3F * (1 + both.d2));
    EXPECT_NEAR(one_turned.d2, one.d2, 2e-3F * (1 + one.d2));
    EXPECT_NEAR(one_turned.log_g, one.log_g, 2e-3F * (1 + one.d2));
  }
}

struct Cholesky4 {
  double l[4][4] = {};
  explicit Cholesky4(const float (&packed)[10]) {
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t i = j; i < 4; ++i) {
        double v = packed[packed_index(4, j, i)];
        for (std::size_t k = 0; k < j; ++k) v -= l[i][k] * l[j][k];
        l[i][j] = i == j ? std::sqrt(std::fmax(v, 1e-12)) : v / l[j][j];
      }
  }
  void draw(Dice& dice, double (&e)[4]) const {
    double z[4];
    for (double& v : z) v = dice.normal();
    for (int i = 0; i < 4; ++i) {
      e[i] = 0;
      for (int k = 0; k <= i; ++k) e[i] += l[i][k] * z[k];
    }
  }
};

// True lines drawn from the state's covariance, observed at some slide along them with noise: d2 must be chi-squared
// with 4 (2) degrees of freedom whatever the slide, and the density's normalisation that of the sampled residuals.
TEST(Gate, covariance_along_the_slide_is_that_of_sampled_lines) {
  Dice dice(3);
  for (int k = 0; k < 6; ++k) {
    const PredictedObservation p = random_prediction(dice);
    const Cholesky4 root(p.covariance);
    const double slide[2] = {k == 0 ? 0 : dice.uniform(-4.5, 4.5), k == 0 ? 0 : dice.uniform(-4.5, 4.5)};
    constexpr int draws = 20000;
    double d4 = 0, d2[2] = {0, 0}, in4 = 0, moment[4][4] = {};
    double log_norm4 = 0;
    for (int i = 0; i < draws; ++i) {
      double e[4];
      root.draw(dice, e);
      LineElement o[2];
      Residual r[2];
      double z[4];
      for (int eye = 0; eye < 2; ++eye) {
        // Angles are small: tan, sine and angle are one here.
        const double n = e[2 * eye] + slide[eye] * std::tan(e[2 * eye + 1]);
        o[eye] = beside(p, eye, n + dice.normal(0.3), e[2 * eye + 1] + dice.normal(0.03), slide[eye]);
        r[eye] = of(p, eye, o[eye]);
        const Likelihood one = mono_likelihood(p, eye, r[eye], o[eye], {0, 0});
        d2[eye] += double{one.d2} / draws;
        z[2 * eye] = double{r[eye].n_px};
        z[2 * eye + 1] = double{r[eye].sine};
      }
      const Likelihood both = stereo_likelihood(p, r[0], o[0], r[1], o[1], {0, 0});
      d4 += double{both.d2} / draws;
      in4 += (both.d2 < kGate4 ? 1.0 : 0.0) / draws;
      log_norm4 += (double{both.log_g} + 0.5 * double{both.d2}) / draws;
      for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b) moment[a][b] += z[a] * z[b] / draws;
    }
    EXPECT_NEAR(d4, 4, 0.12);
    EXPECT_NEAR(d2[0], 2, 0.08);
    EXPECT_NEAR(d2[1], 2, 0.08);
    EXPECT_NEAR(in4, 0.99, 0.003);
    // log of the density's factor: -1/2 log det(2 pi S).
    float packed[10];
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = a; b < 4; ++b) packed[packed_index(4, a, b)] = static_cast<float>(moment[a][b]);
    const Cholesky4 sampled(packed);
    double log_det = 0;
    for (int a = 0; a < 4; ++a) log_det += 2 * std::log(sampled.l[a][a]);
    EXPECT_NEAR(log_norm4, -0.5 * (log_det + 4 * std::log(2 * double{kPi})), 0.04);
  }
}

TEST(Gate, without_correlation_two_eyes_are_the_product_of_one_and_one) {
  Dice dice(4);
  for (int k = 0; k < 100; ++k) {
    PredictedObservation p = random_prediction(dice);
    for (const auto& [i, j] : {std::pair{0, 2}, {0, 3}, {1, 2}, {1, 3}})
      p.covariance[packed_index(4, static_cast<std::size_t>(i), static_cast<std::size_t>(j))] = 0;
    const Noise noise{0.05F, 1e-4F};
    const LineElement l = beside(p, 0, dice.normal(), dice.normal(0.05), 2), r = beside(p, 1, 0.2, -0.02, -3);
    const Residual rl = of(p, 0, l), rr = of(p, 1, r);
    const Likelihood both = stereo_likelihood(p, rl, l, rr, r, noise);
    const Likelihood one = mono_likelihood(p, 0, rl, l, noise), two = mono_likelihood(p, 1, rr, r, noise);
    EXPECT_NEAR(both.d2, one.d2 + two.d2, 1e-3F * (1 + both.d2));
    EXPECT_NEAR(both.log_g, one.log_g + two.log_g, 1e-3F * (1 + both.d2));
  }
}

TEST(Gate, a_covariance_that_is_none_lets_nothing_through) {
  PredictedObservation p;
  p.covariance[packed_index(4, 0, 0)] = -5;
  const LineElement o = beside(p, 0, 0, 0, 0);
  const Likelihood l = mono_likelihood(p, 0, of(p, 0, o), o, {0, 0});
  EXPECT_GT(l.d2, kGateAll4);
  EXPECT_LT(l.log_g, -1e30F);
}

TEST(Gate, gates_are_quantiles_of_chi_squared) {
  // P(d2 > g) in closed form for even degrees of freedom; for odd ones by Wilson and Hilferty (1931).
  const auto tail = [](double g, int half) {
    double term = 1, sum = 1;
    for (int k = 1; k < half; ++k) sum += term *= g / 2 / k;
    return std::exp(-g / 2) * sum;
  };
  const auto tail_odd = [](double g, double n) {
    return 0.5 * std::erfc((std::cbrt(g / n) - (1 - 2 / (9 * n))) / std::sqrt(2 / (9 * n)) / std::sqrt(2.0));
  };
  EXPECT_NEAR(tail(double{kGate2}, 1), 0.01, 1e-4);
  EXPECT_NEAR(tail(double{kGate4}, 2), 0.01, 1e-4);
  EXPECT_NEAR(tail_odd(double{kGateAll4}, 11), 0.001, 1e-4);
  EXPECT_NEAR(tail_odd(double{kGateAll2}, 9), 0.001, 1e-4);
}

TEST(AppearanceLikelihood, is_blind_to_reversal) {
  Dice dice(5);
  for (int k = 0; k < 200; ++k) {
    const Appearance mean = test::random_look(dice), seen = test::random_look(dice);
    float variance[7], swapped[7];
    for (float& v : variance) v = static_cast<float>(dice.uniform(0, 0.1));
    swapped[0] = variance[0];
    for (int c = 1; c < 4; ++c) swapped[c] = variance[c + 3], swapped[c + 3] = variance[c];
    const auto channels = static_cast<float>(dice.uniform(1, 3));
    const Likelihood a = appearance_likelihood(mean, variance, seen, 0.25F, 0.03F, channels);
    const Likelihood b =
        appearance_likelihood(accrete::reversed(mean), swapped, accrete::reversed(seen), 0.25F, 0.03F, channels);
    EXPECT_NEAR(a.d2, b.d2, 1e-4F * (1 + a.d2));
    EXPECT_NEAR(a.log_g, b.log_g, 1e-4F * (1 + a.d2));
  }
}

TEST(AppearanceLikelihood, of_small_differences_is_the_gaussian_density) {
  // Below the cap, with three channels: the plain Gaussian in 7 dimensions, of whatever variance comes out.
  Appearance mean, seen;
  const float variance[7] = {0.02F, 0.01F, 0.02F, 0.03F, 0.01F, 0.005F, 0.02F};
  const Likelihood at_mean = appearance_likelihood(mean, variance, seen, 0.3F, 0.05F, 3);
  EXPECT_NEAR(at_mean.d2, 0, 1e-6);
  // The density integrates to one: along each axis the integral over the density at the mean is sqrt(2 pi) sigma, and
  // sigma follows from d2 = (x / sigma)^2.
  double log_volume = 0;
  for (int axis = 0; axis < 7; ++axis) {
    Appearance moved = mean;
    const float x = 0.01F;
    if (axis == 0) moved.phase = x;
    if (axis >= 1 && axis < 4) moved.left[static_cast<std::size_t>(axis - 1)] = x;
    if (axis >= 4) moved.right[static_cast<std::size_t>(axis - 4)] = x;
    const Likelihood l = appearance_likelihood(mean, variance, moved, 0.3F, 0.05F, 3);
    EXPECT_NEAR(l.log_g, at_mean.log_g - 0.5F * l.d2, 1e-4);
    const double sigma2 = double{x} * double{x} / double{l.d2};
    EXPECT_GT(sigma2, double{variance[axis]});
    log_volume += 0.5 * std::log(2 * double{kPi} * sigma2);
  }
  EXPECT_NEAR(at_mean.log_g, -log_volume, 0.01);
}

TEST(AppearanceLikelihood, one_side_alone_never_rejects_and_grey_counts_once) {
  Appearance mean, seen;
  const float variance[7] = {};
  seen.left = {1, 1, 1};
  const Likelihood one = appearance_likelihood(mean, variance, seen, 0.25F, 0.02F, 3);
  EXPECT_NEAR(one.d2, 9, 1e-4);  // the cap: another background
  seen.right = {1, 1, 1};
  EXPECT_NEAR(appearance_likelihood(mean, variance, seen, 0.25F, 0.02F, 3).d2, 18, 1e-4);
  EXPECT_LT(18, kGateAll2);
  // A grey difference in three equal channels is one difference.
  seen.left = seen.right = {0.04F, 0.04F, 0.04F};
  const float three = appearance_likelihood(mean, variance, seen, 0.25F, 0.02F, 3).d2;
  EXPECT_NEAR(appearance_likelihood(mean, variance, seen, 0.25F, 0.02F, 1).d2, three / 3, 1e-5);
  // A phase across the cut of the circle.
  Appearance a, b;
  a.phase = kPi - 0.02F;
  b.phase = -kPi + 0.02F;
  EXPECT_LT(appearance_likelihood(a, variance, b, 0.25F, 0.02F, 3).d2, 0.02F);
}

// At a crease the light may make the brighter face the darker one.
TEST(AppearanceLikelihood, contrast_may_reverse_unless_both_sides_are_others) {
  Appearance mean, seen;
  mean.left = {0.55F, 0.5F, 0.45F}, mean.right = {0.5F, 0.45F, 0.4F};
  mean.phase = kPi / 2;
  const float variance[7] = {0.02F, 0.003F, 0.003F, 0.003F, 0.003F, 0.003F, 0.003F};
  seen = mean;
  seen.phase = -kPi / 2;
  EXPECT_NEAR(appearance_likelihood(mean, variance, seen, 0.25F, 0.02F, 3).d2, 9, 1e-4);
  EXPECT_LT(9, kGateAll2);
  seen.left = {0, 0, 0};  // ... or the background
  EXPECT_NEAR(appearance_likelihood(mean, variance, seen, 0.25F, 0.02F, 3).d2, 18, 1e-4);
  // The other border of a bar: both sides swapped, and the phase reversed.
  mean.left = {0.8F, 0.7F, 0.6F}, mean.right = {0.3F, 0.2F, 0.1F};
  seen.left = mean.right, seen.right = mean.left;
  const float swapped = appearance_likelihood(mean, variance, seen, 0.25F, 0.02F, 3).d2;
  EXPECT_NEAR(swapped, 18 + kPi * kPi / (0.02F + 0.25F * 0.25F + 0.35F * 0.35F), 1e-3);
  EXPECT_GT(swapped, kGateAll4);
}

}  // namespace
}  // namespace accrete::associate
