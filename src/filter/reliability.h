// How invariant each component of an appearance is: learned from its innovations (METHOD 4.2; docs/math/filter.md).
#pragma once

#include <array>

#include "accrete/primitive.h"

namespace accrete {

// Running mean, per component (phase, left RGB, right RGB), of the squared innovation minus the variance that state and
// noise explain. About zero for what is constant; the variance of the component over the views for what is not. A
// Kalman filter with given noise cannot know this: its covariance does not depend on the data.
struct Reliability {
  std::array<float, 7> excess{};

  // What is to be added to the filtered variance of a component.
  [[nodiscard]] float scatter(std::size_t component) const { return excess[component] > 0 ? excess[component] : 0.0F; }
};

// Of the same edge described in the opposite direction.
[[nodiscard]] constexpr Reliability reversed(const Reliability& r) {
  const auto& e = r.excess;
  return {{e[0], e[4], e[5], e[6], e[1], e[2], e[3]}};
}

// Noise of what is seen and of the change since the last look. A side that shows background is not looked at.
struct AppearanceNoise {
  float sigma_phase, sigma_left, sigma_right;
  float q_phase, q_colour;  // variances
  bool ignore_left, ignore_right;
};

// Before the update: `state` is what was known. Weight of a new innovation: 0.05, a memory of twenty looks
// (METHOD 4.2); the first `looks` of them count equally, so that a short track is not judged by its first look alone.
void learn(const AppearanceState& state, const Appearance& seen, const AppearanceNoise& noise, std::uint32_t looks,
           Reliability& reliability);

}  // namespace accrete
