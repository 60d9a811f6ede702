// Does the model explain images that it has never seen? It is projected into the left images of the frames that were
// kept aside and compared with the 2D-primitives found there. docs/reference/program.md states the rules.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <vector>

#include "cli/project.h"
#include "cli/run/accumulate.h"
#include "cli/score/truth.h"

namespace accrete::cli {

// When a projected primitive and a 2D-primitive are the same edge.
struct HoldOutTolerance {
  double across_px = 1.5;
  double along_px = 6;  // one sampling pitch
  double angle_deg = 20;
};

// What is kept of one frame: its left 2D-primitives and where nothing can be found.
struct HeldOutFrame {
  static constexpr int kCellPx = 8;

  std::uint64_t number = 0;
  Viewpoint view;
  std::vector<Primitive2d> primitives;
  int columns = 0, rows = 0;  // of cells
  std::vector<bool> fill;     // cells that hold exact zeros all over (border of a warped image)

  [[nodiscard]] bool is_fill(double x_px, double y_px) const;
};
[[nodiscard]] HeldOutFrame held_out_frame(std::uint64_t number, const StereoFrame& frame, const Motion& motion,
                                          std::span<const Primitive2d> left);

// The primitives of `model` that are predicted visible in the frame.
[[nodiscard]] std::vector<Projection> predict_visible(std::span<const Primitive3d> model, const HeldOutFrame& frame,
                                                      const Camera& camera);

// Figures over all frames: primitives predicted visible and found; 2D-primitives on the object and explained. `bbox`:
// where the object lies, in the map frame; without it nothing is said about the second share.
[[nodiscard]] nlohmann::ordered_json score_hold_out(std::span<const Primitive3d> model,
                                                    std::span<const HeldOutFrame> frames, const Camera& camera,
                                                    const std::optional<Box>& bbox,
                                                    const HoldOutTolerance& tolerance = {});

}  // namespace accrete::cli
