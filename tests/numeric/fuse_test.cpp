#include "store/fuse.h"

#include <gtest/gtest.h>

#include "numeric/dice.h"
#include "store/covariance_intersection.h"

namespace accrete {
namespace {

using namespace oracle;

AppearanceState look(Dice& dice, double sigma = 0.1) {
  AppearanceState a;
  a.mean.phase = static_cast<float>(dice.uniform(-3, 3));
  for (float& c : a.mean.left) c = static_cast<float>(dice.uniform(0, 1));
  for (float& c : a.mean.right) c = static_cast<float>(dice.uniform(0, 1));
  const MatrixXd P = dice.covariance(VectorXd::Constant(7, sigma));
  for (int i = 0; i < 7; ++i)
    for (int j = i; j < 7; ++j) a.covariance[packed_index(7, i, j)] = static_cast<float>(P(i, j));
  return a;
}
// An estimate of `truth` with covariance P, and a slide of up to 5 mm along the true line.
Geometry estimate(Dice& dice, const Edge& truth, const Matrix6d& P) {
  Edge x = truth;
  x.p += dice.uniform(-5e-3, 5e-3) * truth.R.col(0);
  Vector6d d = MatrixXd(P.llt().matrixL()) * dice.normals(6);
  d[3] = 0;
  x = moved(x, -d);
  x.P = P;
  return record_of(x);
}
Matrix6d small_covariance(Dice& dice, double scale = 1) {
  Vector6d sigma;
  sigma << 1e-3, 1e-3, 1e-3, 0.7, 0.03, 0.03;
  Matrix6d P = dice.covariance(scale * sigma);
  P.row(3).setZero();
  P.col(3).setZero();
  P(3, 3) = 0.6;
  return P;
}
// Moved along its own line, with its covariance: a tilt then moves the point by the lever.
Geometry slid(const Geometry& g, double s) {
  Edge x = state_of(g);
  Matrix6d F = Matrix6d::Identity();
  F(2, 4) = -s;
  F(1, 5) = s;
  x.p += s * x.R.col(0);
  x.P = F * x.P * F.transpose();
  return record_of(x);
}

TEST(MergeDistance, of_independent_estimates_is_chi_square_of_four) {
  Dice dice(1);
  const int n = 3000;
  double sum = 0;
  int beyond = 0;
  for (int k = 0; k < n; ++k) {
    const Edge truth = dice.edge();
    const float d2 = merge_distance2(estimate(dice, truth, small_covariance(dice)),
                                     estimate(dice, truth, small_covariance(dice, 0.6)));
    sum += double{d2} / n;
    beyond += d2 > 9.49F;
  }
  EXPECT_NEAR(sum, 4, 0.2);
  EXPECT_NEAR(static_cast<double>(beyond) / n, 0.05, 0.015);
}

TEST(MergeDistance, does_not_know_of_direction_order_or_slide) {
  Dice dice(2);
  for (int k = 0; k < 200; ++k) {
    const Edge truth = dice.edge();
    const Geometry a = estimate(dice, truth, small_covariance(dice)), b = estimate(dice, truth, small_covariance(dice));
    const float d2 = merge_distance2(a, b);
    const float tolerance = 2e-3F * (1 + d2);
    EXPECT_NEAR(merge_distance2(reversed(a), b), d2, tolerance);
    EXPECT_NEAR(merge_distance2(a, reversed(b)), d2, tolerance);
    EXPECT_NEAR(merge_distance2(reversed(a), reversed(b)), d2, tolerance);
    EXPECT_NEAR(merge_distance2(b, a), d2, 0.05F * (1 + d2));
    // The variance along the line is no excuse for an offset across it.
    Edge loose = state_of(b);
    loose.P(0, 0) += 0.01;
    EXPECT_NEAR(merge_distance2(a, record_of(loose)), d2, 0.02F * (1 + d2));
    EXPECT_NEAR(merge_distance2(slid(a, 1e-3), slid(b, -1e-3)), d2, 0.05F * (1 + d2));
  }
}

TEST(MergeDistance, tells_parallel_lines_apart) {
  Dice dice(3);
  const Edge truth = dice.edge();
  const Geometry a = estimate(dice, truth, small_covariance(dice, 0.1));
  Edge other = state_of(a);
  other.p += 3e-3 * other.R.col(1);
  EXPECT_GT(merge_distance2(a, record_of(other)), 100.0F);
  EXPECT_LT(merge_distance2(a, record_of(other), 1e-4F), 1.0F);  // with a bias of 1 cm they may be one
  Edge turned = state_of(a);
  turned.R = turned.R * exp_so3({0, 0, 70 * kDegree});
  EXPECT_EQ(merge_distance2(a, record_of(turned)), std::numeric_limits<float>::infinity());
}

TEST(AppearanceDistance, is_chi_square_of_seven_wrapped_and_reversal_invariant) {
  Dice dice(4);
  const int n = 2000;
  double sum = 0;
  for (int k = 0; k < n; ++k) {
    AppearanceState a = look(dice, 0.05), b = a;
    for (AppearanceState* s : {&a, &b}) {
      MatrixXd P(7, 7);
      for (int i = 0; i < 7; ++i)
        for (int j = i; j < 7; ++j) P(i, j) = P(j, i) = a.covariance[packed_index(7, i, j)];
      const VectorXd e = MatrixXd(P.llt().matrixL()) * dice.normals(7);
      s->mean.phase = static_cast<float>(std::remainder(s->mean.phase + e[0], 2 * M_PI));
      for (std::size_t i = 0; i < 3; ++i) {
        s->mean.left[i] += static_cast<float>(e[static_cast<Eigen::Index>(1 + i)]);
        s->mean.right[i] += static_cast<float>(e[static_cast<Eigen::Index>(4 + i)]);
      }
    }
    const float d2 = appearance_distance2(a, b, false);
    sum += double{d2} / n;
    EXPECT_NEAR(appearance_distance2(a, reversed(b), true), d2, 1e-3F * (1 + d2));
    EXPECT_NEAR(appearance_distance2(reversed(a), b, true), d2, 2e-3F * (1 + d2));
    EXPECT_NEAR(appearance_distance2(b, a, false), d2, 1e-3F * (1 + d2));
  }
  EXPECT_NEAR(sum, 7, 0.3);
}

TEST(CovarianceIntersection, is_the_convex_combination_of_informations) {
  Dice dice(5);
  const VectorXd sigma = (VectorXd(5) << 1e-3, 2e-3, 0.7, 0.05, 0.02).finished();
  const MatrixXd A = dice.covariance(sigma), B = dice.covariance(0.7 * sigma);
  Symmetric<double, 5> a, b;
  for (int i = 0; i < 5; ++i)
    for (int j = i; j < 5; ++j) {
      a(i, j) = A(i, j);
      b(i, j) = B(i, j);
    }
  const VectorXd difference = sigma.cwiseProduct(dice.normals(5));
  double shift[5];
  const auto volume = [](const Symmetric<double, 5>& P) { return root_determinant(P); };
  ASSERT_TRUE(intersect_estimates(a, b, difference.data(), volume, shift));
  double best = 1e300;
  MatrixXd expected;
  VectorXd expected_shift;
  for (int step = 1; step <= 9; ++step) {
    const double w = 0.1 * step;
    const MatrixXd P = (w * A.inverse() + (1 - w) * B.inverse()).inverse();
    if (P.determinant() >= best) continue;
    best = P.determinant();
    expected = P;
    expected_shift = P * ((1 - w) * B.inverse() * difference);
  }
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(shift[i], expected_shift[i], 1e-6 * sigma[i]);
    for (int j = i; j < 5; ++j) EXPECT_NEAR(a(i, j), expected(i, j), 1e-6 * sigma[i] * sigma[j]);
  }
}

TEST(Fuse, with_itself_gains_nothing) {
  Dice dice(6);
  for (int k = 0; k < 100; ++k) {
    const Edge truth = dice.edge();
    const Geometry g = estimate(dice, truth, small_covariance(dice));
    const AppearanceState a = look(dice);
    for (const bool turn : {false, true}) {
      Geometry fused = g;
      AppearanceState fused_a = a;
      ASSERT_TRUE(fuse_by_covariance_intersection(fused, fused_a, turn ? reversed(g) : g, turn ? reversed(a) : a));
      const Edge x = state_of(g), y = state_of(fused);
      EXPECT_LT((x.p - y.p).norm(), 1e-6);
      EXPECT_LT((x.R - y.R).norm(), 2e-3);  // the roll, to a thousandth of its sigma
      EXPECT_LT((x.R.col(0) - y.R.col(0)).norm(), 1e-5);
      EXPECT_LT((line_covariance(x) - line_covariance(y)).norm(), 5e-3 * line_covariance(x).norm());
      EXPECT_NEAR(fused_a.mean.phase, a.mean.phase, 1e-4F);
      for (std::size_t i = 0; i < 28; ++i) EXPECT_NEAR(fused_a.covariance[i], a.covariance[i], 1e-5F);
    }
  }
}

// Errors that are nearly the same in both, as those of common motion and calibration are. An information sum would
// claim half the variance; the intersection may not claim less than it has.
TEST(Fuse, is_consistent_when_the_errors_are_correlated) {
  for (const double rho : {0.0, 0.5, 0.95}) {
    Dice dice(7);
    const int n = 2000;
    double nees = 0;
    for (int k = 0; k < n; ++k) {
      const Edge truth = dice.edge();
      const Matrix6d P1 = small_covariance(dice), P2 = small_covariance(dice, 0.8);
      const VectorXd common = dice.normals(6);
      const auto draw = [&](const Matrix6d& P, bool turn) {
        const VectorXd e = std::sqrt(rho) * common + std::sqrt(1 - rho) * dice.normals(6);
        Vector6d d = MatrixXd(P.llt().matrixL()) * e;
        d[3] = 0;
        Edge x = moved(truth, -d);
        x.P = P;
        return turn ? reversed(record_of(x)) : record_of(x);
      };
      Geometry fused = draw(P1, false);
      AppearanceState a = look(dice), b = a;
      const Geometry other = draw(P2, k % 2 == 1);
      ASSERT_TRUE(fuse_by_covariance_intersection(fused, a, other, k % 2 == 1 ? reversed(b) : b));
      const Edge x = state_of(fused);
      const Eigen::Vector4d e = line_error(truth, x);
      nees += e.dot(line_covariance(x).ldlt().solve(e)) / n;
    }
    EXPECT_LT(nees, 4.2) << rho;  // never over-confident
    EXPECT_GT(nees, 1.5) << rho;  // and not without use
  }
}

TEST(Fuse, is_reversal_invariant_and_keeps_sense_and_slide) {
  Dice dice(8);
  for (int k = 0; k < 100; ++k) {
    const Edge truth = dice.edge();
    const Geometry g = estimate(dice, truth, small_covariance(dice)), h = estimate(dice, truth, small_covariance(dice));
    const AppearanceState a = look(dice), b = look(dice);
    const auto fused = [&](bool turn_g, bool turn_h) {
      Geometry x = turn_g ? reversed(g) : g;
      AppearanceState y = turn_g ? reversed(a) : a;
      EXPECT_TRUE(fuse_by_covariance_intersection(x, y, turn_h ? reversed(h) : h, turn_h ? reversed(b) : b));
      return std::pair{turn_g ? reversed(x) : x, turn_g ? reversed(y) : y};
    };
    const auto [x0, a0] = fused(false, false);
    for (const auto& [turn_g, turn_h] : {std::pair{false, true}, {true, false}, {true, true}}) {
      const auto [x1, a1] = fused(turn_g, turn_h);
      const Edge s0 = state_of(x0), s1 = state_of(x1);
      EXPECT_LT((s0.p - s1.p).norm(), 2e-6);
      EXPECT_LT((s0.R - s1.R).norm(), 1e-4);
      const Vector6d s = s0.P.diagonal().cwiseSqrt().cwiseInverse();
      EXPECT_LT((s.asDiagonal() * (s0.P - s1.P) * s.asDiagonal()).norm(), 2e-3);
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a0.mean.left[i], a1.mean.left[i], 1e-4F);
      EXPECT_NEAR(std::remainder(double{a0.mean.phase} - double{a1.mean.phase}, 2 * M_PI), 0, 1e-4);
    }
    const Edge before = state_of(g), after = state_of(x0);
    const Vector3d t = before.R.col(0);
    EXPECT_NEAR(t.dot(after.p - before.p), 0, 1e-6);
    const Vector3d s = after.R.transpose() * t;
    EXPECT_NEAR(s.dot(after.P.topLeftCorner<3, 3>() * s), before.P(0, 0), 1e-8);
    EXPECT_GT(t.dot(after.R.col(0)), 0.9);
  }
}

// Two lines whose primitives lie apart along the edge: the tilt's lever is part of the offset's uncertainty.
TEST(Fuse, carries_the_other_estimate_along_its_line) {
  Dice dice(9);
  for (int k = 0; k < 100; ++k) {
    const Edge truth = dice.edge();
    const Geometry g = estimate(dice, truth, small_covariance(dice)), h = estimate(dice, truth, small_covariance(dice));
    Geometry x = g, y = g;
    AppearanceState a = look(dice), b = a;
    ASSERT_TRUE(fuse_by_covariance_intersection(x, a, h, b));
    ASSERT_TRUE(fuse_by_covariance_intersection(y, a, slid(h, 5e-3), b));
    EXPECT_LT((state_of(x).p - state_of(y).p).norm(), 5e-5);
    EXPECT_LT((state_of(x).R.col(0) - state_of(y).R.col(0)).norm(), 2e-3);
  }
}

TEST(Fuse, covariances_are_positive_definite_or_nothing_is_changed) {
  Dice dice(10);
  int fused = 0;
  for (int k = 0; k < 2000; ++k) {
    const Edge truth = dice.edge();
    const auto any = [&] {
      Edge x = moved(truth, 0.2 * dice.normals(6));
      Vector6d sigma;
      for (int i = 0; i < 6; ++i) sigma[i] = std::pow(10, dice.uniform(i < 3 ? -5 : -4, i < 3 ? 0 : 0.2));
      x.P = dice.covariance(sigma);
      return record_of(x);
    };
    Geometry g = any();
    const Geometry before = g;
    AppearanceState a = look(dice), b = look(dice, 0.01);
    if (fuse_by_covariance_intersection(g, a, any(), b)) {
      ++fused;
      ASSERT_GT(smallest_scaled_eigenvalue(covariance_of(g)), 0);
    } else {
      ASSERT_EQ(g.covariance, before.covariance);
      ASSERT_EQ(g.position, before.position);
    }
  }
  EXPECT_GT(fused, 1500);
}

TEST(Fuse, refuses_what_is_no_gaussian_or_points_elsewhere) {
  Dice dice(11);
  const Edge truth = dice.edge();
  const Geometry good = estimate(dice, truth, small_covariance(dice));
  const AppearanceState look_good = look(dice);
  const auto refused = [&](Geometry g, AppearanceState a) {
    Geometry into = good;
    AppearanceState into_a = look_good;
    const bool ok = fuse_by_covariance_intersection(into, into_a, g, a);
    EXPECT_EQ(into.covariance, good.covariance);
    EXPECT_EQ(into_a.covariance, look_good.covariance);
    return !ok;
  };
  Edge turned = truth;
  turned.R = turned.R * exp_so3({0, 75 * kDegree, 0});
  turned.P = small_covariance(dice);
  EXPECT_TRUE(refused(record_of(turned), look_good));
  Geometry g = good;
  g.covariance[packed_index(6, 4, 4)] = -1;
  EXPECT_TRUE(refused(g, look_good));
  g = good;
  g.quaternion[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(refused(g, look_good));
  AppearanceState a = look_good;
  a.covariance[0] = 0;
  EXPECT_TRUE(refused(good, a));
}

}  // namespace
}  // namespace accrete
