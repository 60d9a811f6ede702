#include "cli/score/consistency.h"

#include <array>
#include <cmath>
#include <utility>

namespace accrete::cli {
namespace {

using Mat4 = std::array<std::array<double, 4>, 4>;
using Vec4 = std::array<double, 4>;

// Smallest eigenvalue of a symmetric matrix by Jacobi rotations.
double smallest_eigenvalue(Mat4 a) {
  for (int sweep = 0; sweep < 30; ++sweep) {
    double off = 0;
    for (int p = 0; p < 4; ++p)
      for (int q = p + 1; q < 4; ++q) {
        off += a[p][q] * a[p][q];
        if (a[p][q] == 0) continue;
        const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        const auto rotate = [c, s](double& x, double& y) {
          const double turned = c * x - s * y;
          y = s * x + c * y;
          x = turned;
        };
        for (int k = 0; k < 4; ++k) rotate(a[k][p], a[k][q]);
        for (int k = 0; k < 4; ++k) rotate(a[p][k], a[q][k]);
      }
    if (off < 1e-30) break;
  }
  return std::min(std::min(a[0][0], a[1][1]), std::min(a[2][2], a[3][3]));
}

// e' S^-1 e over rows first .. first + n - 1, by elimination with pivoting.
double quadratic_form(const Mat4& s, const Vec4& e, int first, int n) {
  std::array<std::array<double, 5>, 4> m{};
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) m[i][j] = s[first + i][first + j];
    m[i][n] = e[first + i];
  }
  for (int k = 0; k < n; ++k) {
    int pivot = k;
    for (int i = k + 1; i < n; ++i)
      if (std::abs(m[i][k]) > std::abs(m[pivot][k])) pivot = i;
    std::swap(m[k], m[pivot]);
    for (int i = k + 1; i < n; ++i) {
      const double f = m[i][k] / m[k][k];
      for (int j = k; j <= n; ++j) m[i][j] -= f * m[k][j];
    }
  }
  double sum = 0;
  for (int i = n - 1; i >= 0; --i) {
    for (int j = i + 1; j < n; ++j) m[i][n] -= m[i][j] * m[j][n];
    m[i][n] /= m[i][i];
    sum += m[i][n] * e[first + i];
  }
  return sum;
}

}  // namespace

std::optional<Nees> nees(const ScoredEdge& edge, const Segment& truth, double truth_sigma_m, double truth_sigma_rad) {
  const Mat3& r = edge.rotation;
  const Vec3 tx{r[0], r[3], r[6]}, ty{r[1], r[4], r[7]}, tz{r[2], r[5], r[8]};
  const double along = dot(truth.direction, tx);
  const double sign = along > 0 ? 1 : along < 0 ? -1 : 0;
  const Vec3 d = sign * truth.direction;
  double denominator = dot(d, tx);
  if (!(std::abs(denominator) > 1e-6)) denominator = 1e-6;
  const double lambda = dot(edge.position - truth.p, tx) / denominator;
  const Vec3 dp = truth.p + lambda * d - edge.position;  // the truth line, cut by the plane across the tangent
  const Vec4 error{dot(ty, dp), dot(tz, dp), -dot(tz, d), dot(ty, d)};  // t_true = t + th_z y - th_y z

  // S = H C H' with H = [y' 0; z' 0; 0 e_y'; 0 e_z'].
  std::array<std::array<double, 6>, 4> h{};
  for (int i = 0; i < 3; ++i) {
    h[0][i] = ty[i];
    h[1][i] = tz[i];
  }
  h[2][4] = h[3][5] = 1;
  Mat4 s{};
  bool finite = true;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      for (int a = 0; a < 6; ++a)
        for (int b = 0; b < 6; ++b) s[i][j] += h[i][a] * edge.covariance[6 * a + b] * h[j][b];
      if (i == j) s[i][j] += i < 2 ? truth_sigma_m * truth_sigma_m : truth_sigma_rad * truth_sigma_rad;
      finite = finite && std::isfinite(s[i][j]) && std::isfinite(error[i]);
    }
  if (!finite) return std::nullopt;
  Vec4 scale{};
  for (int i = 0; i < 4; ++i) scale[i] = std::sqrt(std::max(std::abs(s[i][i]), 1e-300));
  Mat4 normalized = s;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) normalized[i][j] /= scale[i] * scale[j];
  if (!(smallest_eigenvalue(normalized) > 1e-9)) return std::nullopt;
  return Nees{quadratic_form(s, error, 0, 4), quadratic_form(s, error, 0, 2), quadratic_form(s, error, 2, 2)};
}

}  // namespace accrete::cli
