// Keep or discard: the classical n-scan criterion and its probabilistic forms (METHOD 7.4).
#pragma once

#include <cstdint>
#include <span>

#include "accrete/params.h"
#include "existence/track.h"

namespace accrete::existence {

enum class Verdict : std::uint8_t { kUndecided, kConfirm, kDelete };

// Classical: delete after n misses in a row; n = ceil(log alpha / log(1 - detection)) deletes a visible true primitive
// with probability alpha.
[[nodiscard]] int classical_n(double alpha, double detection);

// (a) generalised miss run: zero on a match, otherwise grown by -log(1 - P_vis p_d P_G); delete above -log alpha. With
// a constant detection probability this is the classical rule; hidden (P_vis = 0) it stands still.
[[nodiscard]] float miss_run(float run, bool matched, float detection_now);
[[nodiscard]] bool delete_by_miss_run(float run, float alpha);

// (b) window: sum of the weighted log likelihood ratios of the last informative scans against log(bound).
[[nodiscard]] bool delete_by_window(std::span<const float> log_ratios, float log_bound);

// (c) sequential test on the log-odds, the default: confirm at +decide with enough matches at novel views and evidence
// of moving with the given motion; delete at -decide.
[[nodiscard]] Verdict sequential(const Track& track, const ExistenceParams& params);

}  // namespace accrete::existence
