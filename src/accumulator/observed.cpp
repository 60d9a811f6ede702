// Pipeline::step for 2D-primitives that come from elsewhere: checked, aligned, and from there on like extracted ones.
#include <cmath>

#include "accumulator/pipeline.h"
#include "extract/undistort.h"
#include "math/lanes.h"

namespace accrete {
namespace {

// Less is no measurement, more is none either; squares of both are far from the ends of float.
bool is_deviation(float sigma) { return sigma >= 1e-6F && sigma <= 1e6F; }

bool is_usable(const Primitive2d& p, const Camera& camera) {
  if (!(p.x_px >= 0 && p.x_px <= static_cast<float>(camera.width_px - 1))) return false;
  if (!(p.y_px >= 0 && p.y_px <= static_cast<float>(camera.height_px - 1))) return false;
  if (!std::isfinite(p.theta) || !std::isfinite(p.flow_px) || !std::isfinite(p.appearance.phase)) return false;
  for (const auto* side : {&p.appearance.left, &p.appearance.right})
    for (const float c : *side)
      if (!std::isfinite(c)) return false;
  return is_deviation(p.sigma_n_px) && is_deviation(p.sigma_theta) && is_deviation(p.sigma_phase) &&
         is_deviation(p.sigma_colour);
}

// Values so small that products with them would be subnormal are zeros from here on (docs/determinism.md).
void floor_tiny(Primitive2d& p) {
  for (float* v : {&p.x_px, &p.y_px, &p.theta, &p.flow_px, &p.appearance.phase}) *v = flush_tiny(*v);
  for (auto* side : {&p.appearance.left, &p.appearance.right})
    for (float& c : *side) c = flush_tiny(c);
}

Status check(std::span<const Primitive2d> primitives, const Camera& camera, std::size_t capacity) {
  if (primitives.size() > capacity) return Status::kCapacityExceeded;
  for (const Primitive2d& p : primitives)
    if (!is_usable(p, camera)) return Status::kInvalidArgument;
  return Status::kOk;
}

}  // namespace

StepReport Pipeline::step(const ObservedFrame& frame, const Motion& motion) {
  StepReport report;
  report.status = check(frame.t, frame.t, motion);
  if (report.status == Status::kOk) report.status = accrete::check(frame.left, rig_.left, capacities_.primitives2d);
  if (report.status == Status::kOk) report.status = accrete::check(frame.right, rig_.right, capacities_.primitives2d);
  if (report.status != Status::kOk) return report;
  for (int eye = 0; eye < 2; ++eye) {
    ExtractCounts& counts = eye == 0 ? report.left : report.right;
    std::size_t n = 0;
    for (Primitive2d p : eye == 0 ? frame.left : frame.right) {
      floor_tiny(p);
      if (extract::undistort(eye == 0 ? rig_.left : rig_.right, eye == 0 ? aligned_.R_a_l : aligned_.R_a_r,
                             aligned_.focal_px, p))
        w_.eye[eye].primitives[n++] = p;
      else
        ++counts.refused_distortion;
    }
    count_[eye] = n;
    counts.primitives = static_cast<std::uint32_t>(n);
    has_previous_[eye] = false;  // flow needs the previous image
  }
  proceed(frame.t, frame.t, motion, report);
  return report;
}

}  // namespace accrete
