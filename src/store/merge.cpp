#include "store/merge.h"

#include <algorithm>
#include <cmath>

#include "store/fuse.h"

namespace accrete {
namespace {

constexpr int kSide = 128;
constexpr float kCell = 16.0F;  // px: larger than the reach of a comparison, so that 3 x 3 cells suffice

int cell(float v) {
  return static_cast<int>(std::clamp(std::floor(v / kCell) + kSide / 2, 0.0F, static_cast<float>(kSide - 1)));
}

}  // namespace

void merge_duplicates(std::span<const std::uint32_t> slots, std::span<const associate::Expected> expected,
                      std::span<std::uint32_t> cell_begin, std::span<std::uint32_t> cell_order, float bias_px,
                      float focal_px, Store& store, StepReport& report) {
  const auto cell_of = [&](std::size_t i) {
    const PredictedObservation& p = expected[i].predicted;
    return static_cast<std::size_t>(cell(p.y_l)) * kSide + static_cast<std::size_t>(cell(p.x_l));
  };
  std::fill(cell_begin.begin(), cell_begin.end(), 0U);
  for (std::size_t i = 0; i < slots.size(); ++i) ++cell_begin[cell_of(i) + 1];
  for (std::size_t c = 0; c < kMergeCells; ++c) cell_begin[c + 1] += cell_begin[c];
  for (std::size_t i = 0; i < slots.size(); ++i) cell_order[cell_begin[cell_of(i)]++] = static_cast<std::uint32_t>(i);
  for (std::size_t c = kMergeCells; c > 0; --c) cell_begin[c] = cell_begin[c - 1];
  cell_begin[0] = 0;

  const auto try_merge = [&](std::size_t i, std::size_t j) {
    const PredictedObservation &p = expected[i].predicted, &q = expected[j].predicted;
    const float dx = q.x_l - p.x_l, dy = q.y_l - p.y_l;
    if (std::fabs(dx * p.c_l + dy * p.s_l) > associate::kSlideGate || std::fabs(-dx * p.s_l + dy * p.c_l) > 4) return;
    Track &a = store.tracks[slots[i]], &b = store.tracks[slots[j]];
    if (a.state == State::kFree || b.state == State::kFree) return;
    const std::uint32_t older = a.first_frame != b.first_frame ? (a.first_frame < b.first_frame ? slots[i] : slots[j])
                                                               : std::min(slots[i], slots[j]);
    const std::uint32_t younger = older == slots[i] ? slots[j] : slots[i];
    Geometry g = load(store.geometry[older / kBlockLanes], older % kBlockLanes);
    const Geometry h = load(store.geometry[younger / kBlockLanes], younger % kBlockLanes);
    const float bias = bias_px * p.depth_m / focal_px;
    if (merge_distance2(g, h, bias * bias) > 9.49F) return;  // 4 dof, 95 %
    AppearanceState ga = load(store.appearance[older / kBlockLanes], older % kBlockLanes);
    const AppearanceState ha = load(store.appearance[younger / kBlockLanes], younger % kBlockLanes);
    if (appearance_distance2(ga, ha, opposite(g, h)) > 14.07F) return;  // 7 dof, 95 %
    if (!fuse_by_covariance_intersection(g, ga, h, ha)) {
      ++report.merge_refused;
      return;
    }
    accrete::store(g, store.geometry[older / kBlockLanes], older % kBlockLanes);
    accrete::store(ga, store.appearance[older / kBlockLanes], older % kBlockLanes);
    // Their evidence is correlated: the better one counts, not the sum.
    Track &keep = store.tracks[older], &gone = store.tracks[younger];
    const bool gone_is_accepted = gone.state != State::kTentative;
    if (gone.log_odds > keep.log_odds || (gone_is_accepted && keep.state == State::kTentative)) {
      keep.log_odds = std::max(keep.log_odds, gone.log_odds);
      keep.novel_matches = std::max(keep.novel_matches, gone.novel_matches);
      keep.motion_log_odds = std::max(keep.motion_log_odds, gone.motion_log_odds);
      if (gone_is_accepted) keep.state = gone.state;
    }
    if (gone.observations > keep.observations)  // the longer one has learned more; its sides may be the other way round
      keep.reliability = opposite(g, h) ? reversed(gone.reliability) : gone.reliability;
    keep.observations = std::max(keep.observations, gone.observations);
    keep.last_frame = std::max(keep.last_frame, gone.last_frame);
    store.release(younger);
    ++report.merged;
  };

  for (std::size_t i = 0; i < slots.size(); ++i) {
    const int cx = cell(expected[i].predicted.x_l), cy = cell(expected[i].predicted.y_l);
    for (int y = std::max(cy - 1, 0); y <= std::min(cy + 1, kSide - 1); ++y)
      for (int x = std::max(cx - 1, 0); x <= std::min(cx + 1, kSide - 1); ++x) {
        const auto c = static_cast<std::size_t>(y) * kSide + static_cast<std::size_t>(x);
        for (std::uint32_t k = cell_begin[c]; k < cell_begin[c + 1]; ++k)
          if (cell_order[k] > i) try_merge(i, cell_order[k]);
      }
  }
}

}  // namespace accrete
