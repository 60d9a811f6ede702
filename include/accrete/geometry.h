// Rigid transforms whose frames are part of the type: p_a = T_a_b * p_b, and composing non-adjacent frames does not
// compile. Boundary types in double; the filter converts to float once per frame.
#pragma once

#include <array>
#include <cmath>

#include "accrete/status.h"

namespace accrete {

// Frames. Map is the frame in which the edges stand still and in which the state lives: the object's when the object
// moves, the world's when the cameras move.
struct World;
struct Object;  // NOLINT(bugprone-forward-declaration-namespace): a tag, complete nowhere
struct Body;
struct Left;
struct Right;
struct Map;

using Vec3 = std::array<double, 3>;

[[nodiscard]] constexpr Vec3 operator+(const Vec3& a, const Vec3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
[[nodiscard]] constexpr Vec3 operator-(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
[[nodiscard]] constexpr Vec3 operator*(double s, const Vec3& a) { return {s * a[0], s * a[1], s * a[2]}; }
[[nodiscard]] constexpr double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
[[nodiscard]] constexpr Vec3 cross(const Vec3& a, const Vec3& b) {  // a x b
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
[[nodiscard]] inline double norm(const Vec3& a) { return std::sqrt(dot(a, a)); }

// Row-major 3 x 3.
using Mat3 = std::array<double, 9>;

[[nodiscard]] constexpr Vec3 operator*(const Mat3& m, const Vec3& v) {
  return {m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
          m[6] * v[0] + m[7] * v[1] + m[8] * v[2]};
}
[[nodiscard]] constexpr Mat3 transposed(const Mat3& m) {  // of a rotation: its inverse
  return {m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]};
}
[[nodiscard]] constexpr Mat3 operator*(const Mat3& a, const Mat3& b) {
  Mat3 c{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) c[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
  return c;
}

// Unit quaternion, Hamilton convention, w last as in TUM files.
struct Quaternion {
  double x = 0, y = 0, z = 0, w = 1;

  friend constexpr bool operator==(const Quaternion&, const Quaternion&) = default;
};

[[nodiscard]] constexpr Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}
[[nodiscard]] constexpr Quaternion conjugate(const Quaternion& q) { return {-q.x, -q.y, -q.z, q.w}; }
[[nodiscard]] constexpr Mat3 to_matrix(const Quaternion& q) {
  const double xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z, xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z,
               wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
  return {1 - 2 * (yy + zz), 2 * (xy - wz), 2 * (xz + wy), 2 * (xy + wz),    1 - 2 * (xx + zz),
          2 * (yz - wx),     2 * (xz - wy), 2 * (yz + wx), 1 - 2 * (xx + yy)};
}
// Normalises; kInvalidArgument when not finite or shorter than 0.5 or longer than 2 (that is no rotation).
[[nodiscard]] Result<Quaternion> normalized(const Quaternion& q);
// kInvalidArgument when `m` differs from a rotation (M Mt = I, det +1) by more than `tolerance` in any entry;
// otherwise the nearest unit quaternion.
[[nodiscard]] Result<Quaternion> to_quaternion(const Mat3& m, double tolerance = 1e-3);
// Interpolation at constant angular velocity along the shorter arc; s = 0 gives a, s = 1 gives b.
[[nodiscard]] Quaternion slerp(const Quaternion& a, const Quaternion& b, double s);
// Angle of the rotation in radians, 0 .. pi.
[[nodiscard]] double rotation_angle(const Quaternion& q);

// Maps coordinates in From to coordinates in To.
template <class To, class From>
struct Transform {
  Quaternion rotation;
  Vec3 translation{};

  [[nodiscard]] constexpr Vec3 operator*(const Vec3& p) const { return to_matrix(rotation) * p + translation; }
  [[nodiscard]] constexpr Transform<From, To> inverse() const {  // (R^T, -R^T t)
    const Quaternion r = conjugate(rotation);
    return {r, -1.0 * (to_matrix(r) * translation)};
  }
  template <class From2>
  [[nodiscard]] constexpr Transform<To, From2> operator*(const Transform<From, From2>& other) const {
    return {rotation * other.rotation, to_matrix(rotation) * other.translation + translation};
  }
};

// Says that two frames coincide, where a type alone cannot know it (Object is Map in one mode of motion).
template <class To, class From, class A, class B>
[[nodiscard]] constexpr Transform<To, From> retag(const Transform<A, B>& t) {
  return {t.rotation, t.translation};
}

}  // namespace accrete
