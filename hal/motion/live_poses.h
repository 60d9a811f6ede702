// The poses of a live stream that are held: parsed, in order of time, bounded, counted. No thread, no clock, no file.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "accrete/hal/live_motion.h"
#include "motion/pose_motion.h"

namespace accrete::hal {

class LivePoses {
 public:
  LivePoses(const LiveMotionOptions& options, std::string name);

  // One line, from whoever sends it. Comments and blank lines are nothing.
  void line(std::string_view text);
  void interrupted() { ++counters_.interrupted; }

  // Whether waiting might help: no pose at or after `t` is there yet.
  [[nodiscard]] bool may_come(Timestamp t) const { return poses_.empty() || poses_.back().t < t; }
  // The motion at `t` from what is there now; counted.
  Outcome at(Timestamp t, Motion& motion);

  [[nodiscard]] const LiveMotionCounters& counters() const { return counters_; }
  [[nodiscard]] std::size_t held() const { return poses_.size(); }

 private:
  [[nodiscard]] bool parse_line(std::string_view text, StampedPose& pose);
  void insert(StampedPose pose);

  LiveMotionOptions options_;
  PoseMotionSettings settings_;
  std::string name_;
  std::size_t columns_ = 0;         // of the first line that was understood: the others have as many
  std::vector<StampedPose> poses_;  // up to twice the capacity, then the older half goes
  bool gave_up_ = false;
  Timestamp given_up_;  // the latest frame without a pose
  LiveMotionCounters counters_;
};

}  // namespace accrete::hal
