// Cholesky of small symmetric matrices on lanes: no branch, and a mask that says in which lanes it means something.
#pragma once

#include <type_traits>

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
    const Bool<S> ok = (pivot > least) & (least > S(0)) & (pivot <= S(kLargest));
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

// A = L D Lt without square roots. L has a unit diagonal, which is not stored.
template <class S, int N>
struct Factors {
  Symmetric<S, N> l;         // L(i, j), i > j
  Symmetric<S, N> unscaled;  // L(i, j) D(j), i >= j
  S inverse[N];              // 1 / D(j)
  S rest[N];                 // D(j) without what was added to the diagonal: the variance given 0 .. j - 1
  Bool<S> good;              // as of cholesky()
};

// Element I of L^-1 x, from those before it: x[0 .. I - 1] are already those of L^-1 x. Unit diagonal.
template <int N, class S>
ACCRETE_INLINE void solve_unit_row(const Symmetric<S, N>& l, int i, S* x) {
  ACCRETE_UNROLL
  for (int k = 0; k < i; ++k) x[i] = x[i] - l(i, k) * x[k];
}

// x <- L^-1 x with the unit diagonal.
template <int N, class S>
ACCRETE_INLINE void solve_unit_lower(const Symmetric<S, N>& l, S* x) {
  ACCRETE_UNROLL
  for (int i = 1; i < N; ++i) solve_unit_row<N>(l, i, x);
}

// Of A with another diagonal, to which added[j] >= 0 comes if there is such. Every product has two factors that were
// flushed or are pivots, so none is subnormal. meanwhile(j) is called when row j of L is known and while 1 / D(j) is
// still being divided: whoever solves for L does its row there, and the chain of pivots waits for nobody.
template <int N, class S, class Meanwhile>
ACCRETE_INLINE void factorise(Factors<S, N>& f, const Symmetric<S, N>& a, const S* diagonal,
                              const std::type_identity_t<S>* added, Meanwhile meanwhile) {
  f.good = S(0) == S(0);
  ACCRETE_UNROLL
  for (int j = 0; j < N; ++j) {
    S pivot = diagonal[j];
    const S least = (added != nullptr ? pivot + added[j] : pivot) * S(kMinPivot);
    ACCRETE_UNROLL
    for (int k = 0; k < j; ++k) pivot = pivot - f.l(j, k) * f.unscaled(j, k);
    f.rest[j] = pivot;
    if (added != nullptr) pivot = pivot + added[j];
    // False, too, where the diagonal is infinite or no number. Such a lane goes on with what it has: nothing of it is
    // used, and to choose another pivot would be one more to wait for.
    f.good = f.good & (pivot > least) & (least > S(0));
    f.unscaled(j, j) = pivot;
    f.inverse[j] = S(1) / pivot;
    meanwhile(j);
    ACCRETE_UNROLL
    for (int i = j + 1; i < N; ++i) {
      S sum = a(i, j);
      ACCRETE_UNROLL
      for (int k = 0; k < j; ++k) sum = sum - f.l(i, k) * f.unscaled(j, k);
      f.unscaled(i, j) = flush_tiny(sum);
      f.l(i, j) = f.unscaled(i, j) * f.inverse[j];
    }
  }
}
template <int N, class S>
ACCRETE_INLINE Factors<S, N> factorise(const Symmetric<S, N>& a, const S* diagonal, const S* added = nullptr) {
  Factors<S, N> f;
  factorise<N>(f, a, diagonal, added, [](int) {});
  return f;
}

// x <- A^-1 x.
template <int N, class S>
ACCRETE_INLINE void solve(const Factors<S, N>& f, S* x) {
  solve_unit_lower<N>(f.l, x);
  ACCRETE_UNROLL
  for (int i = N - 1; i >= 0; --i) {
    x[i] = x[i] * f.inverse[i];
    ACCRETE_UNROLL
    for (int k = i + 1; k < N; ++k) x[i] = x[i] - f.l(k, i) * x[k];
  }
}

// Is A finite and positive definite, with a margin of kDefiniteMargin?
template <int N, class S>
ACCRETE_INLINE Bool<S> is_positive_definite(const Symmetric<S, N>& a) {
  S diagonal[N];
  ACCRETE_UNROLL
  for (int j = 0; j < N; ++j) diagonal[j] = a(j, j) * S(1 - kDefiniteMargin);
  return factorise<N>(a, diagonal).good;
}

// The same answer without a chain of pivots, where it is easy to give: the correlations off the diagonal, rho_ij, have
// squares that sum up to less than 0.45. So the correlation matrix differs from the identity by less than sqrt(2 *
// 0.45) < 0.95 in the Frobenius norm, and no eigenvalue is below 0.05. false: is_positive_definite() must be asked.
template <int N, class S>
ACCRETE_INLINE Bool<S> is_weakly_correlated(const Symmetric<S, N>& a) {
  S inverse[N], least = a(0, 0), most = a(0, 0), sum = S(0);
  ACCRETE_UNROLL
  for (int i = 0; i < N; ++i) {
    inverse[i] = S(1) / a(i, i);
    least = min_of(least, a(i, i));
    most = max_of(most, a(i, i));
  }
  ACCRETE_UNROLL
  for (int i = 0; i < N - 1; ++i) {
    S row = a(i, N - 1) * a(i, N - 1) * inverse[N - 1];
    ACCRETE_UNROLL
    for (int j = i + 1; j < N - 1; ++j) row = row + a(i, j) * a(i, j) * inverse[j];
    sum = sum + row * inverse[i];
  }
  // Bounds of the variances: where kMinPivot of one is no subnormal number, and nothing overflows. A variance that is
  // no number makes the sum none.
  return (sum < S(0.45F)) & (least > S(1e-30F)) & (most < S(1e15F));
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
  ACCRETE_UNROLL
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

}  // namespace accrete::inline ACCRETE_ISA
