// A motion source that interpolates a list of poses.
#pragma once

#include <string>
#include <vector>

#include "accrete/hal/motion_source.h"
#include "motion/pose_table.h"

namespace accrete::hal {

struct PoseMotionSettings {
  MotionMode mode = MotionMode::kObjectMoves;
  PoseError error = PoseError::kAbsolute;
  PoseCovariance covariance{};
  bool covariance_is_default = true;
  std::int64_t max_gap_ns = 50'000'000;
};

class PoseMotion final : public MotionSource {
 public:
  // Stamps written with three decimals are off by half a millisecond.
  static constexpr std::int64_t kSameMoment_ns = 500'000;

  // `poses` are T_left_object (the object moves) or T_world_left (the cameras move), times strictly increasing;
  // `name` stands in messages.
  PoseMotion(std::vector<StampedPose> poses, const PoseMotionSettings& settings, std::string name);

  // Between two poses at most max_gap_ns apart: interpolated, the rotation along the arc, the position along the
  // straight line. Otherwise the pose within kSameMoment_ns. Otherwise kNotFound; nothing is extrapolated.
  Outcome at(Timestamp t, Motion& motion) override;

 private:
  void fill(Timestamp t, const Quaternion& rotation, const Vec3& translation, Motion& motion) const;

  std::vector<StampedPose> poses_;
  PoseMotionSettings settings_;
  std::string name_;
};

}  // namespace accrete::hal
