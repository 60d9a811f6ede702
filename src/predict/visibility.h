// Is an edge expected to be seen now? (METHOD 7.3; docs/math/existence.md)
#pragma once

#include <array>
#include <cstdint>

#include "accrete/camera.h"
#include "accrete/primitive.h"

namespace accrete {

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
