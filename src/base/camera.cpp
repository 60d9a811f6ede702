#include "accrete/camera.h"

#include <cmath>

#include "base/elementary.h"
#include "distortion.h"

namespace accrete {
namespace {

// Of the residual in the plane at z = 1: 1e-9 is a millionth of a pixel.
constexpr double kConverged = 1e-9;

double determinant(const std::array<double, 4>& j) { return j[0] * j[3] - j[1] * j[2]; }

// The point is on the branch that the lens has, and the map is invertible there.
bool in_domain(const Camera& camera, Normalized p, const std::array<double, 4>& jacobian) {
  return distortion::before_fold(camera, p) && determinant(jacobian) > 0;
}

// A damped Newton iteration from `p`. False when it does not arrive at `target`.
bool newton(const Camera& camera, Normalized target, Normalized& p) {
  auto m = distortion::distort(camera, p);
  double ex = m.point.x - target.x, ey = m.point.y - target.y, error = ex * ex + ey * ey;
  for (int i = 0; i < 20; ++i) {
    const double det = determinant(m.jacobian);
    if (!(det > 1e-12)) break;  // at the fold
    const double dx = (m.jacobian[3] * ex - m.jacobian[1] * ey) / det;
    const double dy = (m.jacobian[0] * ey - m.jacobian[2] * ex) / det;
    double s = 1;
    bool better = false;
    for (int half = 0; half < 8 && !better; ++half, s *= 0.5) {
      const Normalized q{p.x - s * dx, p.y - s * dy};
      const auto mq = distortion::distort(camera, q);
      const double qx = mq.point.x - target.x, qy = mq.point.y - target.y, e = qx * qx + qy * qy;
      if (e < error) {
        p = q;
        m = mq;
        ex = qx;
        ey = qy;
        error = e;
        better = true;
      }
    }
    if (!better || error < 1e-24) break;  // a billionth of a pixel
  }
  return error < kConverged * kConverged && in_domain(camera, p, m.jacobian);
}

}  // namespace

Result<Pixel> project(const Camera& camera, Normalized p) {
  const auto m = distortion::distort(camera, p);
  const Pixel pixel{camera.fx_px * m.point.x + camera.cx_px, camera.fy_px * m.point.y + camera.cy_px};
  if (!std::isfinite(pixel.x) || !std::isfinite(pixel.y)) return Status::kInvalidArgument;
  if (camera.distortion != Distortion::kNone && !in_domain(camera, p, m.jacobian)) return Status::kInvalidArgument;
  return pixel;
}

Result<Normalized> unproject(const Camera& camera, Pixel pixel) {
  const Normalized d{(pixel.x - camera.cx_px) / camera.fx_px, (pixel.y - camera.cy_px) / camera.fy_px};
  if (!std::isfinite(d.x) || !std::isfinite(d.y)) return Status::kInvalidArgument;
  if (camera.distortion == Distortion::kNone) return d;
  Normalized p = d;
  // From the distorted point itself it takes three or four steps, except near the fold and beyond 60 degrees.
  if (camera.distortion == Distortion::kBrownConrady && newton(camera, d, p)) return p;
  p = distortion::invert_radial(camera, d);
  if (camera.distortion == Distortion::kBrownConrady)
    return newton(camera, d, p) ? Result<Normalized>(p) : Result<Normalized>(Status::kInvalidArgument);
  const auto m = distortion::distort(camera, p);  // radial alone: inverted already
  const bool arrived = hypot_of(m.point.x - d.x, m.point.y - d.y) <= kConverged;
  return arrived && in_domain(camera, p, m.jacobian) ? Result<Normalized>(p)
                                                     : Result<Normalized>(Status::kInvalidArgument);
}

std::array<double, 4> project_jacobian(const Camera& camera, Normalized p) {
  auto j = distortion::distort(camera, p).jacobian;
  j[0] *= camera.fx_px;
  j[1] *= camera.fx_px;
  j[2] *= camera.fy_px;
  j[3] *= camera.fy_px;
  return j;
}

Status validate(const Camera& camera) {
  if (camera.width_px <= 0 || camera.height_px <= 0) return Status::kInvalidArgument;
  for (const double v : {camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px})
    if (!std::isfinite(v)) return Status::kInvalidArgument;
  for (const double k : camera.coefficients)
    if (!std::isfinite(k)) return Status::kInvalidArgument;
  return camera.fx_px > 0 && camera.fy_px > 0 ? Status::kOk : Status::kInvalidArgument;
}

}  // namespace accrete
