#include "filter/reliability.h"

#include <algorithm>

#include "base/angles.h"

namespace accrete {

void learn(const AppearanceState& state, const Appearance& seen, const AppearanceNoise& noise, std::uint32_t looks,
           Reliability& reliability) {
  constexpr float kForget = 0.05F;
  const float gain = std::max(kForget, 1 / static_cast<float>(std::max<std::uint32_t>(looks, 1)));
  const auto component = [&](std::size_t i, float innovation, float sigma, float q) {
    const float explained = state.covariance[packed_index(7, i, i)] + q + sigma * sigma;
    reliability.excess[i] += gain * (innovation * innovation - explained - reliability.excess[i]);
  };
  const Appearance& was = state.mean;
  if (!noise.ignore_left && !noise.ignore_right)
    component(0, wrap_two_pi(seen.phase - was.phase), noise.sigma_phase, noise.q_phase);
  for (std::size_t c = 0; c < 3; ++c) {
    if (!noise.ignore_left) component(1 + c, seen.left[c] - was.left[c], noise.sigma_left, noise.q_colour);
    if (!noise.ignore_right) component(4 + c, seen.right[c] - was.right[c], noise.sigma_right, noise.q_colour);
  }
}

}  // namespace accrete
