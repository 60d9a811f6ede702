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

// Bounds the variance along the tangent by shrinking that one error, so the matrix stays positive definite. METHOD 4.1:
// the slide is not observable, but it is never more than half the sampling pitch.
template <class S>
ACCRETE_INLINE void cap_slide(Symmetric<S, 6>& P, S cap) {
  const S variance = P(kAlong, kAlong);
  const Bool<S> beyond = variance > cap;
  const S keep = select(beyond, sqrt_of(cap / max_of(variance, S(1e-30F))), S(1));
  P(kAlong, kAlong) = select(beyond, cap, variance);
  ACCRETE_UNROLL
  for (int j = 1; j < 6; ++j) P(kAlong, j) = P(kAlong, j) * keep;
}

// K = C S^-1 of what is seen, and the covariance of what the state does not explain linearly: R + even.
template <class S, int M>
struct Gain {
  S K[4][M];
  Symmetric<S, M> rest;
  Bool<S> good;
};

template <class S, int M>
ACCRETE_INLINE Gain<S, M> kalman_gain(const Symmetric<S, 4>& L, const ResidualMoments<S, M>& moments,
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
  for (int i = 0; i < 4; ++i) {
    ACCRETE_UNROLL
    for (int m = 0; m < M; ++m) {
      S sum = -(L(i, 0) * moments.odd[0][m]);  // residual = observed - predicted: minus
      ACCRETE_UNROLL
      for (int j = 1; j <= i; ++j) sum = sum - L(i, j) * moments.odd[j][m];
      out.K[i][m] = sum;
    }
    solve<M>(f, out.K[i]);
  }
  return out;
}

// P = sum over sigma points of (d_i + K r_i)(d_i + K r_i)t + K R Kt. Equal to P - K S Kt, but a sum of squares: no
// difference of large numbers, whatever the ratio of prior to noise. Of what is seen.
template <class S, int M>
ACCRETE_INLINE Symmetric<S, 4> posterior_covariance(const Symmetric<S, 4>& L, const ResidualMoments<S, M>& moments,
                                                    const Gain<S, M>& gain) {
  Symmetric<S, 4> P;
  ACCRETE_UNROLL
  for (int i = 0; i < 4; ++i) {
    S weighted[M];  // row i of K (R + even)
    ACCRETE_UNROLL
    for (int m = 0; m < M; ++m) {
      weighted[m] = gain.K[i][0] * gain.rest(0, m);
      ACCRETE_UNROLL
      for (int k = 1; k < M; ++k) weighted[m] = weighted[m] + gain.K[i][k] * gain.rest(k, m);
    }
    ACCRETE_UNROLL
    for (int k = i; k < 4; ++k) {
      S sum = weighted[0] * gain.K[k][0];
      ACCRETE_UNROLL
      for (int m = 1; m < M; ++m) sum = sum + weighted[m] * gain.K[k][m];
      P(i, k) = sum;
    }
  }
  ACCRETE_UNROLL
  for (int j = 0; j < 4; ++j) {
    S d[4];
    ACCRETE_UNROLL
    for (int i = 0; i < 4; ++i) {
      S sum = gain.K[i][0] * moments.odd[j][0];
      ACCRETE_UNROLL
      for (int m = 1; m < M; ++m) sum = sum + gain.K[i][m] * moments.odd[j][m];
      d[i] = flush_tiny(i >= j ? L(i, j) + sum : sum);
    }
    ACCRETE_UNROLL
    for (int i = 0; i < 4; ++i) {
      ACCRETE_UNROLL
      for (int k = i; k < 4; ++k) P(i, k) = P(i, k) + d[i] * d[k];
    }
  }
  return P;
}

// What is along the edge, and the roll, are corrected as far as they are correlated with what is seen: regression on it
// by A = P_us P_ss^-1, and the rest, P_uu - A P_su, stays.
template <class S>
struct Unseen {
  S A[2][4];  // along, roll
  S rest[3];  // (along, along), (along, roll), (roll, roll)
  Bool<S> good;
};

template <class S>
ACCRETE_INLINE Unseen<S> unseen_of(const Symmetric<S, 6>& P, const Root<S>& root) {
  Unseen<S> u;
  root_row(P, kRoll, root, u.A[1]);
  u.rest[0] = root.along_rest;
  u.rest[1] = P(kAlong, kRoll);
  u.rest[2] = P(kRoll, kRoll);
  ACCRETE_UNROLL
  for (int j = 0; j < 4; ++j) {
    u.A[0][j] = root.along[j];
    u.rest[1] = u.rest[1] - u.A[0][j] * u.A[1][j];
    u.rest[2] = u.rest[2] - u.A[1][j] * u.A[1][j];
  }
  u.rest[1] = flush_tiny(u.rest[1]);
  // The last pivot, times the one before it.
  u.good = u.rest[2] * u.rest[0] - u.rest[1] * u.rest[1] > P(kRoll, kRoll) * S(kMinPivot) * u.rest[0];
  ACCRETE_UNROLL
  for (auto& row : u.A) solve_lower_transposed<4>(root.L, root.inverse, row);
  return u;
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

  const Root<S> root = root_of(x.P);
  const ResidualMoments<S, M> moments = residual_moments<Eyes>(sight, root, views, S(optics.focal_px));
  const Gain<S, M> gain = kalman_gain(root.L, moments, variance);
  const Symmetric<S, 4> seen = posterior_covariance(root.L, moments, gain);
  const Unseen<S> unseen = unseen_of(x.P, root);

  S d[6];
  ACCRETE_UNROLL
  for (int i = 0; i < 4; ++i) {
    S sum = gain.K[i][0] * moments.mean[0];
    ACCRETE_UNROLL
    for (int m = 1; m < M; ++m) sum = sum + gain.K[i][m] * moments.mean[m];
    d[kSeen[i]] = sum;
    ACCRETE_UNROLL
    for (int k = i; k < 4; ++k) x.P(kSeen[i], kSeen[k]) = seen(i, k);
  }
  S with_seen[2][4];  // A P_ss
  ACCRETE_UNROLL
  for (int u = 0; u < 2; ++u) {
    const int row = u == 0 ? kAlong : kRoll;
    const S* A = unseen.A[u];
    ACCRETE_UNROLL
    for (int i = 0; i < 4; ++i) {
      with_seen[u][i] = A[0] * seen(0, i) + A[1] * seen(1, i) + A[2] * seen(2, i) + A[3] * seen(3, i);
      x.P(row, kSeen[i]) = flush_tiny(with_seen[u][i]);
    }
    d[row] = A[0] * d[1] + A[1] * d[2] + A[2] * d[4] + A[3] * d[5];
  }
  const auto between = [&](int u, int w) {
    const S *a = with_seen[u], *b = unseen.A[w];
    return unseen.rest[u + w] + a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  };
  x.P(kAlong, kAlong) = between(0, 0);
  x.P(kAlong, kRoll) = between(0, 1);
  x.P(kRoll, kRoll) = between(1, 1);
  ACCRETE_UNROLL
  for (int i = 0; i < 6; ++i) x.P(i, i) += S(i < 3 ? kPositionFloor : kRotationFloor);
  correct(x, sight.own, d);
  cap_slide(x.P, slide_cap);

  const S sum = x.p[0] + x.p[1] + x.p[2] + x.q.x + x.q.y + x.q.z + x.q.w;  // finite only if all are
  out.good = root.good & unseen.good & gain.good & is_finite(sum) & make_definite(x.P);
  return out;
}

}  // namespace accrete::inline ACCRETE_ISA
