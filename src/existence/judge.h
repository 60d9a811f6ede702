// What one look at a primitive does to its existence, its motion evidence, its visibility and its state.
#pragma once

#include "associate/associate.h"
#include "existence/n_scan.h"
#include "existence/track.h"

namespace accrete::existence {

// Whatever the feature is.
struct Evidence {
  associate::AssociateOutcome outcome;
  float log_likelihood_ratio;  // by the given motion (METHOD 7.2)
  float static_log_ratio;      // by standing still; used where the two are distinguishable
  bool distinguishable;
  float visible;    // P_vis before the look
  float detection;  // p_d of one eye
  std::array<float, 3> toward_viewer;
  std::uint32_t frame;
  bool repeated = false;  // a match, but no new one: found_by_repetition
};

// Of an edge: with the predicted view, and the deviations of what should be seen.
struct Look : Evidence {
  View view;
  float sigma_n_px, sigma_theta;
};

struct Judgement {
  Verdict verdict;
  bool counted;  // the evidence was new: the view becomes the reference of the next novelty
};

// Counts evidence only where the view is new since evidence was last counted. Deleting is the caller's.
[[nodiscard]] Judgement judge(Track& track, const Evidence& evidence, float novelty, const ExistenceParams& params);
// The same of an edge, whose track holds the reference.
[[nodiscard]] Verdict judge(Track& track, const Look& look, const ExistenceParams& params);

}  // namespace accrete::existence
