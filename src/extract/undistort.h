// From raw pixels to the aligned image: a few thousand line elements instead of 300,000 pixels.
#pragma once

#include "accrete/camera.h"
#include "accrete/primitive.h"

namespace accrete::extract {

// Fills primitive.aligned from the raw position, orientation and their deviations. False outside the domain of the
// camera model, or more than 80 degrees off the aligned axis.
[[nodiscard]] bool undistort(const Camera& camera, const Mat3& R_a_c, double focal_px, Primitive2d& primitive);

}  // namespace accrete::extract
