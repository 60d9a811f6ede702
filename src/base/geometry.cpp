#include "accrete/geometry.h"

#include "base/elementary.h"

namespace accrete {
namespace {

double determinant(const Mat3& m) { return dot({m[0], m[1], m[2]}, cross({m[3], m[4], m[5]}, {m[6], m[7], m[8]})); }

// The inverse transposed: the cofactors over the determinant.
Mat3 inverse_transposed(const Mat3& m) {
  const Vec3 a{m[0], m[1], m[2]}, b{m[3], m[4], m[5]}, c{m[6], m[7], m[8]};
  const Vec3 bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  const double s = 1.0 / dot(a, bc);
  return {s * bc[0], s * bc[1], s * bc[2], s * ca[0], s * ca[1], s * ca[2], s * ab[0], s * ab[1], s * ab[2]};
}

// False for NaN as well: every comparison is written so that it fails there.
bool is_rotation(const Mat3& m, double tolerance) {
  const Mat3 g = m * transposed(m);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (!(std::abs(g[3 * i + j] - (i == j ? 1.0 : 0.0)) <= tolerance)) return false;
  return determinant(m) > 0;
}

// Shepperd's method: the largest of the four squares is the divisor. Precondition: `m` is a rotation.
Quaternion shepperd(const Mat3& m) {
  const double trace = m[0] + m[4] + m[8];
  if (trace >= m[0] && trace >= m[4] && trace >= m[8]) {
    const double w = 0.5 * std::sqrt(1 + trace), s = 0.25 / w;
    return {s * (m[7] - m[5]), s * (m[2] - m[6]), s * (m[3] - m[1]), w};
  }
  if (m[0] >= m[4] && m[0] >= m[8]) {
    const double x = 0.5 * std::sqrt(1 + m[0] - m[4] - m[8]), s = 0.25 / x;
    return {x, s * (m[1] + m[3]), s * (m[2] + m[6]), s * (m[7] - m[5])};
  }
  if (m[4] >= m[8]) {
    const double y = 0.5 * std::sqrt(1 - m[0] + m[4] - m[8]), s = 0.25 / y;
    return {s * (m[1] + m[3]), y, s * (m[5] + m[7]), s * (m[2] - m[6])};
  }
  const double z = 0.5 * std::sqrt(1 - m[0] - m[4] + m[8]), s = 0.25 / z;
  return {s * (m[2] + m[6]), s * (m[5] + m[7]), z, s * (m[3] - m[1])};
}

double length(const Quaternion& q) { return std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w); }

Quaternion scaled(const Quaternion& q, double s) { return {s * q.x, s * q.y, s * q.z, s * q.w}; }

}  // namespace

Result<Quaternion> normalized(const Quaternion& q) {
  const double n = length(q);
  if (!(n >= 0.5 && n <= 2.0)) return Status::kInvalidArgument;
  return scaled(q, 1.0 / n);
}

Result<Quaternion> to_quaternion(const Mat3& m, double tolerance) {
  if (!is_rotation(m, tolerance)) return Status::kInvalidArgument;
  // The orthogonal polar factor, which is the nearest rotation, by Newton's iteration (Higham 1986). It converges
  // quadratically: from 1e-1 to below 1e-15 in five steps.
  Mat3 r = m;
  for (int step = 0; step < 5; ++step) {
    const Mat3 t = inverse_transposed(r);
    for (std::size_t i = 0; i < 9; ++i) r[i] = 0.5 * (r[i] + t[i]);
  }
  return normalized(shepperd(r));
}

Quaternion slerp(const Quaternion& a, const Quaternion& b, double s) {
  const double inner = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
  const double sign = inner < 0 ? -1.0 : 1.0;  // b and -b are one rotation: take the shorter way
  // The angle from the chord, not from the cosine, which loses half of the digits near one.
  const Quaternion difference{sign * b.x - a.x, sign * b.y - a.y, sign * b.z - a.z, sign * b.w - a.w};
  const double angle = 2 * asin_of(std::fmin(1.0, 0.5 * length(difference)));
  double wa = 1 - s, wb = s;
  if (angle > 1e-8) {  // below that, sin(x) = x in double and the straight line is the arc
    wa = sin_of((1 - s) * angle) / sin_of(angle);
    wb = sin_of(s * angle) / sin_of(angle);
  }
  wb *= sign;
  const Quaternion q{wa * a.x + wb * b.x, wa * a.y + wb * b.y, wa * a.z + wb * b.z, wa * a.w + wb * b.w};
  return scaled(q, 1.0 / length(q));
}

double rotation_angle(const Quaternion& q) { return 2 * atan2_of(norm({q.x, q.y, q.z}), std::abs(q.w)); }

}  // namespace accrete
