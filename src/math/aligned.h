// Where the map is, seen from the aligned pair of virtual cameras (AlignedRig, camera.h), in the filter's precision.
#pragma once

namespace accrete {

// Map to the aligned left frame: p_a = R p_m + t. R row-major.
struct AlignedPose {
  float R[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  float t[3] = {0, 0, 0};  // m
};

// Both virtual cameras have this focal length and the principal point at zero; the right one stands at (baseline, 0,
// 0).
struct AlignedOptics {
  float focal_px = 0;
  float baseline_m = 0;
};

// A point nearer than this to the common image plane of the two cameras is behind them: nothing can be predicted.
inline constexpr float kMinDepth_m = 1e-3F;

}  // namespace accrete
