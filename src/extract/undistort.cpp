#include "extract/undistort.h"

#include <cmath>

#include "base/elementary.h"

namespace accrete::extract {

bool undistort(const Camera& camera, const Mat3& R_a_c, double focal_px, Primitive2d& primitive) {
  const Result<Normalized> ray = unproject(camera, {primitive.x_px, primitive.y_px});
  if (!ray.ok()) return false;
  const Normalized n = ray.value();
  const Vec3 d = R_a_c * Vec3{n.x, n.y, 1};
  const double length = norm(d);
  if (!(d[2] > 0.1736 * length)) return false;  // cos 80 degrees

  // J = d(aligned px)/d(normalized) * inverse(d(raw px)/d(normalized)).
  const double iz = 1 / d[2], ax = d[0] * iz, ay = d[1] * iz;
  const auto& R = R_a_c;
  const double a00 = focal_px * iz * (R[0] - ax * R[6]), a01 = focal_px * iz * (R[1] - ax * R[7]);
  const double a10 = focal_px * iz * (R[3] - ay * R[6]), a11 = focal_px * iz * (R[4] - ay * R[7]);
  const std::array<double, 4> P = project_jacobian(camera, n);
  const double det = P[0] * P[3] - P[1] * P[2];
  if (!(std::fabs(det) > 1e-9)) return false;
  const double i00 = P[3] / det, i01 = -P[1] / det, i10 = -P[2] / det, i11 = P[0] / det;
  const double j00 = a00 * i00 + a01 * i10, j01 = a00 * i01 + a01 * i11;
  const double j10 = a10 * i00 + a11 * i10, j11 = a10 * i01 + a11 * i11;

  const double c = cos_of(primitive.theta), s = sin_of(primitive.theta);
  const double ux = j00 * c + j01 * s, uy = j10 * c + j11 * s;
  const double stretch = std::sqrt(ux * ux + uy * uy);
  if (!(stretch > 1e-6)) return false;
  // A line's normal offset scales by area over length, its direction by area over length squared.
  const double area = std::fabs(j00 * j11 - j01 * j10);
  LineElement& e = primitive.aligned;
  e.x_px = static_cast<float>(focal_px * ax);
  e.y_px = static_cast<float>(focal_px * ay);
  e.c = static_cast<float>(ux / stretch);
  e.s = static_cast<float>(uy / stretch);
  e.sigma_n_px = static_cast<float>(primitive.sigma_n_px * area / stretch);
  e.sigma_theta = static_cast<float>(primitive.sigma_theta * area / (stretch * stretch));
  return std::isfinite(e.x_px) && std::isfinite(e.y_px);
}

}  // namespace accrete::extract
