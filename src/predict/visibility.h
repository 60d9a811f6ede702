// Is an edge expected to be seen now? (METHOD 7.3; docs/math/existence.md)
#pragma once

#include <array>
#include <cstdint>

#include "accrete/camera.h"

namespace accrete {

// From which directions an edge has been seen, and looked for, in the map frame: 42 directions, the vertices of an
// icosahedron and the middles of its edges, about 30 degrees apart. Directions of the map, because the primitive's own
// frame turns about the tangent while it is learnt.
struct SeenDirections {
  static constexpr std::size_t kBins = 42;
  std::array<std::uint8_t, kBins> hits{};
  std::array<std::uint8_t, kBins> visits{};

  // `toward_viewer`: unit vector from the edge to the camera, map frame. Counts are halved when they overflow, so that
  // recent views weigh more.
  void count(const std::array<float, 3>& toward_viewer, bool hit);
};

// Probability that the surface at the edge faces the viewer: what was seen from about this direction, and where nothing
// was, a logistic of the angle between the viewing direction and the mean one (local -z), marginalised over the
// roll's deviation (METHOD 7.3). cos_psi = dot(local -z, toward_viewer), both normal to the tangent.
[[nodiscard]] float face_probability(const SeenDirections& seen, const std::array<float, 3>& toward_viewer,
                                     float cos_psi, float sigma_roll);

// Probability that the aligned image point lies inside the raw image, less a margin. 0 outside the camera model's
// domain.
[[nodiscard]] float inside_probability(const Camera& camera, const Mat3& R_a_c, double focal_px, float x_px, float y_px,
                                       float sigma_px, float margin_px);

}  // namespace accrete
