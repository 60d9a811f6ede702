#include "cli/project.h"

#include <algorithm>
#include <cmath>

namespace accrete::cli {
namespace {

Vec3 to_vec3(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

}  // namespace

std::optional<Projection> project(const Primitive3d& primitive, const Viewpoint& view, const Camera& camera) {
  constexpr double kNearM = 1e-3;
  const Vec3 p = view.rotation * to_vec3(primitive.geometry.position) + view.translation;
  const Vec3 t = view.rotation * to_vec3(primitive.tangent);
  if (!(p[2] > kNearM)) return std::nullopt;
  const Normalized n{p[0] / p[2], p[1] / p[2]};
  const Result<Pixel> pixel = project(camera, n);
  if (!pixel.ok()) return std::nullopt;
  const double du = (t[0] - n.x * t[2]) / p[2], dv = (t[1] - n.y * t[2]) / p[2];
  const std::array<double, 4> j = project_jacobian(camera, n);
  const double dx = j[0] * du + j[1] * dv, dy = j[2] * du + j[3] * dv;
  const double speed = std::hypot(dx, dy);
  if (!(speed > 1e-6 * camera.fx_px / p[2])) return std::nullopt;

  const auto& q = primitive.geometry.quaternion;
  const Mat3 own = to_matrix({q[0], q[1], q[2], q[3]});
  const Vec3 away = view.rotation * Vec3{own[2], own[5], own[8]};
  const Vec3 sight = p - dot(p, t) * t;
  const double cosine = dot(away, sight) / std::max(norm(sight) * norm(away), 1e-12);
  return Projection{
      pixel.value().x, pixel.value().y, std::atan2(dy, dx), p[2], speed, std::acos(std::clamp(cosine, -1.0, 1.0))};
}

}  // namespace accrete::cli
