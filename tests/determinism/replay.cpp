#include "determinism/replay.h"

#include "accumulator/pipeline.h"
#include "cli/text/hash.h"

namespace accrete::determinism {
namespace {

void add(Hash& hash, const Primitive2d& p) {
  for (const float v : {p.x_px, p.y_px, p.theta, p.appearance.phase, p.sigma_n_px}) hash(v);
  hash(p.appearance.left);
  hash(p.appearance.right);
}

void add(Hash& hash, const View& v) {
  for (const float x : {v.x_l, v.y_l, v.c_l, v.s_l, v.x_r, v.y_r, v.c_r, v.s_r}) hash(x);
}

static_assert(sizeof(Track) == 292, "Track has another member: add it to the hash below, then correct this size");
void add(Hash& hash, const Track& t) {
  hash(t.generation);
  hash(static_cast<std::uint8_t>(t.state));
  for (const float x : {t.log_odds, t.motion_log_odds, t.visible, t.misfit, t.pitch_m}) hash(x);
  for (const std::uint32_t x : {t.observations, t.novel_matches, t.misses_in_row, t.first_frame, t.last_frame}) hash(x);
  for (const View* v : {&t.birth, &t.counted, &t.used}) add(hash, *v);
  hash(t.viewer);
  hash(t.hidden.left);
  hash(t.hidden.right);
  hash(t.reliability.excess);
  hash(t.seen.hits);
  hash(t.seen.visits);
}

void add(Hash& hash, const ExtractCounts& c) {
  hash(c.primitives);
  hash(c.refused_distortion);
}

void add(Hash& hash, const StepReport& r) {
  hash(r.frame);
  add(hash, r.left);
  add(hash, r.right);
  for (const std::uint32_t x : {r.stereo_matches,
                                r.stereo_ambiguous,
                                r.stereo_refused_epipolar,
                                r.stereo_refused_capacity,
                                r.predicted_visible,
                                r.predicted_behind,
                                r.matched_stereo,
                                r.matched_mono,
                                r.missed,
                                r.ambiguous,
                                r.starved,
                                r.updated,
                                r.not_novel,
                                r.not_positive_definite,
                                r.born,
                                r.birth_refused_degenerate,
                                r.birth_refused_excluded,
                                r.birth_refused_capacity,
                                r.newly_confirmed,
                                r.deleted_existence,
                                r.deleted_undecided,
                                r.deleted_background,
                                r.merged,
                                r.evicted,
                                r.tentative,
                                r.confirmed,
                                r.preserved})
    hash(x);
}

// Everything that the next step depends on, free slots included: they hold what release() leaves.
void add(Hash& hash, Workspace& w, const ModelView& model) {
  for (const GeometryBlock& b : w.geometry)
    for (const auto& row : b.row)
      for (const float x : row) hash(x);
  for (const AppearanceBlock& b : w.appearance)
    for (const auto& row : b.row)
      for (const float x : row) hash(x);
  for (const Track& t : w.tracks) add(hash, t);
  // And as users see it: identity, probability, covariance with the bias.
  for (std::size_t i = 0; i < model.slots(); ++i) {
    if (model.state(i) == State::kFree) continue;
    const Primitive3d p = model.at(i);
    hash(p.id.index1);
    hash(p.id.generation);
    hash(p.existence);
    hash(p.misfit);
    hash(p.tangent);
    hash(p.geometry.covariance);
  }
}

void add(Totals& t, const StepReport& r) {
  t.observed += r.left.primitives + r.right.primitives;
  t.born += r.born;
  t.updated += r.updated;
  t.stereo += r.matched_stereo;
  t.mono += r.matched_mono;
  t.missed += r.missed;
  t.ambiguous += r.ambiguous;
  t.starved += r.starved;
  t.confirmed += r.newly_confirmed;
  t.preserved += r.preserved;
  t.deleted_existence += r.deleted_existence;
  t.deleted_undecided += r.deleted_undecided;
  t.deleted_background += r.deleted_background;
  t.merged += r.merged;
  t.evicted += r.evicted;
}

}  // namespace

Outcome run(Pipeline& pipeline, const Replay& replay) {
  Outcome out;
  Hash measurements, state;
  if (configure(pipeline, rig(), {}) != Status::kOk) return out;
  World world(replay.edges);
  for (int step = 0; step < replay.steps; ++step) {
    const ObservedFrame frame = world.observe(step, replay.left, replay.right);
    if (replay.disturb != nullptr) {
      replay.disturb(step, replay.left.first(frame.left.size()));
      replay.disturb(step, replay.right.first(frame.right.size()));
    }
    for (const auto& eye : {frame.left, frame.right})
      for (const Primitive2d& p : eye) add(measurements, p);
    const StepReport report = accrete::step(pipeline, frame, world.motion());
    if (report.status != Status::kOk) return {};
    add(state, report);
    add(out.totals, report);
    out.primitives = report.tentative + report.confirmed + report.preserved;
    if (step % 10 == 9 || step == replay.steps - 1) {
      add(state, pipeline.workspace(), model(pipeline));
      if (replay.progress != nullptr) replay.progress(step, state.value());
    }
  }
  out.measurements = measurements.value();
  out.state = state.value();
  return out;
}

}  // namespace accrete::determinism
