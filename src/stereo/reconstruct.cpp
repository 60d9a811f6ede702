#include "stereo/reconstruct.h"

#include "math/record_state.h"
#include "stereo/reconstruct_kernel.h"

namespace accrete {

ReconstructOutcome reconstruct(const LineElement& left, const LineElement& right, const AlignedOptics& optics,
                               float sigma_t_px, float sigma_roll, Geometry& out, float min_plane_sine) {
  const Element<float> l = {left.x_px, left.y_px, left.c, left.s}, r = {right.x_px, right.y_px, right.c, right.s};
  const Noise5<float> sigma = {sigma_t_px, left.sigma_n_px, left.sigma_theta, right.sigma_n_px, right.sigma_theta};
  LaneState<float> x;
  const ReconstructOutcome outcome =
      reconstruct(l, r, sigma, optics.focal_px, optics.baseline_m, sigma_roll, min_plane_sine, x);
  if (outcome == ReconstructOutcome::kOk) out = record_of(x);
  return outcome;
}

bool transform(Geometry& geometry, const float R_m_a[9], const float t_m_a[3]) {
  LaneState<float> x = state_of<float>(geometry);
  const Matrix3<float> R = matrix_from<float>(R_m_a);
  x.p = rotate(R, x.p);
  for (int i = 0; i < 3; ++i) x.p[i] += t_m_a[i];
  x.q = normalized(quaternion_of(R) * x.q);
  float sum = x.q.x + x.q.y + x.q.z + x.q.w;
  for (const float v : x.p) sum += v;
  if (!is_finite(sum)) return false;
  geometry = record_of(x);
  return true;
}

}  // namespace accrete
