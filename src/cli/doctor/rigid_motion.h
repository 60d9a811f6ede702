// The motion of rigid points between two frames, from images alone: what given poses are compared with.
#pragma once

#include <vector>

#include "accrete/camera.h"
#include "accrete/geometry.h"

namespace accrete::cli {

// A point in a camera's frame before the motion, and where the same camera sees it afterwards.
struct TrackedPoint {
  Vec3 before{};
  Normalized after;
};

// Distance in units of the normalised plane, a large number for what comes to lie behind the camera.
[[nodiscard]] double reprojection_error(const Transform<Left, Left>& motion, const TrackedPoint& point);

// Least squares of these with a Geman-McClure weight whose scale shrinks from `coarse` to `fine` (units of the
// normalised plane): what most points agree on, from no motion as the first guess. The identity for fewer than 6.
[[nodiscard]] Transform<Left, Left> estimate_motion(const std::vector<TrackedPoint>& points, double coarse,
                                                    double fine);

}  // namespace accrete::cli
