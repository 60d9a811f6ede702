// Angles wrapped to their principal interval.
#pragma once

#include <cmath>

namespace accrete {

inline constexpr float kPi = 3.14159265358979F;

// To [-pi, pi].
[[nodiscard]] inline float wrap_two_pi(float a) { return a - 2 * kPi * std::round(a / (2 * kPi)); }

// To [-pi/2, pi/2]: the difference of two undirected orientations.
[[nodiscard]] inline float wrap_pi(float a) { return a - kPi * std::round(a / kPi); }

}  // namespace accrete
