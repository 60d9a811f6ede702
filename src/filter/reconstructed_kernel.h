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
  const Tilt<S> tilt = tilt_to(out.m(0, 0), out.m(1, 0), out.m(2, 0));
  // What is left after the tilt is a turn about x: Exp(0, -b, -a) turn, of which y and z are not needed.
  const HalfAngle<S> h = half_angle(tilt.b * tilt.b + tilt.a * tilt.a);
  const S y = tilt.b * h.sine_over_angle, z = tilt.a * h.sine_over_angle;
  struct {
    S x, w;
  } const rest = {h.cosine * turn.x - y * turn.z + z * turn.y, h.cosine * turn.w + y * turn.y + z * turn.z};
  const S k = S(1) / (rest.x * rest.x + rest.w * rest.w);
  out.sine = S(2) * rest.x * rest.w * k;
  out.cosine = (rest.w * rest.w - rest.x * rest.x) * k;
  out.roll = out.sine * angle_over_sine(out.cosine);
  out.b = tilt.b;
  out.a = tilt.a;
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
  const Factors<S, 6> f = factorise<6>(sum_of_both, diagonal);
  solve_unit_lower<6>(f.l, innovation);
  S prior[6][6], noise[6][6];  // columns of D^-1 L^-1 P and of L^-1 R
  ACCRETE_UNROLL
  for (int j = 0; j < 6; ++j) {
    ACCRETE_UNROLL
    for (int i = 0; i < 6; ++i) {
      prior[j][i] = x.P(i, j);
      noise[j][i] = observed.P(i, j);
    }
    solve_unit_lower<6>(f.l, prior[j]);
    solve_unit_lower<6>(f.l, noise[j]);
    ACCRETE_UNROLL
    for (int i = 0; i < 6; ++i) prior[j][i] = prior[j][i] * f.inverse[i];
  }
  S d[6];
  ACCRETE_UNROLL
  for (int i = 0; i < 6; ++i) {
    d[i] = prior[i][0] * innovation[0];
    ACCRETE_UNROLL
    for (int k = 1; k < 6; ++k) d[i] = d[i] + prior[i][k] * innovation[k];
    ACCRETE_UNROLL
    for (int j = i; j < 6; ++j) {
      S sum = prior[i][0] * noise[j][0];
      ACCRETE_UNROLL
      for (int k = 1; k < 6; ++k) sum = sum + prior[i][k] * noise[j][k];
      x.P(i, j) = flush_tiny(sum);
    }
  }
  correct(x, own, d);
  const S sum = x.p[0] + x.p[1] + x.p[2] + x.q.x + x.q.y + x.q.z + x.q.w;  // finite only if all are
  return f.good & is_finite(sum) & make_definite(x.P);
}

}  // namespace accrete::inline ACCRETE_ISA
