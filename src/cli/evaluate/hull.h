// The convex outline of a few points in the image.
#pragma once

#include <vector>

#include "accrete/camera.h"

namespace accrete::cli {

// Corners of the convex hull in order; fewer than three points give nothing.
[[nodiscard]] std::vector<Pixel> convex_hull(std::vector<Pixel> points);
// Inside or on the border of a hull from convex_hull; nothing lies in an empty one.
[[nodiscard]] bool in_hull(const std::vector<Pixel>& hull, Pixel p);

}  // namespace accrete::cli
