// Does the model explain images that it has never seen? Some frames are kept aside; at the end the model is projected
// into their left images and compared with the 2D-primitives found there. docs/reference/program.md has the rules.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "cli/project.h"
#include "cli/run/accumulate.h"
#include "cli/score/truth.h"

namespace accrete::cli {

// Which frames are kept aside.
struct HoldOutPlan {
  int every = 0;
  std::set<std::uint64_t> held;    // scored: every N-th frame, beginning with number N - 1
  std::set<std::uint64_t> shared;  // not accumulated either: they show the left source photograph of a held-out frame

  [[nodiscard]] bool keeps_aside(std::uint64_t frame) const { return held.contains(frame) || shared.contains(frame); }
};

// `sources`: the text of rig.txt, lines "frame left_source right_source ...", or empty. Throws Failure(kInput) when it
// is garbled.
[[nodiscard]] HoldOutPlan plan_hold_out(int every, std::uint64_t frames, const std::string& sources,
                                        const std::string& name);

// Tolerances of a match between a projected primitive and a 2D-primitive.
struct HoldOutTolerance {
  double across_px = 1.5;
  double along_px = 6;  // one sampling pitch
  double angle_deg = 20;
};

// The left 2D-primitives of one frame that was kept aside.
struct HeldOutFrame {
  std::uint64_t number = 0;
  Viewpoint view;
  std::vector<Primitive2d> primitives;
  std::vector<bool> fill;  // cells of kFillCellPx that are fill (exact zeros): nothing can be found there
  int fill_columns = 0;
};
inline constexpr int kFillCellPx = 8;

class HoldOut {
 public:
  HoldOut(const StereoRig& rig, const Params& params, Capacity capacity);

  // Extracts the 2D-primitives of the frame with an accumulator of its own.
  void add(const FrameContext& context);

  // Figures over all frames: primitives predicted visible, found, 2D-primitives on the object, explained. `bbox`: where
  // the object lies, in the map frame; without it every 2D-primitive counts as the object's.
  [[nodiscard]] nlohmann::ordered_json score(std::span<const Primitive3d> model, const std::optional<Box>& bbox,
                                             const HoldOutTolerance& tolerance = {}) const;

 private:
  Camera camera_;
  std::unique_ptr<Engine> engine_;
  std::vector<HeldOutFrame> frames_;
};

// The primitives of `model` that are predicted visible in the frame: the projection lies 12 px inside the image and not
// in fill, the edge shows the side from which it was seen (facing below 80 degrees), and it is not hidden.
[[nodiscard]] std::vector<Projection> predict_visible(std::span<const Primitive3d> model, const HeldOutFrame& frame,
                                                      const Camera& camera);

}  // namespace accrete::cli
