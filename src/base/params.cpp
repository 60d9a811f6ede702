#include "accrete/params.h"

#include <cmath>

namespace accrete {
namespace {

// False for NaN, too.
bool within(float v, float low, float high) { return v >= low && v <= high; }

}  // namespace

Status validate(const Params& p) {
  constexpr float kHalfTurn = 3.1416F;
  bool ok = within(p.extract.noise_sigma, 0.01F, 128) && within(p.extract.min_amplitude, 0.1F, 255) &&
            within(p.extract.min_confidence_i1d, 0, 1) && within(p.extract.mixing_width_px, 0, 10) &&
            within(p.extract.floor_n_px, 0.001F, 10) && within(p.extract.floor_theta, 1e-5F, kHalfTurn / 2);
  const StereoParams& s = p.stereo;
  ok = ok && within(s.min_depth_m, 0, 1e6F) && within(s.max_depth_m, 0, 1e6F) && within(s.min_similarity, 0, 1) &&
       s.max_rivals >= 1 && s.max_rivals <= 6 && within(s.min_psi, 0.01F, kHalfTurn / 2);
  ok = ok && (s.min_depth_m == 0 || s.max_depth_m == 0 || s.min_depth_m < s.max_depth_m);
  ok = ok && within(p.filter.bias_px, 0, 10) && within(p.filter.sigma_roll, 0.01F, kHalfTurn);
  const ExistenceParams& e = p.existence;
  ok = ok && within(e.detection, 0.01F, 0.99F) && within(e.decide, 0.1F, 20) && within(e.clamp, e.decide, 50) &&
       e.min_novel_matches >= 0;
  ok = ok && p.excluded_count >= 0 && p.excluded_count <= kMaxExcludedBoxes;
  if (!ok) return Status::kInvalidArgument;
  for (int i = 0; i < p.excluded_count; ++i) {
    const ExcludedBox& b = p.excluded[static_cast<std::size_t>(i)];
    for (std::size_t k = 0; k < 3; ++k)
      if (!(std::isfinite(b.min_m[k]) && std::isfinite(b.max_m[k]) && b.min_m[k] < b.max_m[k]))
        return Status::kInvalidArgument;
  }
  return Status::kOk;
}

}  // namespace accrete
