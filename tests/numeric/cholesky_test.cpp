#include "math/cholesky.h"

#include <gtest/gtest.h>

#include <limits>

#include "math/unscented.h"
#include "numeric/dice.h"
#include "numeric/lane_bridge.h"

namespace accrete {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using oracle::Dice;

constexpr int kLanes = 8;
using Lanes = Pack<kLanes>;

Symmetric<Lanes, 6> pack(const MatrixXd* P) {
  Symmetric<Lanes, 6> s;
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) {
      float x[kLanes];
      for (int l = 0; l < kLanes; ++l) x[l] = static_cast<float>(P[l](i, j));
      s(i, j) = load_lanes<Lanes>(x);
    }
  return s;
}
VectorXd sigmas() { return (VectorXd(6) << 2e-3, 5e-3, 1e-3, 0.8, 0.2, 0.1).finished(); }

TEST(Cholesky, root_times_its_transpose_is_the_matrix) {
  Dice dice(1);
  for (int k = 0; k < 50; ++k) {
    MatrixXd P[kLanes];
    for (MatrixXd& m : P) m = dice.covariance(sigmas());
    const Symmetric<Lanes, 6> a = pack(P);
    Symmetric<Lanes, 6> root;
    Lanes inverse[6];
    const Mask<kLanes> good = cholesky<6>(a, root, inverse);
    for (int l = 0; l < kLanes; ++l) {
      EXPECT_TRUE(good[l]);
      MatrixXd L = MatrixXd::Zero(6, 6);
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j <= i; ++j) L(i, j) = double{root(i, j)[l]};
      const VectorXd s = P[l].diagonal().cwiseSqrt().cwiseInverse();
      EXPECT_LT((s.asDiagonal() * (L * L.transpose() - P[l]) * s.asDiagonal()).norm(), 3e-6);
      for (int i = 0; i < 6; ++i) EXPECT_NEAR(double{inverse[i][l]} * L(i, i), 1, 1e-6);
    }
  }
}

TEST(Cholesky, solves_with_the_root_and_its_transpose) {
  Dice dice(2);
  const MatrixXd P = dice.covariance(sigmas());
  Symmetric<double, 6> root;
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) root(i, j) = P(i, j);
  double inverse[6], x[6];
  ASSERT_TRUE(cholesky<6>(root, root, inverse));
  const VectorXd b = dice.normals(6);
  for (int i = 0; i < 6; ++i) x[i] = b[i];
  solve_lower<6>(root, inverse, x);
  solve_lower_transposed<6>(root, inverse, x);
  const VectorXd expected = P.llt().solve(b);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(x[i], expected[i], 1e-9 * expected.cwiseAbs().maxCoeff());
}

TEST(Cholesky, factors_without_roots_are_those_of_the_matrix_and_solve_with_it) {
  Dice dice(6);
  for (int k = 0; k < 50; ++k) {
    const MatrixXd P = dice.covariance(sigmas());
    const VectorXd noise = sigmas().cwiseAbs2() * dice.uniform(0.01, 100), b = dice.normals(6);
    Symmetric<double, 6> a;
    double diagonal[6], added[6], x[6];
    for (int i = 0; i < 6; ++i) {
      for (int j = i; j < 6; ++j) a(i, j) = P(i, j);
      diagonal[i] = P(i, i);
      added[i] = noise[i];
      x[i] = b[i];
      a(i, i) = -1;  // the diagonal is given apart
    }
    const Factors<double, 6> f = factorise<6>(a, diagonal, added);
    ASSERT_TRUE(f.good);
    MatrixXd L = MatrixXd::Identity(6, 6), D = MatrixXd::Zero(6, 6), S = P;
    S.diagonal() += noise;
    for (int j = 0; j < 6; ++j) {
      D(j, j) = f.unscaled(j, j);
      for (int i = j + 1; i < 6; ++i) {
        L(i, j) = f.l(i, j);
        EXPECT_NEAR(f.unscaled(i, j), f.l(i, j) * D(j, j), 1e-14 * std::abs(f.unscaled(i, j)));
      }
      EXPECT_NEAR(f.inverse[j] * D(j, j), 1, 1e-14);
      EXPECT_NEAR(f.rest[j] + noise[j], D(j, j), 1e-14 * D(j, j));
    }
    const VectorXd scale = sigmas().cwiseInverse();
    EXPECT_LT((scale.asDiagonal() * (L * D * L.transpose() - S) * scale.asDiagonal()).norm(), 1e-12);
    solve<6>(f, x);
    const VectorXd expected = S.llt().solve(b);
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(x[i], expected[i], 1e-9 * expected.cwiseAbs().maxCoeff());
  }
}

// The short answer is given only where the long one is the same, with a wide margin.
TEST(Cholesky, weakly_correlated_matrices_are_definite_and_nothing_else_is_weakly_correlated) {
  Dice dice(7);
  int weak = 0;
  for (int k = 0; k < 4000; ++k) {
    const VectorXd s = VectorXd::NullaryExpr(6, [&] { return std::pow(10.0, dice.uniform(-6, 3)); });
    MatrixXd C = MatrixXd::Identity(6, 6);
    const double most = dice.uniform(0, 0.5);
    for (int i = 0; i < 6; ++i)
      for (int j = i + 1; j < 6; ++j) C(i, j) = C(j, i) = dice.uniform(-most, most);
    Symmetric<float, 6> a;
    for (int i = 0; i < 6; ++i)
      for (int j = i; j < 6; ++j) a(i, j) = static_cast<float>(s[i] * C(i, j) * s[j]);
    const double squares = (C.squaredNorm() - 6) / 2;
    const bool is_weak = is_weakly_correlated<6>(a);
    if (std::abs(squares - 0.45) > 1e-4) {
      EXPECT_EQ(is_weak, squares < 0.45);
    }
    if (!is_weak) continue;
    ++weak;
    EXPECT_TRUE(is_positive_definite(a));
    EXPECT_GT(oracle::smallest_scaled_eigenvalue(oracle::to_matrix(a)), 0.05);
  }
  EXPECT_GT(weak, 1000);

  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  for (const float bad : {-1.0F, 0.0F, 1e-35F, infinity, -infinity, nan})
    for (int i = 0; i < 6; ++i)
      for (int j = i; j < 6; ++j) {
        if (i != j && std::abs(bad) <= 0.1F) continue;  // a harmless covariance
        Symmetric<float, 6> a{};
        for (int d = 0; d < 6; ++d) a(d, d) = 1;
        a(i, j) = bad;
        EXPECT_FALSE(is_weakly_correlated<6>(a)) << bad << ' ' << i << ' ' << j;
      }
}

TEST(Cholesky, the_mask_tells_bad_lanes_and_spares_the_others) {
  Dice dice(3);
  MatrixXd P[kLanes];
  for (MatrixXd& m : P) m = dice.covariance(sigmas());
  P[1](2, 2) = -P[1](2, 2);
  P[2](0, 4) = P[2](4, 0) = std::numeric_limits<double>::quiet_NaN();
  P[3](5, 5) = std::numeric_limits<double>::infinity();
  P[4] = MatrixXd::Zero(6, 6);
  P[5].row(5) = P[5].row(4);  // singular
  P[5].col(5) = P[5].col(4);
  const bool expected[kLanes] = {true, false, false, false, false, false, true, true};
  const Symmetric<Lanes, 6> a = pack(P);
  Symmetric<Lanes, 6> root;
  Lanes inverse[6];
  const Mask<kLanes> factored = cholesky<6>(a, root, inverse), definite = is_positive_definite(a);
  for (int l = 0; l < kLanes; ++l) {
    EXPECT_EQ(factored[l], expected[l]) << l;
    EXPECT_EQ(definite[l], expected[l]) << l;
  }
}

// A float matrix that passes is positive definite in truth, near the border too.
TEST(Cholesky, what_passes_has_positive_eigenvalues) {
  Dice dice(4);
  int passed = 0, refused = 0;
  for (int k = 0; k < 4000; ++k) {
    MatrixXd P = dice.covariance(sigmas());
    const VectorXd s = P.diagonal().cwiseSqrt();
    MatrixXd C = s.cwiseInverse().asDiagonal() * P * s.cwiseInverse().asDiagonal();
    const double least = Eigen::SelfAdjointEigenSolver<MatrixXd>(C).eigenvalues()[0];
    const double target = std::pow(10.0, dice.uniform(-9, -4)) * (k % 4 == 0 ? -1 : 1);
    C -= (least - target) * MatrixXd::Identity(6, 6);
    P = s.asDiagonal() * C * s.asDiagonal();
    Symmetric<float, 6> a;
    for (int i = 0; i < 6; ++i)
      for (int j = i; j < 6; ++j) a(i, j) = static_cast<float>(P(i, j));
    if (is_positive_definite(a)) {
      ++passed;
      EXPECT_GT(oracle::smallest_scaled_eigenvalue(oracle::to_matrix(a)), 0);
    } else {
      ++refused;
      EXPECT_LT(target, 1e-5);
    }
  }
  EXPECT_GT(passed, 500);
  EXPECT_GT(refused, 500);
}

TEST(Unscented, weights_sum_to_one_and_are_not_negative) {
  static_assert(Unscented<6>::kMean0 >= 0 && Unscented<6>::kCovariance0 >= 0);
  EXPECT_DOUBLE_EQ(Unscented<6>::kMean0 + 12 * Unscented<6>::kWeight, 1);
  EXPECT_DOUBLE_EQ(Unscented<5>::kMean0 + 10 * Unscented<5>::kWeight, 1);
  // alpha = 1, kappa = 0, beta = 2: W_c0 = W_m0 + 1 - alpha^2 + beta.
  EXPECT_DOUBLE_EQ(Unscented<6>::kCovariance0, Unscented<6>::kMean0 + 2);
  EXPECT_DOUBLE_EQ(kSpread5 * kSpread5, 5);
  EXPECT_DOUBLE_EQ(kSpread6 * kSpread6, 6);
  // The points reproduce the covariance: 2 W spread^2 = 1.
  EXPECT_DOUBLE_EQ(2 * Unscented<6>::kWeight * kSpread6 * kSpread6, 1);
  EXPECT_DOUBLE_EQ(2 * Unscented<5>::kWeight * kSpread5 * kSpread5, 1);
}

}  // namespace
}  // namespace accrete
