#include "motion/pose_row.h"

#include <array>
#include <cmath>
#include <span>

#include "calibration/calibration.h"
#include "text/sentence.h"

namespace accrete::hal {
namespace {

Outcome numbers(const std::string& source, const Row& row, std::size_t first, std::span<double> out) {
  for (std::size_t i = 0; i < out.size(); ++i)
    if (!parse(row.fields[first + i], out[i]) || !std::isfinite(out[i]))
      return {Status::kInvalidArgument, at_line(source, row.line) + ": column " + std::to_string(first + i + 1) +
                                            " is " + in_quotes(row.fields[first + i]) +
                                            ", not a finite number: remove the line, or correct it"};
  return {};
}

Outcome quaternion(const std::string& source, const Row& row, const Quaternion& raw, StampedPose& pose) {
  const auto q = normalized(raw);
  if (!q.ok()) {
    const double n = std::sqrt(raw.x * raw.x + raw.y * raw.y + raw.z * raw.z + raw.w * raw.w);
    return {Status::kInvalidArgument, at_line(source, row.line) + ": the quaternion has the length " + number(n, 3) +
                                          " and is no rotation: remove the line, or correct it"};
  }
  pose.rotation = q.value();
  return {};
}

// Zero is a covariance: exactly known.
Outcome covariance(const std::string& source, const Row& row, StampedPose& pose) {
  std::array<double, 21> v{};
  if (Outcome o = numbers(source, row, 8, v); !o.ok()) return o;
  Motion probe;
  std::size_t k = 0;
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = i; j < 6; ++j) probe.covariance[6 * i + j] = probe.covariance[6 * j + i] = v[k++];
  if (validate(probe) != Status::kOk)
    return {Status::kInvalidArgument, at_line(source, row.line) +
                                          ": the covariance is not positive definite: write the upper triangle, row "
                                          "after row, position before rotation, m and rad; or 21 zeros"};
  pose.covariance = std::make_shared<const PoseCovariance>(probe.covariance);
  return {};
}

}  // namespace

Outcome read_pose_row(const std::string& source, const Row& row, PoseFormat format, StampedPose& pose) {
  pose.line = row.line;
  if (format == PoseFormat::kKitti) {
    std::array<double, 12> m{};
    if (Outcome o = numbers(source, row, 0, m); !o.ok()) return o;
    pose.translation = {m[3], m[7], m[11]};
    const Mat3 r{m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]};
    return check_rotation(r, at_line(source, row.line) + ": the 3 x 3 part", pose.rotation);
  }
  std::array<double, 7> v{};
  if (Outcome o = numbers(source, row, 1, v); !o.ok()) return o;
  pose.translation = {v[0], v[1], v[2]};
  if (row.field_count == kCovarianceColumns)
    if (Outcome o = covariance(source, row, pose); !o.ok()) return o;
  if (format == PoseFormat::kTum) return quaternion(source, row, {v[3], v[4], v[5], v[6]}, pose);
  if (Outcome o = quaternion(source, row, {v[4], v[5], v[6], v[3]}, pose); !o.ok()) return o;
  if (!parse(row.fields[0], pose.t.ns) || !is_stamp(pose.t.ns))
    return {Status::kInvalidArgument, at_line(source, row.line) + ": the time " + in_quotes(row.fields[0]) +
                                          " is no integer: EuRoC has nanoseconds; write TUM lines for seconds"};
  return {};
}

}  // namespace accrete::hal
