// Weights of the unscented transform with alpha = 1, kappa = 0, beta = 2: all of them are at least 0, so a covariance
// is a sum of squares and float is enough (METHOD 5.1; Merwe's scaled sigma points).
#pragma once

namespace accrete {

template <int N>
struct Unscented {
  static constexpr double kMean0 = 0;  // weight of the central point in the mean: lambda = alpha^2 (N + kappa) - N = 0
  static constexpr double kCovariance0 = 2;   // and in the covariance: kMean0 + 1 - alpha^2 + beta
  static constexpr double kWeight = 0.5 / N;  // of each of the 2 N others
};

// sqrt(N + lambda): how far the points lie out, in standard deviations.
inline constexpr double kSpread5 = 2.23606797749978969;
inline constexpr double kSpread6 = 2.44948974278317810;

// Square root of a constant, by Newton's method: the compiler has none before C++26.
constexpr double root_of_constant(double x) {
  double root = x > 1 ? x : 1;
  for (int i = 0; i < 40; ++i) root = 0.5 * (root + x / root);
  return root;
}
static_assert(root_of_constant(5) == kSpread5 && root_of_constant(6) == kSpread6);

}  // namespace accrete
