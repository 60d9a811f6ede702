#include "predict/motion_noise.h"

#include <algorithm>
#include <cmath>

namespace accrete {
namespace {

// Whose square a float still holds.
float to_float(double x) { return static_cast<float>(std::clamp(x, -1e18, 1e18)); }

}  // namespace

MotionNoise motion_noise_in_map(const Transform<Map, Left>& T_m_l, const PoseCovariance& covariance) {
  // Cholesky in double; a pivot that is only the rounding of its diagonal counts as zero.
  double l[6][6] = {};
  for (std::size_t j = 0; j < 6; ++j) {
    double pivot = covariance[7 * j];
    for (std::size_t k = 0; k < j; ++k) pivot -= l[j][k] * l[j][k];
    if (!(pivot > 1e-14 * covariance[7 * j])) continue;
    l[j][j] = std::sqrt(pivot);
    for (std::size_t i = j + 1; i < 6; ++i) {
      double sum = 0.5 * (covariance[6 * i + j] + covariance[6 * j + i]);
      for (std::size_t k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
      l[i][j] = sum / l[j][j];
    }
  }
  MotionNoise out;
  const Mat3 R = to_matrix(T_m_l.rotation);
  for (std::size_t k = 0; k < 6; ++k) {
    const Vec3 translation = R * Vec3{l[0][k], l[1][k], l[2][k]};
    const Vec3 rotation = R * Vec3{l[3][k], l[4][k], l[5][k]};
    for (std::size_t i = 0; i < 3; ++i) {
      out.translation[k][i] = to_float(translation[i]);
      out.rotation[k][i] = to_float(rotation[i]);
      out.centre[i] = to_float(T_m_l.translation[i]);
    }
  }
  return out;
}

}  // namespace accrete
