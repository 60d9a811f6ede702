#include "cli/evaluate/evaluation.h"

#include <numbers>

#include "cli/run/summary.h"
#include "cli/score/association.h"
#include "cli/write/edges_csv.h"
#include "cli/write/snapshot.h"

namespace accrete::cli {
namespace {

using nlohmann::ordered_json;

constexpr std::uint64_t kCurvePoints = 10;
// A box that is drawn tightly round a scan cuts off edges that stereo sees just outside it; what is farther out is
// wrong, or not of the object.
constexpr double kBoxMargin_m = 0.002;
constexpr std::uint64_t kCurveStepUnknown = 20;  // frames, where the length of the run is not known

ordered_json share(std::size_t part, std::size_t whole) {
  return whole > 0 ? ordered_json(static_cast<double>(part) / static_cast<double>(whole)) : ordered_json(nullptr);
}

}  // namespace

Evaluation::Evaluation(const Input& input, const RunOptions& options, Truth truth, HoldOutPlan plan,
                       ScoreSettings settings, std::uint64_t frames)
    : input_(input),
      truth_(std::move(truth)),
      plan_(std::move(plan)),
      settings_(settings),
      encoding_(encoding_of(options.params)),
      curve_step_(frames > 0 ? (frames + kCurvePoints - 1) / kCurvePoints : kCurveStepUnknown) {
  if (!plan_.held.empty()) extractor_ = make_engine(input.source->rig(), options.params, options.capacity);
}

LoopHooks Evaluation::hooks() {
  return {{},
          [this](std::uint64_t frame) { return plan_.keeps_aside(frame); },
          [this](const FrameContext& context) { keep_aside(context); },
          [this](const FrameContext& context) { accumulated(context); }};
}

void Evaluation::keep_aside(const FrameContext& context) {
  if (!plan_.held.contains(context.number)) return;
  if (extractor_->step(context.frame, context.motion).status != Status::kOk) return;
  held_.push_back(held_out_frame(context.number, context.frame, context.motion, extractor_->left_primitives()));
}

void Evaluation::accumulated(const FrameContext& context) {
  const auto used = static_cast<std::uint32_t>(context.run.used.size() - 1);
  births_.record(context.engine.model(), used);
  poses_.emplace(context.number, context.motion.T_l_m);
  if (!truth_.edges || (used + 1) % curve_step_ != 0) return;
  const ordered_json s = score_now(snapshot(context.engine.model(), context.run.used));
  ordered_json row{{"frames", used + 1},
                   {"confirmed", s["counts"]["confirmed_used"]},
                   {"median_mm", s["distance_mm"]["median"]},
                   {"p95_mm", s["distance_mm"]["p95"]},
                   {"tangent_deg", s["tangent_deg"]["median"]},
                   {"precision", s["precision"]},
                   {"completeness", s["completeness"]},
                   {"nees", nullptr},
                   {"phase_rad", nullptr},
                   {"colour", nullptr}};
  if (s.contains("nees") && s["nees"]["within_tol"].contains("mean")) row["nees"] = s["nees"]["within_tol"]["mean"];
  if (s.contains("phase") && s["phase"].contains("median_deviation_rad"))
    row["phase_rad"] = s["phase"]["median_deviation_rad"];
  if (s.contains("colour") && s["colour"].contains("rms_left_after_gain"))
    row["colour"] =
        (s["colour"]["rms_left_after_gain"].get<double>() + s["colour"]["rms_right_after_gain"].get<double>()) / 2;
  curve_.push_back(row);
}

// By way of the text of edges.csv: the figures are those of the file, to the last digit.
ordered_json Evaluation::score_now(std::span<const Primitive3d> primitives) const {
  std::vector<std::string> notes;
  const ScoredEdges edges = parse_edges(edges_csv(primitives, true, encoding_), "edges.csv", notes);
  return score(edges, truth_, settings_, notes);
}

// Background edges stand still, so what leaks into an object's model is scattered over the object's frame; where it was
// born it still lies on its edge.
ordered_json Evaluation::background_at_birth(std::span<const Primitive3d> primitives) const {
  std::size_t used = 0, leaked = 0;
  for (const Primitive3d& p : primitives) {
    const BirthLog::Birth* birth = births_.find(p.id);
    const auto pose = poses_.find(p.first_frame);
    if (birth == nullptr || pose == poses_.end()) continue;
    ++used;
    const auto& x = birth->position;
    const auto& t = birth->tangent;
    const EdgePoint in_camera{pose->second * Vec3{x[0], x[1], x[2]},
                              to_matrix(pose->second.rotation) * Vec3{t[0], t[1], t[2]}};
    const double angle = settings_.angle_deg * std::numbers::pi / 180;
    if (associate(in_camera, *truth_.background, angle, settings_.pitch_mm / 1e3).distance_m <=
        settings_.background_tolerance_mm / 1e3)
      ++leaked;
  }
  return {{"n", used}, {"background", leaked}, {"background_rate", share(leaked, used)}};
}

ordered_json Evaluation::result(const RunRecord& run, std::span<const Primitive3d> primitives) const {
  const std::vector<Primitive3d> used = accepted(primitives, static_cast<float>(settings_.min_existence));
  ordered_json out;
  out["recording"] = input_.name;
  out["kind"] = input_.kind;
  out["frames"] = {
      {"used", run.count(FrameFate::kUsed)}, {"lost", run.lost()}, {"held_out", run.count(FrameFate::kHeldOut)}};
  std::size_t confirmed = 0, preserved = 0;
  for (const Primitive3d& p : primitives) {
    confirmed += p.state == State::kConfirmed ? 1 : 0;
    preserved += p.state == State::kPreserved ? 1 : 0;
  }
  out["primitives"] = {
      {"all", primitives.size()}, {"confirmed", confirmed}, {"preserved", preserved}, {"used", used.size()}};
  if (truth_.edges) {
    out["score"] = score_now(primitives);
    out["birth"] = birth_against_end(primitives, births_, truth_, settings_);
    if (truth_.background && input_.mode == MotionMode::kObjectMoves)
      out["background_at_birth"] = background_at_birth(used);
    out["curve"] = curve_;
  } else if (truth_.bbox) {
    std::size_t outside = 0, well_outside = 0;
    for (const Primitive3d& p : used) {
      const Vec3 x{p.geometry.position[0], p.geometry.position[1], p.geometry.position[2]};
      outside += truth_.bbox->contains(x) ? 0 : 1;
      well_outside += truth_.bbox->contains(x, kBoxMargin_m) ? 0 : 1;
    }
    out["bounding_box"] = {{"n", used.size()},
                           {"outside", outside},
                           {"outside_rate", share(outside, used.size())},
                           {"margin_m", kBoxMargin_m},
                           {"outside_margin", well_outside},
                           {"outside_margin_rate", share(well_outside, used.size())}};
  }
  if (!plan_.held.empty()) {
    out["hold_out"] = {{"every", plan_.every}, {"shared", plan_.shared.size()}};
    out["hold_out"].update(score_hold_out(used, held_, input_.source->rig().left, truth_.bbox));
  }
  out["versions"] = versions();
  out["threads"] = run.threads;
  out["timing_ms"] = timing(run);
  return out;
}

}  // namespace accrete::cli
