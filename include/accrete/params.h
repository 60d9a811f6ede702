// Every tunable, with its default, unit, meaning and origin. docs/math/ derives them.
#pragma once

#include <array>
#include <cstdint>

#include "accrete/status.h"

namespace accrete {

struct ExtractParams {
  float noise_sigma = 2.0F;         // grey levels: image noise, scales the localisation covariance
  float min_amplitude = 4.25F;      // grey levels of the band-pass response, of a step a quarter: 8 x its noise
  float min_confidence_i1d = 0.4F;  // of intrinsic dimensionality one (METHOD 1.3)
  float floor_n_px = 0.10F;         // localisation across the edge that no amount of contrast beats (METHOD 1.4)
  float mixing_width_px = 1.0F;     // over which light is mixed before it is encoded (0: linear images): one pixel
  float floor_theta = 0.0262F;      // rad (1.5 degrees): the same for the orientation
};

struct StereoParams {
  float min_depth_m = 0;         // 0: no limit (disparity up to half the image width)
  float max_depth_m = 0;         // 0: no limit (disparity above zero)
  float min_similarity = 0.75F;  // METHOD 2.2
  int max_rivals = 4;            // hypotheses kept per left primitive
  float min_psi = 0.4363F;       // rad (25 degrees): angle of the edge to the epipolar line below which none is born
};

struct FilterParams {
  float bias_px = 0.15F;       // systematic localisation error that filtering does not shrink (METHOD 1.4)
  float sigma_roll = 0.8727F;  // rad (50 degrees), the prior about the tangent (METHOD 3.2)
};

struct ExistenceParams {
  float detection = 0.83F;    // probability that a visible edge is extracted (METHOD 7.5)
  float decide = 4.6F;        // log-odds of confirmation and deletion: 1 % error (METHOD 7.4)
  float clamp = 6.0F;         // log-odds are kept within +- this: bounds the reaction time
  int min_novel_matches = 3;  // matches at novel views that confirmation needs
};

// An axis-parallel region of the map frame in which nothing is accumulated: a gripper that moves along with the object.
struct ExcludedBox {
  std::array<float, 3> min_m{};
  std::array<float, 3> max_m{};
};
inline constexpr int kMaxExcludedBoxes = 8;

struct Params {  // of all stages; docs/reference/program.md has the ranges
  ExtractParams extract;
  StereoParams stereo;
  FilterParams filter;
  ExistenceParams existence;
  std::array<ExcludedBox, kMaxExcludedBoxes> excluded{};
  int excluded_count = 0;
};

// kInvalidArgument: a value is not finite, out of its range, or contradicts another.
[[nodiscard]] Status validate(const Params& params);

}  // namespace accrete
