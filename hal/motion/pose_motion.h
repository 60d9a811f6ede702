// A motion source that interpolates a list of poses.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "accrete/hal/motion_source.h"
#include "motion/pose_table.h"

namespace accrete::hal {

struct PoseMotionSettings {
  MotionMode mode = MotionMode::kObjectMoves;
  PoseError error = PoseError::kAbsolute;
  PoseCovariance covariance{};  // of poses that state none
  bool covariance_is_default = true;
  std::int64_t max_gap_ns = 50'000'000;
};

// Stamps written with three decimals are off by half a millisecond.
inline constexpr std::int64_t kSameMoment_ns = 500'000;

// The motion at `t` from poses whose times strictly increase: T_left_object (the object moves) or T_world_left (the
// cameras move). Between two poses at most max_gap_ns apart: interpolated, the rotation along the arc, position and
// covariance along the straight line. Otherwise the pose within kSameMoment_ns. Otherwise kNotFound; nothing is
// extrapolated. `name` stands in the message.
Outcome interpolate(std::span<const StampedPose> poses, const PoseMotionSettings& settings, const std::string& name,
                    Timestamp t, Motion& motion);

// A list that is complete.
class PoseMotion final : public MotionSource {
 public:
  PoseMotion(std::vector<StampedPose> poses, const PoseMotionSettings& settings, std::string name);

  Outcome at(Timestamp t, Motion& motion) override { return interpolate(poses_, settings_, name_, t, motion); }

 private:
  std::vector<StampedPose> poses_;
  PoseMotionSettings settings_;
  std::string name_;
};

}  // namespace accrete::hal
