// What every update must keep, whatever it is fed with.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "filter/update.h"
#include "numeric/dice.h"

namespace accrete {
namespace {

using namespace oracle;

const Optics kOptics;

struct One {
  std::vector<GeometryBlock> blocks = std::vector<GeometryBlock>(1);
  UpdateOutcome outcome = UpdateOutcome::kUpdated;

  explicit One(const Geometry& g) {
    for (std::size_t l = 0; l < 16; ++l) store(g, blocks[0], l);
  }
  Geometry update(const LineElement& l, const LineElement& r, std::span<const float> cap = {}) {
    const std::uint32_t slot = 7;
    update_stereo(blocks, {&slot, 1}, {&l, 1}, {&r, 1}, Pose().aligned(), kOptics.aligned(), {&outcome, 1}, cap);
    return load(blocks[0], 7);
  }
  Geometry update(const LineElement& z, Eye eye) {
    const std::uint32_t slot = 7;
    update_mono(blocks, {&slot, 1}, {&z, 1}, {&eye, 1}, Pose().aligned(), kOptics.aligned(), {&outcome, 1});
    return load(blocks[0], 7);
  }
};

LineElement see(Dice& dice, const Edge& x, double offset, double sigma_n = 0.3, double sigma_theta = 0.035) {
  return dice.observe(x, Pose(), kOptics, offset, sigma_n, sigma_theta, 0);
}
bool same_bits(const Geometry& a, const Geometry& b) {
  return a.position == b.position && a.quaternion == b.quaternion && a.covariance == b.covariance;
}

TEST(UpdateLaws, a_slide_of_the_observation_along_the_edge_changes_nothing) {
  Dice dice(1);
  for (int k = 0; k < 50; ++k) {
    const Edge x = dice.edge();
    const Geometry g = record_of(x);
    LineElement l = see(dice, x, 0), r = see(dice, x, kOptics.baseline);
    const Geometry a = One(g).update(l, r);
    const auto slide = [](LineElement e, float px) {
      e.x_px += px * e.c;
      e.y_px += px * e.s;
      return e;
    };
    // Along its own direction the observed element is the same line; only curvature terms see where on it.
    const Geometry b = One(g).update(slide(l, 3), slide(r, -2));
    const Edge sa = state_of(a), sb = state_of(b);
    const Vector3d t = sa.R.col(0);
    const double sigma = std::sqrt(sa.P(0, 0));
    EXPECT_LT(std::abs(t.dot(sa.p - sb.p)), 0.2 * sigma);
  }
}

TEST(UpdateLaws, an_uncorrelated_slide_is_neither_corrected_nor_believed) {
  Dice dice(2);
  for (int k = 0; k < 50; ++k) {
    Edge x = dice.edge();
    // Uncorrelated: the slide has its own variance along the tangent.
    x.P = (Vector6d() << 4e-6, 1e-6, 9e-6, 0.6, 1e-3, 1e-3).finished().asDiagonal();
    const Edge truth = moved(x, MatrixXd(x.P.llt().matrixL()) * dice.normals(6));
    const Edge y = state_of(One(record_of(x)).update(see(dice, truth, 0), see(dice, truth, kOptics.baseline)));
    const Vector3d t = x.R.col(0);
    EXPECT_LT(std::abs(t.dot(y.p - x.p)), 0.05 * 2e-3);
    EXPECT_NEAR(y.P(0, 0), 4e-6, 0.03 * 4e-6);
    EXPECT_LT(line_covariance(y).diagonal().cwiseQuotient(line_covariance(x).diagonal()).maxCoeff(), 1.001);
  }
}

TEST(UpdateLaws, the_cap_bounds_the_slide_and_leaves_the_rest) {
  Dice dice(3);
  for (int k = 0; k < 50; ++k) {
    const Edge x = dice.edge();
    const LineElement l = see(dice, x, 0), r = see(dice, x, kOptics.baseline);
    const float cap = 2.5e-7F;
    const Edge free = state_of(One(record_of(x)).update(l, r));
    const Edge capped = state_of(One(record_of(x)).update(l, r, {&cap, 1}));
    EXPECT_LE(capped.P(0, 0), cap);
    EXPECT_EQ(line_covariance(free), line_covariance(capped));
    EXPECT_GT(smallest_scaled_eigenvalue(capped.P), 0);
  }
}

TEST(UpdateLaws, an_uncorrelated_roll_stays_what_it_is) {
  Dice dice(4);
  Edge x = dice.edge();
  x.P.row(3).setZero();
  x.P.col(3).setZero();
  x.P(3, 3) = 0.76;
  const Geometry g = One(record_of(x)).update(see(dice, x, 0), see(dice, x, kOptics.baseline));
  // Exactly. A reset of the rotation would leak a correlation of 1e-2 and more.
  const auto correlation = [&](std::size_t i) {
    const float roll = g.covariance[packed_index(6, 3, 3)], other = g.covariance[packed_index(6, i, i)];
    return g.covariance[i < 3 ? packed_index(6, i, 3) : packed_index(6, 3, i)] / std::sqrt(roll * other);
  };
  for (const std::size_t i : {0U, 1U, 2U, 4U, 5U}) EXPECT_EQ(correlation(i), 0) << i;
  EXPECT_NEAR(g.covariance[packed_index(6, 3, 3)], 0.76F, 1e-6F);
}

TEST(UpdateLaws, is_reversal_invariant) {
  Dice dice(5);
  for (int k = 0; k < 50; ++k) {
    const Geometry g = record_of(dice.edge());
    const Edge truth = moved(state_of(g), 0.5 * MatrixXd(state_of(g).P.llt().matrixL()) * dice.normals(6));
    const LineElement l = see(dice, truth, 0), r = see(dice, truth, kOptics.baseline);
    const Edge a = state_of(One(g).update(l, r));
    const Edge b = state_of(reversed(One(reversed(g)).update(reversed(l), reversed(r))));
    EXPECT_LT((a.p - b.p).norm(), 1e-6);
    EXPECT_LT((a.R - b.R).norm(), 1e-5);
    const Vector6d s = a.P.diagonal().cwiseSqrt().cwiseInverse();
    EXPECT_LT((s.asDiagonal() * (a.P - b.P) * s.asDiagonal()).norm(), 2e-3);
  }
}

TEST(UpdateLaws, failures_are_told_apart_and_leave_every_bit) {
  Dice dice(6);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Edge x = dice.edge();
  const Geometry good = record_of(x);
  const LineElement l = see(dice, x, 0), r = see(dice, x, kOptics.baseline);
  const auto expect = [&](const Geometry& g, const LineElement& left, const LineElement& right, UpdateOutcome outcome) {
    One one(g);
    const Geometry before = load(one.blocks[0], 7);
    const Geometry after = one.update(left, right);
    EXPECT_EQ(one.outcome, outcome);
    EXPECT_EQ(std::memcmp(&before, &after, sizeof(before)), 0);
  };
  Geometry g = good;
  g.position[2] = -0.4F;
  expect(g, l, r, UpdateOutcome::kBehind);
  g = good;
  g.position[2] = 0.5e-3F;
  expect(g, l, r, UpdateOutcome::kBehind);
  g = good;
  g.covariance[packed_index(6, 4, 4)] = -1e-3F;
  expect(g, l, r, UpdateOutcome::kNotPositiveDefinite);
  g = good;
  g.covariance[packed_index(6, 0, 1)] = nan;
  expect(g, l, r, UpdateOutcome::kNotPositiveDefinite);
  LineElement bad = l;
  bad.x_px = nan;
  expect(good, bad, r, UpdateOutcome::kNotPositiveDefinite);
  bad = r;
  bad.sigma_n_px = std::numeric_limits<float>::infinity();
  expect(good, l, bad, UpdateOutcome::kNotPositiveDefinite);
  One one(good);  // and the same without a fault is updated
  EXPECT_FALSE(same_bits(one.update(l, r), good));
  EXPECT_EQ(one.outcome, UpdateOutcome::kUpdated);
}

// Random states of any condition, random and absurd observations: what is stored is always a Gaussian.
TEST(UpdateLaws, covariances_stay_symmetric_positive_definite_and_finite) {
  Dice dice(7);
  int updated = 0, refused = 0;
  for (int k = 0; k < 3000; ++k) {
    Edge x = dice.edge(std::pow(10, dice.uniform(-5, 0)), std::pow(10, dice.uniform(-4, 0.3)), dice.uniform(0.01, 1.5));
    const Geometry g = record_of(x);
    One one(g);
    Geometry after = g;
    for (int n = 0; n < 5; ++n) {
      LineElement l = see(dice, x, 0, std::pow(10, dice.uniform(-3, 2)), std::pow(10, dice.uniform(-4, 0)));
      LineElement r =
          see(dice, x, kOptics.baseline, std::pow(10, dice.uniform(-3, 2)), std::pow(10, dice.uniform(-4, 0)));
      if (n == 3) l.x_px += static_cast<float>(std::pow(10, dice.uniform(0, 6)));
      after = n == 2 ? one.update(l, Eye::kLeft) : n == 4 ? one.update(r, Eye::kRight) : one.update(l, r);
      (one.outcome == UpdateOutcome::kUpdated ? updated : refused)++;
      const double least = smallest_scaled_eigenvalue(covariance_of(after));
      ASSERT_TRUE(least > 0 || one.outcome != UpdateOutcome::kUpdated) << k << " " << n;
      float sum = 0;
      for (const float v : after.position) sum += v;
      for (const float v : after.quaternion) sum += v;
      ASSERT_TRUE(std::isfinite(sum));
    }
  }
  EXPECT_GT(updated, 8000);
  RecordProperty("refused", refused);
}

// A prior a hundred million times the noise: the form P - K S Kt fails here in float (PERFORMANCE B.4).
TEST(UpdateLaws, a_huge_prior_is_no_trouble) {
  Dice dice(8);
  for (int k = 0; k < 200; ++k) {
    const Edge x = dice.edge(1e-2, 0.3, 0.8);
    One one(record_of(x));
    LineElement l = see(dice, x, 0, 1e-3, 1e-4), r = see(dice, x, kOptics.baseline, 1e-3, 1e-4);
    const Geometry g = one.update(l, r);
    ASSERT_EQ(one.outcome, UpdateOutcome::kUpdated);
    EXPECT_GT(smallest_scaled_eigenvalue(covariance_of(g)), 0);
  }
}

TEST(UpdateLaws, a_thousand_frames_do_not_wear_it_out) {
  Dice dice(9);
  const Edge x = dice.edge();
  One one(record_of(x));
  for (int k = 0; k < 1000; ++k) {
    const Geometry g = one.update(see(dice, x, 0), see(dice, x, kOptics.baseline));
    ASSERT_EQ(one.outcome, UpdateOutcome::kUpdated);
    ASSERT_GT(smallest_scaled_eigenvalue(covariance_of(g)), 0);
    ASSERT_NEAR(std::hypot(std::hypot(g.quaternion[0], g.quaternion[1]), std::hypot(g.quaternion[2], g.quaternion[3])),
                1, 1e-5);
  }
}

}  // namespace
}  // namespace accrete
