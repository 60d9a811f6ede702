// Rotations as unit quaternions (x, y, z, w) and their retraction, branch-free and without libm: the exponential map by
// a rational chart. tan(x) = x (15 - x^2) / (15 - 6 x^2) at x = angle / 4 is right to 2e-7 at an angle of 1 rad
// and 7e-5 at 2.4, gives an exact unit quaternion whatever its error is, and costs one division.
#pragma once

#include "math/matrix.h"

namespace accrete::inline ACCRETE_ISA {

template <class S>
struct Quat {
  S x, y, z, w;
};

template <class S>
ACCRETE_INLINE Quat<S> operator*(const Quat<S>& a, const Quat<S>& b) {
  return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

template <class S>
ACCRETE_INLINE Quat<S> normalized(const Quat<S>& q) {
  const S k = inverse_sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  return {q.x * k, q.y * k, q.z * k, q.w * k};
}

// Columns: tangent, b, a of the primitive's own frame.
template <class S>
ACCRETE_INLINE Matrix3<S> rotation_matrix(const Quat<S>& q) {
  const S x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
  const S xx = q.x * x2, yy = q.y * y2, zz = q.z * z2, xy = q.x * y2, xz = q.x * z2, yz = q.y * z2;
  const S wx = q.w * x2, wy = q.w * y2, wz = q.w * z2;
  Matrix3<S> m;
  m(0, 0) = S(1) - (yy + zz);
  m(0, 1) = xy - wz;
  m(0, 2) = xz + wy;
  m(1, 0) = xy + wz;
  m(1, 1) = S(1) - (xx + zz);
  m(1, 2) = yz - wx;
  m(2, 0) = xz - wy;
  m(2, 1) = yz + wx;
  m(2, 2) = S(1) - (xx + yy);
  return m;
}

// sin(angle / 2) / angle and cos(angle / 2) from the squared angle.
template <class S>
struct HalfAngle {
  S sine_over_angle, cosine;
};
template <class S>
ACCRETE_INLINE HalfAngle<S> half_angle(S angle2) {
  const S x2 = angle2 * S(0.0625F);
  const S n = S(15) - x2, d = S(15) - S(6) * x2;
  const S dd = d * d, xnn = x2 * n * n;
  const S k = S(1) / (dd + xnn);
  return {S(0.5F) * n * d * k, (dd - xnn) * k};
}

// Exp(rotation vector).
template <class S>
ACCRETE_INLINE Quat<S> exp_rotation(S x, S y, S z) {
  const HalfAngle<S> h = half_angle(x * x + y * y + z * z);
  return {x * h.sine_over_angle, y * h.sine_over_angle, z * h.sine_over_angle, h.cosine};
}

// Sine and cosine of half of a turn about the tangent.
template <class S>
struct HalfTurn {
  S sine, cosine;
};
template <class S>
ACCRETE_INLINE HalfTurn<S> half_turn(S roll) {
  const HalfAngle<S> h = half_angle(roll * roll);
  return {roll * h.sine_over_angle, h.cosine};
}

template <class S>
ACCRETE_INLINE S cosine_of(const HalfTurn<S>& h) {
  return S(1) - S(2) * h.sine * h.sine;
}
template <class S>
ACCRETE_INLINE S sine_of(const HalfTurn<S>& h) {
  return S(2) * h.sine * h.cosine;
}

// q Exp(roll, 0, 0): the product of quaternions without what is multiplied by zero, which no compiler may leave out.
template <class S>
ACCRETE_INLINE Quat<S> rolled(const Quat<S>& q, const HalfTurn<S>& h) {
  return {q.x * h.cosine + q.w * h.sine, q.y * h.cosine + q.z * h.sine, q.z * h.cosine - q.y * h.sine,
          q.w * h.cosine - q.x * h.sine};
}

// Exp(0, b, a) Exp(roll, 0, 0): first the tilt of the tangent, then the roll about the new tangent. A roll of 50
// degrees leaks into no tilt, and no reset of the covariance is needed (METHOD 5.3).
template <class S>
ACCRETE_INLINE Quat<S> turn_of(const HalfTurn<S>& roll, S b, S a) {
  const HalfAngle<S> h = half_angle(b * b + a * a);
  const S y = b * h.sine_over_angle, z = a * h.sine_over_angle;
  return {h.cosine * roll.sine, y * roll.cosine + z * roll.sine, z * roll.cosine - y * roll.sine,
          h.cosine * roll.cosine};
}

// R [+] d = R Exp(0, b, a) Exp(roll, 0, 0).
template <class S>
ACCRETE_INLINE Quat<S> retract(const Quat<S>& q, S roll, S b, S a) {
  return normalized(q * turn_of(half_turn(roll), b, a));
}

// The tangent after a tilt (b, a): along * t + across_b * b + across_a * a. The opposite tilt turns both signs.
template <class S>
struct TiltedTangent {
  S along, across_b, across_a;
};
template <class S>
ACCRETE_INLINE TiltedTangent<S> tilted_tangent(S b, S a) {
  const S angle2 = b * b + a * a;
  const HalfAngle<S> h = half_angle(angle2);
  const S sine2 = S(2) * h.sine_over_angle;
  const S k = sine2 * h.cosine;
  return {S(1) - sine2 * h.sine_over_angle * angle2, k * a, -k * b};
}

// angle / sin(angle) of an angle of 0 to 90 degrees, from its cosine: 1 + t A(t) with t = 1 - cosine. The nearest
// singularity is at 180 degrees, so a short polynomial is right to 6e-8 (tests/numeric/elementary_coefficients.py).
template <class S>
ACCRETE_INLINE S arc_over_sine(S cosine) {
  constexpr float kA[] = {0.333333364F,   0.133328436F,  0.0572714832F,  0.0241140989F, 0.0178409227F,
                          -0.0116120732F, 0.0282145883F, -0.0199459573F, 0.00825140588F};
  const S t = S(1) - cosine;
  S sum = S(kA[8]);
  ACCRETE_UNROLL
  for (int i = 7; i >= 0; --i) sum = sum * t + S(kA[i]);
  return sum * t + S(1);
}

// The same for 0 <= angle < pi, by its half h: 2 h / sin(2 h) = h / sin(h) / cos(h).
template <class S>
ACCRETE_INLINE S angle_over_sine(S cosine) {
  const S half = min_of(sqrt_of(max_of(S(0.5F) * (S(1) + cosine), S(1e-8F))), S(1));
  return arc_over_sine(half) / half;
}

// The tilt (b, a) that turns the tangent to the unit vector (x, y, z) of the own frame: the inverse of tilted_tangent.
template <class S>
struct Tilt {
  S b, a;
};
template <class S>
ACCRETE_INLINE Tilt<S> tilt_to(S x, S y, S z) {
  const S k = angle_over_sine(x);
  return {-z * k, y * k};
}

}  // namespace accrete::inline ACCRETE_ISA
