// Colours and phase against the truth.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "cli/score/scored_edges.h"
#include "cli/score/truth.h"

namespace accrete::cli {

// A primitive and the segment that it agrees with.
struct Matched {
  const ScoredEdge* edge = nullptr;
  const Segment* segment = nullptr;
};

// Sides right, error of both colours before and after one gain and offset per channel (exposure), local y to the right.
[[nodiscard]] nlohmann::ordered_json score_colour(const std::vector<Matched>& matched, bool with_axes);
// Deviation from a step edge (+-pi/2), and its sign against the truth's colours.
[[nodiscard]] nlohmann::ordered_json score_phase(const std::vector<Matched>& matched, bool with_colours);

}  // namespace accrete::cli
