// A 3D-primitive seen by one camera: where it lies in the raw image, and from which side it is seen.
#pragma once

#include <optional>

#include "accrete/camera.h"
#include "accrete/geometry.h"
#include "accrete/model.h"

namespace accrete::cli {

// The map frame in a camera's frame: rotation and translation.
struct Viewpoint {
  Mat3 rotation{};
  Vec3 translation{};

  template <class Eye>
  [[nodiscard]] static Viewpoint of(const Transform<Eye, Map>& t) {
    return {to_matrix(t.rotation), t.translation};
  }
};

struct Projection {
  double x_px = 0, y_px = 0;
  double direction = 0;  // rad, of the tangent's image, from +x towards +y
  double depth_m = 0;
  double pixels_per_metre = 0;  // along the tangent
  double facing = 0;            // rad, 0..pi: line of sight against the mean direction from which the edge was seen,
                                // both across the tangent; beyond 90 degrees it shows its back
};

// Empty: behind the camera, outside the domain of its model, or seen along the tangent.
[[nodiscard]] std::optional<Projection> project(const Primitive3d& primitive, const Viewpoint& view,
                                                const Camera& camera);

// Pixel lies in the image and at least `margin_px` from its border.
[[nodiscard]] inline bool inside(const Camera& camera, double x_px, double y_px, double margin_px) {
  return x_px >= margin_px && y_px >= margin_px && x_px <= camera.width_px - 1 - margin_px &&
         y_px <= camera.height_px - 1 - margin_px;
}

}  // namespace accrete::cli
