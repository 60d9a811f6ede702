// Cholesky of small symmetric matrices on lanes: no branch, and a mask that says in which lanes it means something.
#pragma once

#include "math/matrix.h"

namespace accrete::inline ACCRETE_ISA {

// A pivot must exceed this part of its diagonal element: less is rounding. The same in double, so that the oracle takes
// the same decisions.
inline constexpr float kMinPivot = 1e-7F;

// A covariance may leave a function when it is positive definite even after its diagonal was reduced by this part: then
// its smallest eigenvalue (scaled to a unit diagonal) is positive beyond what the rounding of float can feign (Higham,
// Accuracy and Stability of Numerical Algorithms, theorem 10.3). Pivots alone do not tell: they may exceed it manifold.
inline constexpr float kDefiniteMargin = 1e-6F;

// L of A = L Lt, with L(i, j), i >= j, and inverse[j] = 1 / L(j, j). In a lane that is not positive definite or not
// finite the result is some finite number or NaN, and the mask is false. `l` may be `a` itself.
template <int N, class S>
ACCRETE_INLINE Bool<S> cholesky(const Symmetric<S, N>& a, Symmetric<S, N>& l, S* inverse) {
  Bool<S> good = S(0) == S(0);
  ACCRETE_UNROLL
  for (int j = 0; j < N; ++j) {
    S pivot = a(j, j);
    const S least = pivot * S(kMinPivot);
    ACCRETE_UNROLL
    for (int k = 0; k < j; ++k) pivot = pivot - l(j, k) * l(j, k);
    const Bool<S> ok = (pivot > least) & (least > S(0)) & is_finite(pivot);
    good = good & ok;
    pivot = select(ok, pivot, S(1));
    const S root = sqrt_of(pivot);
    // Root and quotient at once instead of one after the other: the chain of pivots is what waits.
    inverse[j] = root * (S(1) / pivot);
    l(j, j) = root;
    ACCRETE_UNROLL
    for (int i = j + 1; i < N; ++i) {
      S sum = a(i, j);
      ACCRETE_UNROLL
      for (int k = 0; k < j; ++k) sum = sum - l(i, k) * l(j, k);
      l(i, j) = flush_tiny(sum * inverse[j]);
    }
  }
  return good;
}

// Is A finite and positive definite, with a margin of kDefiniteMargin? Pivots as in cholesky(), without square roots.
template <int N, class S>
ACCRETE_INLINE Bool<S> is_positive_definite(const Symmetric<S, N>& a) {
  Bool<S> good = S(0) == S(0);
  Symmetric<S, N> l;  // unit lower triangle, pivots on the diagonal
  ACCRETE_UNROLL
  for (int j = 0; j < N; ++j) {
    S pivot = a(j, j) * S(1 - kDefiniteMargin);
    const S least = pivot * S(kMinPivot);
    S unscaled[N];  // row j of L D
    ACCRETE_UNROLL
    for (int k = 0; k < j; ++k) {
      unscaled[k] = l(j, k) * l(k, k);
      pivot = pivot - unscaled[k] * l(j, k);
    }
    const Bool<S> ok = (pivot > least) & (least > S(0)) & is_finite(pivot);
    good = good & ok;
    pivot = select(ok, pivot, S(1));
    l(j, j) = pivot;
    const S inverse = S(1) / pivot;
    ACCRETE_UNROLL
    for (int i = j + 1; i < N; ++i) {
      S sum = a(i, j);
      ACCRETE_UNROLL
      for (int k = 0; k < j; ++k) sum = sum - l(i, k) * unscaled[k];
      l(i, j) = flush_tiny(sum * inverse);
    }
  }
  return good;
}

// By how much the variances grow that rounding has left without that margin.
inline constexpr float kLoosening = 4 * kDefiniteMargin;

// is_positive_definite, after the variances have grown by kLoosening where it was not: what is correlated beyond what
// float can tell from a certainty (far points, whose depth and direction go together) is a little less certain instead
// of refused. Never more certain: P + diag is larger than P.
template <int N, class S>
ACCRETE_INLINE Bool<S> make_definite(Symmetric<S, N>& a) {
  const Bool<S> good = is_positive_definite(a);
  if (__builtin_expect(all_of(good), 1)) return good;
  for (int i = 0; i < N; ++i) a(i, i) = select(good, a(i, i), a(i, i) * S(1 + kLoosening));
  return is_positive_definite(a);
}

// x <- L^-1 x.
template <int N, class S>
ACCRETE_INLINE void solve_lower(const Symmetric<S, N>& l, const S* inverse, S* x) {
  ACCRETE_UNROLL
  for (int i = 0; i < N; ++i) {
    ACCRETE_UNROLL
    for (int k = 0; k < i; ++k) x[i] = x[i] - l(i, k) * x[k];
    x[i] = x[i] * inverse[i];
  }
}
// x <- L^-T x.
template <int N, class S>
ACCRETE_INLINE void solve_lower_transposed(const Symmetric<S, N>& l, const S* inverse, S* x) {
  ACCRETE_UNROLL
  for (int i = N - 1; i >= 0; --i) {
    ACCRETE_UNROLL
    for (int k = i + 1; k < N; ++k) x[i] = x[i] - l(k, i) * x[k];
    x[i] = x[i] * inverse[i];
  }
}

// Scalars only: weakens correlations until A is positive definite. Rotating a float covariance may cost it its smallest
// eigenvalue; a little less correlation is the smallest change that is certain to end. The diagonal must be positive.
template <int N, class S>
void make_positive_definite(Symmetric<S, N>& a) {
  for (S keep = S(1) - S(4e-6F); !is_positive_definite(a); keep = keep * keep) {
    if (keep < S(0.01F)) keep = S(0);
    for (int i = 0; i < N; ++i)
      for (int j = i + 1; j < N; ++j) a(i, j) = a(i, j) * keep;
    if (!(keep > S(0))) return;
  }
}

}  // namespace accrete::inline ACCRETE_ISA
