// The polynomials of the camera models, in the image plane at z = 1 (docs/math/cameras.md derives them).
#pragma once

#include <array>

#include "accrete/camera.h"

namespace accrete::distortion {

// Where a point goes, and the Jacobian of that map, row-major 2 x 2.
struct Mapped {
  Normalized point;
  std::array<double, 4> jacobian{};
};

// No check of the domain: finite input may give anything beyond the fold.
[[nodiscard]] Mapped distort(const Camera& camera, Normalized p);

// True when the radial part is strictly increasing from the axis to the radius of `p`: the point lies before the fold.
[[nodiscard]] bool before_fold(const Camera& camera, Normalized p);

// The point before the fold whose radial part alone has the length of `d`; the fold itself when there is none.
// For Kannala-Brandt that is the inverse, for Brown-Conrady the place to start from.
[[nodiscard]] Normalized invert_radial(const Camera& camera, Normalized d);

}  // namespace accrete::distortion
