// Convex polygons in the image plane: what hides what is settled exactly here, before a pixel is touched.
#pragma once

#include <vector>

#include "accrete/camera.h"

namespace accrete::hal::synthetic {

// Corners in order, the interior where cross(next - corner, point - corner) > 0 (clockwise on a screen with y down).
using Convex = std::vector<Pixel>;

[[nodiscard]] double area(const Convex& polygon);

// The part where a x + b y + c >= 0.
[[nodiscard]] Convex clip(const Convex& polygon, double a, double b, double c);

// The part inside the rectangle.
[[nodiscard]] Convex clip_to_rectangle(const Convex& polygon, double x0, double y0, double x1, double y1);

// Appends the part of `polygon` outside `hole`, as convex pieces that do not overlap.
void subtract(const Convex& polygon, const Convex& hole, std::vector<Convex>& pieces);

[[nodiscard]] Convex convex_hull(std::vector<Pixel> points);

[[nodiscard]] bool contains(const Convex& polygon, Pixel p);

}  // namespace accrete::hal::synthetic
