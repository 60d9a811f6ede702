// The update by a primitive that was reconstructed from one stereo pair (METHOD 5.2 B): the observation is the state
// itself, so the Kalman update in closed form is what sigma points would give.
#pragma once

#include "math/cholesky.h"
#include "math/lane_state.h"

namespace accrete::inline ACCRETE_ISA {

// d with `to` = `from` [+] d: roll, b, a, and the roll's sine and cosine. Both describe the edge in the same sense.
template <class S>
struct RotationBetween {
  Matrix3<S> m;  // of from^-1 to
  S roll, b, a, sine, cosine;
};
template <class S>
ACCRETE_INLINE RotationBetween<S> rotation_between(const Quat<S>& from, const Quat<S>& to) {
  RotationBetween<S> out;
  const Quat<S> turn = Quat<S>{-from.x, -from.y, -from.z, from.w} * to;
  out.m = rotation_matrix(turn);
  // Exp(0, b, a) Exp(roll, 0, 0) = (h s, h y + .., .., h c): n = cos(tilt / 2) is the length of (x, w), and the half
  // roll's sine and cosine are its direction. Undoing the roll leaves the tilt. The floor: opposite tangents.
  const S nn = max_of(turn.x * turn.x + turn.w * turn.w, S(1e-12F));
  const S n = sqrt_of(nn), k = n / nn;
  const S s = turn.x * k, c = turn.w * k;
  out.sine = S(2) * s * c;
  out.cosine = c * c - s * s;
  // -turn is the same rotation: the one whose half roll is within 90 degrees.
  out.roll = S(2) * select(c < S(0), -s, s) * arc_over_sine(abs_of(c));
  const S both = S(2) * arc_over_sine(min_of(n, S(1)));
  out.b = (turn.y * c - turn.z * s) * both;
  out.a = (turn.z * c + turn.y * s) * both;
  return out;
}

// K = P S^-1, P+ = K R: products of what is small where it matters, no difference (PERFORMANCE B.4). With S = L D Lt
// both factors are solved by L alone: P+ = (L^-1 P)t D^-1 (L^-1 R). `observed` is overwritten. true where the result is
// finite and positive definite.
template <class S>
ACCRETE_INLINE Bool<S> update_reconstructed(LaneState<S>& x, LaneState<S>& observed) {
  const Matrix3<S> own = rotation_matrix(x.q);
  const Vector3<S> apart =
      rotate_back<S>(own, {observed.p[0] - x.p[0], observed.p[1] - x.p[1], observed.p[2] - x.p[2]});
  const RotationBetween<S> turn = rotation_between(x.q, observed.q);
  S innovation[6] = {apart[0], apart[1], apart[2], turn.roll, turn.b, turn.a};
  // Into the frame of the state.
  rotate_position_covariance(observed.P, turn.m);
  turn_pair<4>(observed.P, turn.cosine, -turn.sine);

  Symmetric<S, 6> sum_of_both;
  ACCRETE_UNROLL
  for (int k = 0; k < Symmetric<S, 6>::kSize; ++k) sum_of_both.v[k] = x.P.v[k] + observed.P.v[k];
  S diagonal[6];
  ACCRETE_UNROLL
  for (int i = 0; i < 6; ++i) diagonal[i] = sum_of_both(i, i);
  S prior[6][6], noise[6][6];  // columns of L^-1 P and of L^-1 R
  Factors<S, 6> f;
  factorise<6>(
      f, sum_of_both, diagonal, nullptr, [&](int j) __attribute__((always_inline)) {
        solve_unit_row<6>(f.l, j, innovation);
        ACCRETE_UNROLL
        for (int i = 0; i < 6; ++i) {
          prior[i][j] = x.P(i, j);
          noise[i][j] = observed.P(i, j);
          solve_unit_row<6>(f.l, j, prior[i]);
          solve_unit_row<6>(f.l, j, noise[i]);
        }
      });
  S d[6];
  ACCRETE_UNROLL
  for (int i = 0; i < 6; ++i) {
    S gain[6];  // row i of K L
    ACCRETE_UNROLL
    for (int k = 0; k < 6; ++k) gain[k] = prior[i][k] * f.inverse[k];
    d[i] = gain[0] * innovation[0];
    ACCRETE_UNROLL
    for (int k = 1; k < 6; ++k) d[i] = d[i] + gain[k] * innovation[k];
    ACCRETE_UNROLL
    for (int j = i; j < 6; ++j) {
      S sum = gain[0] * noise[j][0];
      ACCRETE_UNROLL
      for (int k = 1; k < 6; ++k) sum = sum + gain[k] * noise[j][k];
      x.P(i, j) = flush_tiny(sum);
    }
  }
  correct(x, own, d);
  const S sum = x.p[0] + x.p[1] + x.p[2] + x.q.x + x.q.y + x.q.z + x.q.w;  // finite only if all are
  return f.good & is_finite(sum) & make_definite(x.P);
}

}  // namespace accrete::inline ACCRETE_ISA
