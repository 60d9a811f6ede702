// The appearance (phase, left RGB, right RGB) observes itself: the exact Kalman update, which the unscented one equals.
#pragma once

#include <type_traits>

#include "math/cholesky.h"

namespace accrete::inline ACCRETE_ISA {

inline constexpr float kTwoPi = 6.283185307179586F;
inline constexpr float kHalfTurn = 3.141592653589793F;

// To (-pi, pi] from (-3 pi, 3 pi].
template <class S>
ACCRETE_INLINE S wrap_phase(S a) {
  a = select(a > S(kHalfTurn), a - S(kTwoPi), a);
  return select(a > S(-kHalfTurn), a, a + S(kTwoPi));
}

// To (-pi, pi] from anywhere: a correction may turn a phase of which nothing was known many times round. What is so far
// out that float has no phase any more stays there, for the caller to refuse.
template <class S>
ACCRETE_INLINE S wrap_any_phase(S a) {
  // 1.5 * 2^23 (2^52 in double): added and taken away again it rounds to whole numbers.
  constexpr double kRound = std::is_same_v<S, double> ? 6755399441055744.0 : 12582912.0;
  const S turns = (a * S(1 / kTwoPi) + S(kRound)) - S(kRound);
  return wrap_phase(select(abs_of(a) < S(1e4F), a - turns * S(kTwoPi), a));
}
template <class S>
ACCRETE_INLINE Bool<S> is_phase(S a) {
  return abs_of(a) <= S(kHalfTurn);
}

template <class S>
struct LaneAppearance {
  S mean[7];
  Symmetric<S, 7> P;
};

// noise, process: variances of the 7 components. true where the result is finite and positive definite.
//
// S = P + R = L D Lt with a diagonal R, and B = L^-1 R. What K = P S^-1 needs of L^-1 P = D Lt - B is known without
// solving for it, and P+ = (L^-1 P)t D^-1 B has off the diagonal only products of B, on it the variance given the
// components before, r rest / D, less what those behind explain (docs/math/filter.md). Nothing is a difference of P.
template <class S>
ACCRETE_INLINE Bool<S> update_appearance(LaneAppearance<S>& x, const S* observed, const S* noise, const S* process) {
  S innovation[7], diagonal[7];
  ACCRETE_UNROLL
  for (int i = 0; i < 7; ++i) {
    innovation[i] = observed[i] - x.mean[i];
    diagonal[i] = x.P(i, i) + process[i];
  }
  innovation[0] = wrap_phase(innovation[0]);
  const Factors<S, 7> f = factorise<7>(x.P, diagonal, noise);
  solve_unit_lower<7>(f.l, innovation);
  S weighted[7];  // D^-1 L^-1 innovation
  ACCRETE_UNROLL
  for (int k = 0; k < 7; ++k) weighted[k] = innovation[k] * f.inverse[k];

  // Column i of B, below the diagonal, and of D^-1 B.
  S b[7][7], scaled[7][7];
  ACCRETE_UNROLL
  for (int i = 0; i < 7; ++i) {
    scaled[i][i] = noise[i] * f.inverse[i];
    ACCRETE_UNROLL
    for (int k = i + 1; k < 7; ++k) {
      S sum = f.l(k, i) * noise[i];
      ACCRETE_UNROLL
      for (int m = i + 1; m < k; ++m) sum = sum + f.l(k, m) * b[i][m];
      b[i][k] = flush_tiny(-sum);
      scaled[i][k] = b[i][k] * f.inverse[k];
    }
  }

  S sum = S(0);
  ACCRETE_UNROLL
  for (int i = 0; i < 7; ++i) {
    S mean = x.mean[i] + f.rest[i] * weighted[i];
    ACCRETE_UNROLL
    for (int k = 0; k < i; ++k) mean = mean + f.unscaled(i, k) * weighted[k];
    ACCRETE_UNROLL
    for (int k = i + 1; k < 7; ++k) mean = mean - b[i][k] * weighted[k];
    x.mean[i] = flush_tiny(mean);
    sum += x.mean[i];

    S variance = f.rest[i] * scaled[i][i];
    ACCRETE_UNROLL
    for (int k = i + 1; k < 7; ++k) variance = variance - b[i][k] * scaled[i][k];
    x.P(i, i) = variance;
    ACCRETE_UNROLL
    for (int j = i + 1; j < 7; ++j) {
      S common = b[i][j] * scaled[j][j];
      ACCRETE_UNROLL
      for (int k = j + 1; k < 7; ++k) common = common + b[i][k] * scaled[j][k];
      x.P(i, j) = flush_tiny(-common);
    }
  }
  x.mean[0] = wrap_any_phase(x.mean[0]);
  Bool<S> definite = is_weakly_correlated(x.P);
  if (__builtin_expect(!all_of(definite), 0)) definite = make_definite(x.P);
  return f.good & is_finite(sum) & is_phase(x.mean[0]) & definite;
}

}  // namespace accrete::inline ACCRETE_ISA
