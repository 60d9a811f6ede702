// The tunables of params.h by name, for --set, config.yaml and the summary.
#pragma once

#include <string>

#include "accrete/params.h"

namespace accrete::cli {

// Calls f(stage, name, member) for every tunable; the excluded boxes are no tunables.
template <class P, class F>
void for_each_param(P& p, F&& f) {
  f("extract", "noise_sigma", p.extract.noise_sigma);
  f("extract", "min_amplitude", p.extract.min_amplitude);
  f("extract", "min_confidence_i1d", p.extract.min_confidence_i1d);
  f("extract", "floor_n_px", p.extract.floor_n_px);
  f("extract", "mixing_width_px", p.extract.mixing_width_px);
  f("extract", "floor_theta", p.extract.floor_theta);
  f("stereo", "min_depth_m", p.stereo.min_depth_m);
  f("stereo", "max_depth_m", p.stereo.max_depth_m);
  f("stereo", "min_similarity", p.stereo.min_similarity);
  f("stereo", "max_rivals", p.stereo.max_rivals);
  f("stereo", "min_psi", p.stereo.min_psi);
  f("filter", "bias_px", p.filter.bias_px);
  f("filter", "sigma_roll", p.filter.sigma_roll);
  f("existence", "detection", p.existence.detection);
  f("existence", "decide", p.existence.decide);
  f("existence", "clamp", p.existence.clamp);
  f("existence", "min_novel_matches", p.existence.min_novel_matches);
}

// "stage.name=value". Throws Failure(kUsage): no such tunable (the sentence lists those there are), or no number.
void set_param(Params& params, const std::string& assignment);

}  // namespace accrete::cli
