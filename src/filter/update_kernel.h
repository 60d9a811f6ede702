// The unscented update of six degrees of freedom by the residuals of one or two cameras, for any scalar of the kernels.
#pragma once

#include "math/cholesky.h"
#include "predict/residual_kernel.h"

namespace accrete::inline ACCRETE_ISA {

// Rounding keeps a covariance from shrinking to nothing over millions of frames: (0.1 um)^2 and (1 urad)^2, far below
// anything that two cameras see.
inline constexpr float kPositionFloor = 1e-14F;
inline constexpr float kRotationFloor = 1e-12F;

template <class S>
struct Updated {
  Bool<S> in_front;  // false: nothing else means anything
  Bool<S> good;      // the new state is finite and positive definite
};

// Bounds the variance along the tangent: a congruence that shrinks that one direction, so the matrix stays positive
// definite. METHOD 4.1: the slide is not observable, but it is never more than half the sampling pitch.
template <class S>
ACCRETE_INLINE void cap_slide(LaneState<S>& x, const Vector3<S>& t, S cap) {
  Vector3<S> pt;
  for (int i = 0; i < 3; ++i) pt[i] = x.P(i, 0) * t[0] + x.P(i, 1) * t[1] + x.P(i, 2) * t[2];
  const S variance = dot(t, pt);
  const S keep = select(variance > cap, sqrt_of(cap / max_of(variance, S(1e-30F))), S(1));
  const S cut = keep - S(1);  // D = I + cut t tt; P <- D P Dt
  ACCRETE_UNROLL
  for (int i = 0; i < 3; ++i) {
    ACCRETE_UNROLL
    for (int j = i; j < 3; ++j)
      x.P(i, j) = x.P(i, j) + cut * (t[i] * pt[j] + pt[i] * t[j]) + cut * cut * variance * t[i] * t[j];
  }
  ACCRETE_UNROLL
  for (int j = 3; j < 6; ++j) {
    const S along = t[0] * x.P(0, j) + t[1] * x.P(1, j) + t[2] * x.P(2, j);
    ACCRETE_UNROLL
    for (int i = 0; i < 3; ++i) x.P(i, j) = x.P(i, j) + cut * t[i] * along;
  }
}

// K = C S^-1, and the covariance of what the state does not explain linearly: R + even.
template <class S, int M>
struct Gain {
  S K[6][M];
  Symmetric<S, M> rest;
  Bool<S> good;
};

template <class S, int M>
ACCRETE_INLINE Gain<S, M> kalman_gain(const Symmetric<S, 6>& L, const ResidualMoments<S, M>& moments,
                                      const S* variance) {
  Gain<S, M> out;
  Symmetric<S, M> innovation = state_covariance(moments);
  out.rest = moments.even;
  ACCRETE_UNROLL
  for (int m = 0; m < M; ++m) {
    innovation(m, m) += variance[m];
    out.rest(m, m) += variance[m];
  }
  S diagonal[M];
  ACCRETE_UNROLL
  for (int m = 0; m < M; ++m) diagonal[m] = innovation(m, m);
  const Factors<S, M> f = factorise<M>(innovation, diagonal);
  out.good = f.good;
  ACCRETE_UNROLL
  for (int i = 0; i < 6; ++i) {
    ACCRETE_UNROLL
    for (int m = 0; m < M; ++m) {
      S sum = S(0);
      ACCRETE_UNROLL
      for (int j = 0; j <= i; ++j) sum = sum - L(i, j) * moments.odd[j][m];  // residual = observed - predicted: minus
      out.K[i][m] = sum;
    }
    solve<M>(f, out.K[i]);
  }
  return out;
}

// P = sum over sigma points of (d_i + K r_i)(d_i + K r_i)t + K R Kt. Equal to P - K S Kt, but a sum of squares: no
// difference of large numbers, whatever the ratio of prior to noise.
template <class S, int M>
ACCRETE_INLINE void posterior_covariance(const Symmetric<S, 6>& L, const ResidualMoments<S, M>& moments,
                                         const Gain<S, M>& gain, Symmetric<S, 6>& P) {
  ACCRETE_UNROLL
  for (int i = 0; i < 6; ++i) {
    S weighted[M];  // row i of K (R + even)
    ACCRETE_UNROLL
    for (int m = 0; m < M; ++m) {
      weighted[m] = gain.K[i][0] * gain.rest(0, m);
      ACCRETE_UNROLL
      for (int k = 1; k < M; ++k) weighted[m] = weighted[m] + gain.K[i][k] * gain.rest(k, m);
    }
    ACCRETE_UNROLL
    for (int k = i; k < 6; ++k) {
      S sum = weighted[0] * gain.K[k][0];
      ACCRETE_UNROLL
      for (int m = 1; m < M; ++m) sum = sum + weighted[m] * gain.K[k][m];
      P(i, k) = sum;
    }
  }
  ACCRETE_UNROLL
  for (int j = 0; j < 6; ++j) {
    S d[6];
    ACCRETE_UNROLL
    for (int i = 0; i < 6; ++i) {
      S sum = i >= j ? L(i, j) : S(0);
      ACCRETE_UNROLL
      for (int m = 0; m < M; ++m) sum = sum + gain.K[i][m] * moments.odd[j][m];
      d[i] = flush_tiny(sum);
    }
    ACCRETE_UNROLL
    for (int i = 0; i < 6; ++i) {
      ACCRETE_UNROLL
      for (int k = i; k < 6; ++k) P(i, k) = P(i, k) + d[i] * d[k];
    }
  }
}

// One update. variance: of the M = 2 Eyes residuals (px^2, rad^2 for each eye). slide_cap: m^2, infinity for none.
// `x` is overwritten in every lane: the caller keeps the old state where the result is not good.
template <int Eyes, class S>
ACCRETE_INLINE Updated<S> update_geometry(LaneState<S>& x, const View<S>* views, const S* variance,
                                          const AlignedPose& pose, const AlignedOptics& optics, S slide_cap) {
  constexpr int M = 2 * Eyes;
  Updated<S> out;
  const Sight<S> sight = look_at(x.p, x.q, pose);
  out.in_front = is_in_front(sight, S(optics.baseline_m));

  Symmetric<S, 6> L;
  S inverse[6];
  out.good = cholesky<6>(x.P, L, inverse);
  const ResidualMoments<S, M> moments = residual_moments<Eyes>(sight, L, views, S(optics.focal_px));
  const Gain<S, M> gain = kalman_gain(L, moments, variance);
  posterior_covariance(L, moments, gain, x.P);

  S d[6];
  ACCRETE_UNROLL
  for (int i = 0; i < 6; ++i) {
    d[i] = S(0);
    ACCRETE_UNROLL
    for (int m = 0; m < M; ++m) d[i] = d[i] + gain.K[i][m] * moments.mean[m];
    x.P(i, i) += S(i < 3 ? kPositionFloor : kRotationFloor);
  }
  for (int i = 0; i < 3; ++i) x.p[i] += d[i];
  const HalfTurn<S> roll = half_turn(d[3]);
  x.q = retract(x.q, roll, d[4], d[5]);
  turn_tilts(x.P, roll);  // the roll is not observed, but noise of the motion may have correlated it with the rest
  cap_slide<S>(x, rotation_matrix(x.q).col(0), slide_cap);

  const S sum = x.p[0] + x.p[1] + x.p[2] + x.q.x + x.q.y + x.q.z + x.q.w;  // finite only if all are
  out.good = out.good & gain.good & is_finite(sum) & make_definite(x.P);
  return out;
}

}  // namespace accrete::inline ACCRETE_ISA
