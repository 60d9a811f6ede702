// An eye that stands where the other one stood a frame ago sees what that one saw, of a wrong stereo pair as of a right
// one.
#pragma once

#include "associate/associate.h"
#include "base/direction.h"

namespace accrete::existence {

// Left and right camera in the map, m.
using EyeCentres = std::array<Vec3f, 2>;

// Was the point found by one eye alone, and that on the ray on which the other one had it a frame before? The rays are
// the same within a tenth of the angle between both eyes' rays.
[[nodiscard]] bool found_by_repetition(const associate::Association& association, const Vec3f& point,
                                       const EyeCentres& before, const EyeCentres& now);

}  // namespace accrete::existence
