// How alike two 2D-primitives of one stereo pair are: orientation, phase, colours, flow (METHOD 2.2).
#pragma once

#include "accrete/primitive.h"

namespace accrete::stereo {

// 1 for identical, 0 for opposite in everything. Invariant to reversing either primitive: `same_sense` says that the
// directions agree within 90 degrees. Flow counts where both have one.
[[nodiscard]] float similarity(const Primitive2d& left, const Primitive2d& right, bool same_sense);

// Squared differences in units of what perspective and photometry do between two views (METHOD 2.2: 15 degrees, 0.5
// rad, 0.08), summed: -2 log likelihood up to a constant. The same invariance.
[[nodiscard]] float mismatch(const Primitive2d& left, const Primitive2d& right, bool same_sense);

}  // namespace accrete::stereo
