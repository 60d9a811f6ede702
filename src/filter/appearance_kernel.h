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

// noise, process: variances of the 7 components. P+ = K R with K = P S^-1, symmetrised: no difference of large numbers
// (PERFORMANCE B.4). true where the result is finite and positive definite.
template <class S>
ACCRETE_INLINE Bool<S> update_appearance(LaneAppearance<S>& x, const S* observed, const S* noise, const S* process) {
  S innovation[7];
  for (int i = 0; i < 7; ++i) {
    innovation[i] = observed[i] - x.mean[i];
    x.P(i, i) += process[i];
  }
  innovation[0] = wrap_phase(innovation[0]);
  Symmetric<S, 7> root = x.P;
  for (int i = 0; i < 7; ++i) root(i, i) += noise[i];
  S inverse[7];
  Bool<S> good = cholesky<7>(root, root, inverse);
  S K[7][7];
  S sum = S(0);
  ACCRETE_UNROLL
  for (int i = 0; i < 7; ++i) {
    ACCRETE_UNROLL
    for (int k = 0; k < 7; ++k) K[i][k] = x.P(i, k);
    solve_lower<7>(root, inverse, K[i]);
    solve_lower_transposed<7>(root, inverse, K[i]);
    ACCRETE_UNROLL
    for (int k = 0; k < 7; ++k) x.mean[i] = x.mean[i] + K[i][k] * innovation[k];
    x.mean[i] = flush_tiny(x.mean[i]);
  }
  x.mean[0] = wrap_any_phase(x.mean[0]);
  ACCRETE_UNROLL
  for (int i = 0; i < 7; ++i) {
    sum += x.mean[i];
    x.P(i, i) = K[i][i] * noise[i];
    ACCRETE_UNROLL
    for (int k = i + 1; k < 7; ++k) x.P(i, k) = flush_tiny(S(0.5F) * (K[i][k] * noise[k] + K[k][i] * noise[i]));
  }
  return good & is_finite(sum) & is_phase(x.mean[0]) & make_definite(x.P);
}

}  // namespace accrete::inline ACCRETE_ISA
