// The roll about the tangent is a convention, not a measurement: local z is drawn towards the line of sight.
#pragma once

#include "math/cholesky.h"
#include "predict/sight_kernel.h"

namespace accrete::inline ACCRETE_ISA {

// Angle about the tangent, -pi .. pi, that turns local z to the direction `sight` as far as it is normal to the
// tangent. `b` and `a` are the components of that direction along local y and z. 0 when it has none.
template <class S>
ACCRETE_INLINE S roll_towards(S b, S a) {
  const S k = inverse_sqrt(max_of(b * b + a * a, S(1e-20F)));
  return -b * k * angle_over_sine(a * k);  // Exp(roll) e_z = (0, -sin, cos)
}

// Schmidt update with a gain for the roll alone: (I - K h) P (I - K h)t + K R Kt stays positive definite for any gain,
// and nothing that was measured moves. true where the state was usable and the result is finite and positive definite.
template <class S>
ACCRETE_INLINE Bool<S> update_roll(LaneState<S>& x, const AlignedPose& pose, const AlignedOptics& optics, S variance,
                                   Bool<S>& in_front) {
  const Sight<S> sight = look_at(x.p, x.q, pose);
  in_front = sight.q[2] > S(kMinDepth_m);
  const Vector3<S> ray = {sight.q[0] - S(0.5F * optics.baseline_m), sight.q[1], sight.q[2]};
  const S residual = roll_towards(dot(ray, sight.b), dot(ray, sight.a));

  const S prior = x.P(3, 3);
  const S gain = prior / (prior + variance);
  const S keep = S(1) - gain;
  ACCRETE_UNROLL
  for (int i = 0; i < 6; ++i) {
    if (i != 3) x.P(i, 3) = flush_tiny(x.P(i, 3) * keep);
  }
  x.P(3, 3) = gain * variance;  // = keep^2 prior + gain^2 variance
  const HalfTurn<S> roll = half_turn(gain * residual);
  x.q = normalized(rolled(x.q, roll));
  turn_axes(x.P, roll);
  return is_finite(x.q.x + x.q.y + x.q.z + x.q.w) & make_definite(x.P);
}

}  // namespace accrete::inline ACCRETE_ISA
