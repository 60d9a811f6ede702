// What a change of the view does to the appearance: the light changes, and faces turn away.
#pragma once

#include "accrete/primitive.h"
#include "base/direction.h"

namespace accrete {

// Angle about the tangent from the mean viewing direction (local -z) to `toward_viewer` (unit, map frame), positive
// towards the right side.
[[nodiscard]] float turned_about_tangent(const Geometry& geometry, const Vec3f& toward_viewer);

// Variances by which phase (rad^2) and colours (0..1, squared) differ after a turn of `turned` rad (METHOD 4.2).
[[nodiscard]] inline float phase_change2(float turned) {
  const float sigma = 0.02F + 0.5F * turned;
  return sigma * sigma;
}
[[nodiscard]] inline float colour_change2(float turned) {
  const float sigma = 0.005F + 0.1F * turned;
  return sigma * sigma;
}

// Where the viewer stood when the face on that side had turned away; zero: never seen to.
struct HiddenSides {
  Vec3f left{}, right{};
};

// Sides that show background.
struct Background {
  bool left = false, right = false;
};

// A crease of a solid shows the background on one side while the face there is turned away. When a viewer has gone to
// the right of the mean viewing direction and the colour on the left differs by more than the gate of 9 (METHOD 5.3)
// from what was learnt, the face on the left has turned away: the left is background here and in every view beyond,
// whatever its colour, until the viewer comes back. And the other way round. A change that both sides share is the
// light's. `seen` is in the state's sense. `independent_channels`: 1 for grey images .. 3 (associate/clutter.h).
//
// Rejected: to relearn a side that surprises while the viewer has come nearer to it (bars that are narrower than the
// filter show a neighbour's colour now and then, and lost their own), and to trust a side less the farther the viewer
// has gone from it (the two sides were then known in different lights, and which is the brighter one was lost).
[[nodiscard]] Background background_sides(const Geometry& geometry, const Vec3f& toward_viewer,
                                          const AppearanceState& state, const Appearance& seen,
                                          float independent_channels, HiddenSides& hidden);

}  // namespace accrete
