// Existence as a sequential Bayesian test (METHOD 7; docs/math/existence.md).
#pragma once

#include "accrete/params.h"
#include "existence/track.h"

namespace accrete::existence {

[[nodiscard]] float probability(float log_odds);
[[nodiscard]] float log_odds(float probability);

// Distance of two views in deviations: of the line across itself, or of its angle, whichever is larger, at either eye.
[[nodiscard]] float deviations_apart(const View& a, const View& b, float sigma_n_px, float sigma_theta);

// How much a view differs from the last one that counted, 0 (identical: no new information about existence) .. 1
// (METHOD 7.2), from their distance in deviations; of an edge, the displacement of the predicted line across itself and
// of its angle.
[[nodiscard]] float novelty(float deviations);
[[nodiscard]] float novelty(const View& last, const View& now, float sigma_n_px, float sigma_theta);

// Largest displacement in px between two views, at either eye.
[[nodiscard]] float displacement_px(const View& a, const View& b);

// One frame's evidence, clipped to -2 .. 3 and weighted by novelty; log-odds stay inside +-clamp.
[[nodiscard]] float updated_log_odds(float log_odds, float log_likelihood_ratio, float novelty_weight, float clamp);

// Visibility of a confirmed primitive as a two-state Markov chain: it stays as it was, the less the more the view has
// turned, and otherwise is what the geometry says. Hidden edges stay hidden for a while; this is what preserves them.
[[nodiscard]] float predicted_visibility(float last, float face, float turned_rad);
// The same after a look: certain after a match; Bayes after a miss with probability `detection` of being found.
[[nodiscard]] float corrected_visibility(float predicted, bool matched, float detection);

}  // namespace accrete::existence
