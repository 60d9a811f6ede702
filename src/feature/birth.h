// The first estimate of any kind of feature.
#pragma once

#include "feature/feature.h"
#include "math/unscented.h"
#include "stereo/reconstruct_kernel.h"

namespace accrete::inline ACCRETE_ISA {
namespace feature {

// The first estimate, from one stereo pair, in the aligned left frame: the mean in closed form, the covariance by sigma
// points of what was measured. For float or double: births are few.
template <Feature F, class S>
requires Reconstructible<F, S> ReconstructOutcome birth(const ViewOf<F, S>* seen, const AlignedOptics& optics,
                                                        Estimate<F, S>& out) {
  constexpr int N = F::kTangent, M = F::residuals(2);
  Estimate<F, S> e;
  const ReconstructOutcome outcome = F::reconstruct(seen, optics, e.x);
  if (outcome != ReconstructOutcome::kOk) return outcome;
  Symmetric<S, M> L;
  S inverse[M];
  F::template noise<2>(seen, L);
  if (!cholesky<M>(L, L, inverse)) return ReconstructOutcome::kDegenerate;
  constexpr double kSigma = root_of_constant(F::kSpread2);
  constexpr double kWeight = 1 / F::kSpread2;  // of a pair of points, as in moments() of filter.h
  S odd[M][N], curve[M][N], mean[N] = {};
  for (int k = 0; k < M; ++k) {
    S side[2][N];
    for (int sign = 0; sign < 2; ++sign) {
      S r[M];
      for (int m = 0; m < M; ++m) r[m] = m >= k ? L(m, k) * S(sign == 0 ? kSigma : -kSigma) : S(0);
      ViewOf<F, S> views[2];
      StateOf<F, S> x;
      F::perturbed(seen, r, views);
      if (F::reconstruct(views, optics, x) != ReconstructOutcome::kOk) return ReconstructOutcome::kDegenerate;
      F::local(e.x, x, side[sign]);
    }
    for (int i = 0; i < N; ++i) {
      odd[k][i] = (side[0][i] - side[1][i]) * S(0.5 / kSigma);
      curve[k][i] = S(0.5F) * (side[0][i] + side[1][i]);
      mean[i] += curve[k][i] * S(kWeight);
    }
  }
  for (int i = 0; i < N; ++i)
    for (int j = i; j < N; ++j) {
      S sum = S(2 - F::kSpread2 / M) * mean[i] * mean[j];
      for (int k = 0; k < M; ++k) sum += odd[k][i] * odd[k][j] + S(kWeight) * curve[k][i] * curve[k][j];
      e.P(i, j) = sum;
    }
  for (int i = 0; i < N; ++i) e.P(i, i) += S(i < 3 ? kBirthPositionVariance : kBirthRotationVariance);
  if (!is_positive_definite(e.P)) return ReconstructOutcome::kDegenerate;
  out = e;
  return ReconstructOutcome::kOk;
}

}  // namespace feature
}  // namespace accrete::inline ACCRETE_ISA
