#include "accrete/motion.h"

namespace accrete {
namespace {

constexpr int kN = 6;
// Rounding of a covariance that was computed in double and written with some ten digits.
constexpr double kTolerance = 1e-9;

// The correlations have no units, so that one tolerance fits metres and radians. False when `c` cannot be a covariance.
bool to_correlation(const PoseCovariance& c, PoseCovariance& r) {
  std::array<double, kN> sigma{};
  for (int i = 0; i < kN; ++i) {
    if (!(c[7 * i] > 0)) return false;
    sigma[i] = std::sqrt(c[7 * i]);
  }
  for (int i = 0; i < kN; ++i)
    for (int j = 0; j < kN; ++j) r[kN * i + j] = c[kN * i + j] / sigma[i] / sigma[j];
  return true;
}

bool symmetric(const PoseCovariance& r) {
  for (int i = 0; i < kN; ++i)
    for (int j = 0; j < i; ++j)
      if (!(std::abs(r[kN * i + j] - r[kN * j + i]) <= kTolerance)) return false;
  return true;
}

// Definite beyond rounding: without `kTolerance` of the diagonal there still is a Cholesky factor.
bool positive_definite(const PoseCovariance& r) {
  PoseCovariance l{};
  for (int j = 0; j < kN; ++j) {
    for (int i = j; i < kN; ++i) {
      double s = r[kN * i + j] - (i == j ? kTolerance : 0.0);
      for (int k = 0; k < j; ++k) s -= l[kN * i + k] * l[kN * j + k];
      if (i == j && !(s > 0)) return false;
      l[kN * i + j] = i == j ? std::sqrt(s) : s / l[kN * j + j];
    }
  }
  return true;
}

}  // namespace

Status validate(const Motion& motion) {
  const Quaternion& q = motion.T_l_m.rotation;
  const double length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (!(std::abs(length - 1) <= 1e-6)) return Status::kInvalidArgument;
  for (const double t : motion.T_l_m.translation)
    if (!std::isfinite(t)) return Status::kInvalidArgument;
  for (const double c : motion.covariance)
    if (!std::isfinite(c)) return Status::kInvalidArgument;
  if (motion.covariance == PoseCovariance{}) return Status::kOk;  // exactly known
  PoseCovariance correlation{};
  if (!to_correlation(motion.covariance, correlation) || !symmetric(correlation) || !positive_definite(correlation))
    return Status::kInvalidArgument;
  return Status::kOk;
}

}  // namespace accrete
