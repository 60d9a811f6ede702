// Duplicates: how far two primitives are from being the same edge, and how they become one (docs/math/fusion.md).
#pragma once

#include "accrete/primitive.h"

namespace accrete {

// Do the tangents point in opposite directions? Then one of the two has to be reversed() before they are compared.
[[nodiscard]] bool opposite(const Geometry& a, const Geometry& b);

// Squared Mahalanobis distance of the two lines, 4 degrees of freedom: offset normal to the tangent and direction, at
// the point half-way between them. Slides along the lines do not enter. Invariant to reversing either. bias_variance
// (m^2) is added to the offsets: what filtering does not shrink (METHOD 1.4). Infinity when a covariance is not
// positive definite or the lines are more than 60 degrees apart.
[[nodiscard]] float merge_distance2(const Geometry& a, const Geometry& b, float bias_variance = 0);

// The same for appearance, 7 degrees of freedom; is_opposite = opposite(geometry of a, geometry of b).
[[nodiscard]] float appearance_distance2(const AppearanceState& a, const AppearanceState& b, bool is_opposite);

// Fuses `other` into `into` by covariance intersection (METHOD 6.6), consistent whatever the correlation of the two.
// `into` keeps its sense and its slide. false, and nothing changed: not positive definite or more than 60 degrees
// apart.
[[nodiscard]] bool fuse_by_covariance_intersection(Geometry& into, AppearanceState& into_appearance,
                                                   const Geometry& other, const AppearanceState& other_appearance);

}  // namespace accrete
