// Everything that is measured about one run, as one JSON object, and as tables for people.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "cli/evaluate/births.h"
#include "cli/evaluate/holdout.h"
#include "cli/evaluate/holdout_plan.h"
#include "cli/evaluate/tables.h"
#include "cli/run/accumulate.h"
#include "cli/score/score.h"
#include "cli/write/linear_light.h"

namespace accrete::cli {

// Watches a run and scores it: during the run through the hooks, at the end through result().
class Evaluation {
 public:
  // `plan`: frames that are kept aside; `frames`: how many the run will have, for the steps of the curve (0: unknown).
  Evaluation(const Input& input, const RunOptions& options, Truth truth, HoldOutPlan plan, ScoreSettings settings,
             std::uint64_t frames);

  [[nodiscard]] LoopHooks hooks();
  // `primitives`: the snapshot at the end. Keys: score, birth, background_at_birth, curve, bounding_box, hold_out,
  // versions, timing_ms, frames, primitives; those that do not apply are absent.
  [[nodiscard]] nlohmann::ordered_json result(const RunRecord& run, std::span<const Primitive3d> primitives) const;

 private:
  void accumulated(const FrameContext& context);
  void keep_aside(const FrameContext& context);
  [[nodiscard]] nlohmann::ordered_json score_now(std::span<const Primitive3d> primitives) const;
  [[nodiscard]] nlohmann::ordered_json background_at_birth(std::span<const Primitive3d> primitives) const;

  const Input& input_;
  Truth truth_;
  HoldOutPlan plan_;
  ScoreSettings settings_;
  Encoding encoding_;
  std::uint64_t curve_step_;
  std::unique_ptr<Engine> extractor_;  // sees only what is kept aside
  std::vector<HeldOutFrame> held_;
  BirthLog births_;
  std::map<std::uint64_t, Transform<Left, Map>> poses_;  // by the frame's number in the recording
  nlohmann::ordered_json curve_ = nlohmann::ordered_json::array();
};

// The result for people; score-only results (a file that was scored without a run) as well.
[[nodiscard]] std::vector<Table> evaluation_tables(const nlohmann::ordered_json& result);

}  // namespace accrete::cli
