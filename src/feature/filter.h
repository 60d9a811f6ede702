// The filter of any kind of feature: unscented update by what one or two cameras see, linear update of the
// appearance. The edge's kernels (filter/update_kernel.h) are this, worked out for one kind.
#pragma once

#include "feature/feature.h"
#include "filter/appearance_kernel.h"
#include "math/unscented.h"

namespace accrete::inline ACCRETE_ISA {
namespace feature {

// What rounding may never take away, as of edges (filter/update_kernel.h): (0.1 um)^2 and (1 urad)^2.
inline constexpr float kFloorPosition2 = 1e-14F, kFloorAngle2 = 1e-12F;

template <class S>
struct Updated {
  Bool<S> visible;  // false: nothing else means anything
  Bool<S> good;     // the new state is finite and positive definite
};

// Sums over the sigma points, as ResidualMoments (predict/residual_kernel.h), for any dimensions.
template <class S, int N, int M>
struct Moments {
  S central[M];          // of the mean itself
  S mean[M];             // mean of the residual
  S odd[N][M];           // with it, cov(state, residual) = sum_j L_j odd_jt
  Symmetric<S, M> even;  // the covariance of the residual that is not sum_j odd_j odd_jt: curvature
  Bool<S> visible;       // false: the mean cannot be seen, and nothing else means anything
};

template <Feature F, int Eyes, class S>
Bool<S> residual(const StateOf<F, S>& x, const Camera<S>* cameras, const ViewOf<F, S>* seen, S* r) {
  ViewOf<F, S> predicted[Eyes];
  Bool<S> visible = F::look(x, cameras[0], predicted[0]);
  if constexpr (Eyes == 2) visible = visible & F::look(x, cameras[1], predicted[1]);
  F::template difference<Eyes>(predicted, seen, r);
  return visible;
}

// A root of P, column by column.
template <class F, class S>
struct RootOf {
  S column[F::kTangent][F::kTangent];
  Bool<S> good;
};
template <class F, class S>
RootOf<F, S> root_of(const Covariance<F, S>& P) {
  constexpr int N = F::kTangent;
  using Order = RootOrder<F>;
  RootOf<F, S> root;
  Covariance<F, S> L;
  S inverse[N];
  for (int i = 0; i < N; ++i)
    for (int j = i; j < N; ++j) L(i, j) = P(Order::component(i), Order::component(j));
  root.good = cholesky<N>(L, L, inverse);
  for (int j = 0; j < N; ++j)
    for (int i = 0; i < N; ++i) root.column[j][Order::component(i)] = i >= j ? L(i, j) : S(0);
  return root;
}

// Sigma points at sqrt(c) L_j, c = alpha^2 (N + kappa), and beta = 2: the covariance is a
// sum of squares for any c up to 2 N, although the central weight may be negative (docs/math/features.md).
template <Feature F, int Eyes, class S>
Moments<S, F::kTangent, F::residuals(Eyes)> moments(const StateOf<F, S>& x, const RootOf<F, S>& root,
                                                    const Camera<S>* cameras, const ViewOf<F, S>* seen) {
  constexpr int N = F::kTangent, M = F::residuals(Eyes);
  constexpr double kSigma = root_of_constant(F::kSpread2);
  constexpr double kWeight = 1 / F::kSpread2;  // of a pair of points
  constexpr double kCurved = 2 - F::kSpread2 / N;
  Moments<S, N, M> out;
  out.visible = residual<F, Eyes>(x, cameras, seen, out.central);
  S curve[N][M], shift[M];
  for (int m = 0; m < M; ++m) shift[m] = S(0);
  for (int j = 0; j < N; ++j) {
    S plus[M], minus[M], d[N];
    for (int i = 0; i < N; ++i) d[i] = root.column[j][i] * S(kSigma);
    (void)residual<F, Eyes>(F::retract(x, d), cameras, seen, plus);
    for (int i = 0; i < N; ++i) d[i] = -d[i];
    (void)residual<F, Eyes>(F::retract(x, d), cameras, seen, minus);
    for (int m = 0; m < M; ++m) {
      out.odd[j][m] = flush_tiny((plus[m] - minus[m]) * S(0.5 / kSigma));
      curve[j][m] = S(0.5F) * (plus[m] + minus[m]) - out.central[m];
      shift[m] += curve[j][m] * S(kWeight);
    }
  }
  for (int i = 0; i < M; ++i) {
    out.mean[i] = out.central[i] + shift[i];
    for (int k = i; k < M; ++k) {
      S sum = S(0);
      for (int j = 0; j < N; ++j) sum += curve[j][i] * curve[j][k];
      out.even(i, k) = sum * S(kWeight) + S(kCurved) * shift[i] * shift[k];
    }
  }
  return out;
}

// Covariance of the residual: what the state causes, and the noise.
template <class S, int N, int M>
Symmetric<S, M> innovation_covariance(const Moments<S, N, M>& moments, const Symmetric<S, M>& noise) {
  Symmetric<S, M> c;
  for (int i = 0; i < M; ++i)
    for (int k = i; k < M; ++k) {
      S sum = moments.even(i, k) + noise(i, k);
      for (int j = 0; j < N; ++j) sum += moments.odd[j][i] * moments.odd[j][k];
      c(i, k) = sum;
    }
  return c;
}

// `seen`: of Eyes cameras, in the description that fits the state (associate.h). `e` is overwritten in every lane: the
// caller keeps the old one where the result is not good.
template <Feature F, int Eyes, class S>
Updated<S> update(Estimate<F, S>& e, const Camera<S>* cameras, const ViewOf<F, S>* seen) {
  constexpr int N = F::kTangent, M = F::residuals(Eyes);
  Updated<S> out;
  const RootOf<F, S> root = root_of<F>(e.P);
  const Moments<S, N, M> sums = moments<F, Eyes>(e.x, root, cameras, seen);
  out.visible = sums.visible;
  Symmetric<S, M> noise;
  F::template noise<Eyes>(seen, noise);

  // K = C S^-1 row by row; residual = observed - predicted, hence the minus.
  Symmetric<S, M> innovation = innovation_covariance(sums, noise);
  S inverse[M];
  out.good = root.good & cholesky<M>(innovation, innovation, inverse);
  S K[N][M], d[N];
  for (int i = 0; i < N; ++i) {
    for (int m = 0; m < M; ++m) {
      K[i][m] = S(0);
      for (int j = 0; j < N; ++j) K[i][m] -= root.column[j][i] * sums.odd[j][m];
    }
    solve_lower<M>(innovation, inverse, K[i]);
    solve_lower_transposed<M>(innovation, inverse, K[i]);
    d[i] = S(0);
    for (int m = 0; m < M; ++m) d[i] += K[i][m] * sums.mean[m];
  }

  // P = sum_j (L_j + K odd_j)(L_j + K odd_j)t + K (R + even) Kt: a sum of squares (docs/math/filter.md).
  for (int i = 0; i < N; ++i) {
    S weighted[M];
    for (int m = 0; m < M; ++m) {
      weighted[m] = S(0);
      for (int k = 0; k < M; ++k) weighted[m] += K[i][k] * (noise(k, m) + sums.even(k, m));
    }
    for (int k = i; k < N; ++k) {
      e.P(i, k) = S(0);
      for (int m = 0; m < M; ++m) e.P(i, k) += weighted[m] * K[k][m];
    }
  }
  for (int j = 0; j < N; ++j) {
    S column[N];
    for (int i = 0; i < N; ++i) {
      S sum = root.column[j][i];
      for (int m = 0; m < M; ++m) sum += K[i][m] * sums.odd[j][m];
      column[i] = flush_tiny(sum);
    }
    for (int i = 0; i < N; ++i)
      for (int k = i; k < N; ++k) e.P(i, k) += column[i] * column[k];
  }
  for (int i = 0; i < N; ++i) e.P(i, i) += S(i < 3 ? kFloorPosition2 : kFloorAngle2);

  S sum = S(0);
  for (int i = 0; i < N; ++i) sum += d[i];
  e.x = F::retract(e.x, d);
  F::settle(e.P, d);
  out.good = out.good & is_finite(sum) & make_definite(e.P);
  return out;
}

// Appearance: it observes itself. The first `Phases` components are angles.
template <class S, int N>
struct LinearEstimate {
  S mean[N];
  Symmetric<S, N> P;
};

// noise, process: variances. As update_appearance of an edge (filter/appearance_kernel.h): P+ = K R, symmetrised.
template <int Phases, class S, int N>
Bool<S> update_linear(LinearEstimate<S, N>& x, const S* observed, const S* noise, const S* process) {
  S innovation[N];
  for (int i = 0; i < N; ++i) {
    innovation[i] = observed[i] - x.mean[i];
    if (i < Phases) innovation[i] = wrap_phase(innovation[i]);
    x.P(i, i) += process[i];
  }
  Symmetric<S, N> root = x.P;
  for (int i = 0; i < N; ++i) root(i, i) += noise[i];
  S inverse[N], K[N][N], sum = S(0);
  Bool<S> good = cholesky<N>(root, root, inverse);
  for (int i = 0; i < N; ++i) {
    for (int k = 0; k < N; ++k) K[i][k] = x.P(i, k);
    solve_lower<N>(root, inverse, K[i]);
    solve_lower_transposed<N>(root, inverse, K[i]);
    for (int k = 0; k < N; ++k) x.mean[i] += K[i][k] * innovation[k];
    x.mean[i] = flush_tiny(x.mean[i]);
    if (i < Phases) {
      x.mean[i] = wrap_any_phase(x.mean[i]);
      good = good & is_phase(x.mean[i]);
    }
    sum += x.mean[i];
  }
  for (int i = 0; i < N; ++i)
    for (int k = i; k < N; ++k)
      x.P(i, k) = i == k ? K[i][i] * noise[i] : flush_tiny(S(0.5F) * (K[i][k] * noise[k] + K[k][i] * noise[i]));
  return good & is_finite(sum) & make_definite(x.P);
}

// The squared error of `e` against `other`, a truth or another estimate of covariance zero, in what is observable; -1
// when it has none. Of an honest filter kObservable in the mean.
template <Feature F, class S>
S normalised_error(const Estimate<F, S>& e, const StateOf<F, S>& other) {
  constexpr int N = F::kTangent, K = F::kObservable;
  S d[K], J[K][N], inverse[K];
  F::observable(e.x, other, d, J);
  Symmetric<S, K> c;
  for (int i = 0; i < K; ++i) {
    S row[N];
    for (int n = 0; n < N; ++n) {
      row[n] = S(0);
      for (int m = 0; m < N; ++m) row[n] += J[i][m] * e.P(m, n);
    }
    for (int k = i; k < K; ++k) {
      c(i, k) = S(0);
      for (int n = 0; n < N; ++n) c(i, k) += row[n] * J[k][n];
    }
  }
  const Bool<S> good = cholesky<K>(c, c, inverse);
  solve_lower<K>(c, inverse, d);
  S sum = S(0);
  for (int i = 0; i < K; ++i) sum += d[i] * d[i];
  return select(good, sum, S(-1));
}

}  // namespace feature
}  // namespace accrete::inline ACCRETE_ISA
