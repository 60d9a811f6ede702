// edges.csv as the scorer sees it: any file with the columns that DESIGN fixes, ours or another program's.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "accrete/geometry.h"
#include "accrete/primitive.h"

namespace accrete::cli {

struct ScoredEdge {
  std::string id;
  State state = State::kTentative;
  double existence = 0;
  Vec3 position{};
  Vec3 tangent{};  // unit
  double phase = 0;
  Vec3 left{}, right{};
  Mat3 rotation{};                      // own frame to the frame of the file; NaN when the quaternion is none
  std::array<double, 36> covariance{};  // 6 x 6, position then rotation about the own axes
};

struct ScoredEdges {
  std::vector<ScoredEdge> list;
  bool has_phase = false, has_colours = false, has_rotation = false, has_covariance = false;
};

// Primitives whose position, tangent or existence is not finite are dropped; that, and everything else that looks odd,
// goes to `notes`. Throws Failure(kInput): a column missing, an unknown state, existence outside 0..1.
[[nodiscard]] ScoredEdges parse_edges(std::string_view text, const std::string& name, std::vector<std::string>& notes);

}  // namespace accrete::cli
