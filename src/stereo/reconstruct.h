// A 3D-primitive out of one stereo pair of line elements (METHOD 3; docs/math/reconstruction.md).
#pragma once

#include <cstdint>

#include "accrete/primitive.h"
#include "math/aligned.h"

namespace accrete {

enum class ReconstructOutcome : std::uint8_t {
  kOk,
  kDegenerate,  // the two back-projected planes are nearly parallel, or the noise reaches infinity
  kBehind,      // the point lies behind the cameras
};

// sin(1 degree): the smallest sine of the angle between the two back-projected planes (METHOD 3.3).
inline constexpr float kMinPlaneSine = 0.01745F;

// Point = left ray meets right plane; tangent = intersection of the planes, signed by the left direction; local z
// points away from the middle of the cameras. Covariance by the unscented transform over the slide along the left edge
// (sigma_t_px), and offset and angle of both elements (sigma_n_px, sigma_theta of the elements), plus sigma_roll (rad)
// of prior about the tangent. Both elements are described in the same sense (reversed() is the caller's). `out` is in
// the aligned left frame, and written on kOk only.
[[nodiscard]] ReconstructOutcome reconstruct(const LineElement& left, const LineElement& right,
                                             const AlignedOptics& optics, float sigma_t_px, float sigma_roll,
                                             Geometry& out, float min_plane_sine = kMinPlaneSine);

// Into another frame: p_m = R_m_a p_a + t_m_a; R row-major, a rotation. The errors are in the primitive's own
// frame, which moves along: their covariance stays. false, and nothing changed: the frame's origin is so far away that
// float cannot hold the result.
bool transform(Geometry& geometry, const float R_m_a[9], const float t_m_a[3]);

}  // namespace accrete
