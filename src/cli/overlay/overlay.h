// Pictures of one frame: what was extracted, what was matched, and the model laid over it.
#pragma once

#include <span>
#include <vector>

#include "accrete/camera.h"
#include "accrete/model.h"
#include "accrete/motion.h"
#include "accrete/stereo_frame.h"
#include "cli/overlay/canvas.h"

namespace accrete::cli {

// Everything that the pictures show; borrowed for the call.
struct OverlayScene {
  const StereoFrame& frame;
  const StereoRig& rig;
  const Motion& motion;
  std::span<const Primitive2d> left, right;
  std::span<const StereoMatch> matches;
  std::span<const Primitive3d> model;
};

// Left and right image with their 2D-primitives: a stroke along each, its hue telling the direction, and a dot in the
// colour of either side.
[[nodiscard]] Canvas draw_primitives(const OverlayScene& scene);
// Both images with the matched 2D-primitives, coloured by disparity from far (blue) to near (red); partners of some are
// joined by a line.
[[nodiscard]] Canvas draw_matches(const OverlayScene& scene);
// The model projected into both images: confirmed primitives coloured by their standard deviation across the edge, from
// precise (blue) to uncertain (red), preserved ones faint; those that show their back are left out.
[[nodiscard]] Canvas draw_model(const OverlayScene& scene);
// The left image twice, at half the size of the others: its 2D-primitives, and the model.
[[nodiscard]] Canvas draw_overview(const OverlayScene& scene);

}  // namespace accrete::cli
