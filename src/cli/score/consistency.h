// Is the stated covariance honest? Normalised estimation error squared of the four observable degrees of freedom.
#pragma once

#include <optional>

#include "cli/score/scored_edges.h"
#include "cli/score/truth.h"

namespace accrete::cli {

struct Nees {
  double all = 0;        // 4 degrees of freedom: a consistent filter has mean 4
  double position = 0;   // 2: offset of the truth line across the edge (local y, z)
  double direction = 0;  // 2: rotation about local y and z
};

// Errors are truth minus estimate; the truth's own uncertainty is added to the covariance. Empty when the covariance is
// not finite or not positive definite. The slide along the edge and the roll about it are not observable: left out.
[[nodiscard]] std::optional<Nees> nees(const ScoredEdge& edge, const Segment& truth, double truth_sigma_m,
                                       double truth_sigma_rad);

}  // namespace accrete::cli
