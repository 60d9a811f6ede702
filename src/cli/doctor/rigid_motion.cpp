#include "cli/doctor/rigid_motion.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace accrete::cli {
namespace {

constexpr std::size_t kN = 6;
using Vector = std::array<double, kN>;
using Matrix = std::array<Vector, kN>;

// Gaussian elimination with pivots; false when singular.
bool solve(Matrix a, Vector b, Vector& x) {
  for (std::size_t i = 0; i < kN; ++i) {
    std::size_t pivot = i;
    for (std::size_t r = i + 1; r < kN; ++r)
      if (std::abs(a[r][i]) > std::abs(a[pivot][i])) pivot = r;
    if (!(std::abs(a[pivot][i]) > 1e-15)) return false;
    std::swap(a[i], a[pivot]);
    std::swap(b[i], b[pivot]);
    for (std::size_t r = i + 1; r < kN; ++r) {
      const double factor = a[r][i] / a[i][i];
      for (std::size_t c = i; c < kN; ++c) a[r][c] -= factor * a[i][c];
      b[r] -= factor * b[i];
    }
  }
  for (std::size_t i = kN; i-- > 0;) {
    x[i] = b[i];
    for (std::size_t c = i + 1; c < kN; ++c) x[i] -= a[i][c] * x[c];
    x[i] /= a[i][i];
  }
  return true;
}

Quaternion turned(const Vec3& w, const Quaternion& q) {
  const double angle = norm(w), s = angle < 1e-9 ? 0.5 : std::sin(0.5 * angle) / angle;
  const Quaternion r = Quaternion{s * w[0], s * w[1], s * w[2], std::cos(0.5 * angle)} * q;
  const double n = std::sqrt(r.x * r.x + r.y * r.y + r.z * r.z + r.w * r.w);
  return {r.x / n, r.y / n, r.z / n, r.w / n};
}

}  // namespace

double reprojection_error(const Transform<Left, Left>& motion, const TrackedPoint& point) {
  const Vec3 p = motion * point.before;
  if (!(p[2] > 1e-9 * norm(point.before))) return 1e9;
  return std::hypot(p[0] / p[2] - point.after.x, p[1] / p[2] - point.after.y);
}

Transform<Left, Left> estimate_motion(const std::vector<TrackedPoint>& points, double coarse, double fine) {
  Transform<Left, Left> motion;
  if (points.size() < 6) return motion;
  std::vector<double> depths;
  depths.reserve(points.size());
  for (const TrackedPoint& p : points) depths.push_back(p.before[2]);
  std::nth_element(depths.begin(), depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2), depths.end());
  const double unit = depths[depths.size() / 2];  // so that the two halves of the unknowns weigh alike in any unit

  constexpr int kSteps = 30;
  for (int step = 0; step < kSteps; ++step) {
    const double scale = std::max(fine, coarse * std::pow(fine / coarse, step / (0.7 * kSteps)));
    Matrix h{};
    Vector g{};
    for (const TrackedPoint& point : points) {
      const Vec3 p = motion * point.before;
      if (!(p[2] > 1e-6 * unit)) continue;
      const double x = p[0] / p[2], y = p[1] / p[2], ex = x - point.after.x, ey = y - point.after.y;
      const double ratio = (ex * ex + ey * ey) / (scale * scale), weight = 1 / ((1 + ratio) * (1 + ratio));
      const double z = unit / p[2];
      const Vector jx{-x * y, 1 + x * x, -y, z, 0, -x * z}, jy{-1 - y * y, x * y, x, 0, z, -y * z};
      for (std::size_t i = 0; i < kN; ++i) {
        g[i] -= weight * (jx[i] * ex + jy[i] * ey);
        for (std::size_t j = 0; j < kN; ++j) h[i][j] += weight * (jx[i] * jx[j] + jy[i] * jy[j]);
      }
    }
    for (std::size_t i = 0; i < kN; ++i) h[i][i] *= 1 + 1e-4;
    Vector d{};
    if (!solve(h, g, d)) break;
    const Vec3 w{d[0], d[1], d[2]};
    const Quaternion turn = turned(w, Quaternion{});
    motion.rotation = turned(w, motion.rotation);
    motion.translation = to_matrix(turn) * motion.translation + unit * Vec3{d[3], d[4], d[5]};
  }
  return motion;
}

}  // namespace accrete::cli
