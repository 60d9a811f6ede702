// Directions in single precision, as the stages exchange them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "base/elementary.h"

namespace accrete {

using Vec3f = std::array<float, 3>;

inline float dot3(const Vec3f& a, const Vec3f& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

inline Vec3f unit_to(const Vec3f& from, const Vec3f& to) {
  Vec3f v{to[0] - from[0], to[1] - from[1], to[2] - from[2]};
  const float n = std::sqrt(std::max(dot3(v, v), 1e-12F));
  return {v[0] / n, v[1] / n, v[2] / n};
}

// Between unit vectors, rad.
inline float angle_between(const Vec3f& a, const Vec3f& b) { return acos_of(std::clamp(dot3(a, b), -1.0F, 1.0F)); }

}  // namespace accrete
