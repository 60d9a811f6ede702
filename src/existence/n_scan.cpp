#include "existence/n_scan.h"

#include <cmath>
#include <numeric>

#include "base/elementary.h"

namespace accrete::existence {

int classical_n(double alpha, double detection) {
  return static_cast<int>(std::ceil(log_of(alpha) / log_of(1 - detection) - 1e-9));
}

float miss_run(float run, bool matched, float detection_now) {
  return matched ? 0.0F : run - log_of(1 - detection_now);
}

bool delete_by_miss_run(float run, float alpha) {
  // The run is a sum of rounded logarithms: a hair below the bound counts as reaching it.
  return run >= -log_of(alpha) - 1e-4F;
}

bool delete_by_window(std::span<const float> log_ratios, float log_bound) {
  return std::accumulate(log_ratios.begin(), log_ratios.end(), 0.0F) < log_bound;
}

Verdict sequential(const Track& track, const ExistenceParams& params) {
  if (track.log_odds <= -params.decide) return Verdict::kDelete;
  const bool proven = track.log_odds >= params.decide &&
                      track.novel_matches >= static_cast<std::uint32_t>(params.min_novel_matches) &&
                      track.motion_log_odds >= params.decide;
  return proven ? Verdict::kConfirm : Verdict::kUndecided;
}

}  // namespace accrete::existence
