// Scores accumulated primitives against exact truth segments: accuracy, precision, completeness, leakage, colours,
// phase, honesty of the covariance and of the existence probability.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/score/scored_edges.h"
#include "cli/score/truth.h"

namespace accrete::cli {

struct ScoreSettings {
  double tolerance_mm = 3;  // correct: perpendicular distance at most this
  double pitch_mm = 5;      // a foot may lie this far beyond the end of a segment
  double along_mm = 5;      // reach of a primitive along the edge, for completeness
  double angle_deg = 20;    // directions that agree
  double gate_mm = 10;      // wider gate for the second distance and NEES lines
  double background_tolerance_mm = 10;
  double end_mm = 2;           // colours and phase are judged only this far inside a segment
  double min_existence = 0.9;  // judged: confirmed or preserved, and at least this
  double truth_sigma_mm = 0;   // known uncertainty of the truth, added in the NEES
  double truth_sigma_deg = 0;
};

// The result as a JSON object: settings, notes, counts, precision, outlier_rate, wrong_direction_rate, distance_mm,
// tangent_deg, distance_mm_gate, completeness, leakage, surface, colour, phase, nees, existence. What cannot be
// computed is null, or absent where the files have no columns for it. `notes`: what the reader of the edges found odd.
// Precondition: truth.edges is there.
[[nodiscard]] nlohmann::ordered_json score(const ScoredEdges& edges, const Truth& truth, const ScoreSettings& settings,
                                           std::vector<std::string> notes = {});

struct TableRow {
  std::string label, value;
};
// The result of score() for people.
[[nodiscard]] std::vector<TableRow> score_table(const nlohmann::ordered_json& result);

}  // namespace accrete::cli
