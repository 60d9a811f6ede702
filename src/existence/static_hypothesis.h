// The rival of the given motion: an edge that stands still in the image, as the background behind a turning object does
// (METHOD 8). It predicts that both eyes still see what they saw when the primitive was born.
#pragma once

#include "associate/associate.h"
#include "existence/track.h"

namespace accrete::existence {

// log of the IPDA bracket of the static hypothesis in this frame. `detection`: p_d of one eye.
[[nodiscard]] float static_log_ratio(const Track& track, const Appearance& mean, const associate::EyeView& left,
                                     const associate::EyeView& right, float detection);

// Do the two hypotheses predict different things, more than three deviations apart across the edge or in angle? Motion
// along an edge tells nothing. `now`: the view by the given motion; sigmas of its prediction.
[[nodiscard]] bool distinguishable(const Track& track, const View& now, float sigma_n_px, float sigma_theta);

}  // namespace accrete::existence
