// What happened in a run, frame by frame: the source of the summary, the messages and the exit status.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "accrete/hal/live_source.h"
#include "accrete/step_report.h"

namespace accrete::cli {

enum class FrameFate : std::uint8_t {
  kUsed,
  kUnreadable,  // an image is missing, damaged, or of another size
  kNoPose,      // no pose near enough in time
  kRefused,     // the accumulator refused frame or motion
  kHeldOut,     // kept aside on purpose, for evaluation
};

[[nodiscard]] const char* to_string(FrameFate fate);

struct FrameRecord {
  std::uint64_t number = 0;  // in the recording
  std::int64_t t_ns = 0;
  FrameFate fate = FrameFate::kUsed;
  StepReport report;  // of used frames
  std::array<double, kStageCount> stage_ms{};
  double step_ms = 0;
  double read_ms = 0;
};

struct RunRecord {
  std::vector<FrameRecord> frames;
  std::vector<std::uint64_t> used;  // recording's number of each frame that the accumulator counted
  std::vector<std::string> warnings;
  std::optional<hal::LiveStatistics> cameras;  // live ones: losses, skew, clocks
  int threads = 1;                             // of a step
  std::uint64_t recording_frames = 0;          // in all, when known, otherwise 0
  bool resumed = false;  // frames are counted from the model's beginning, not by the recording's numbers
  bool interrupted = false;
  bool motion_covariance_is_default = false;

  [[nodiscard]] std::size_t count(FrameFate fate) const;
  // Frames that should have been used and were not.
  [[nodiscard]] std::size_t lost() const {
    return count(FrameFate::kUnreadable) + count(FrameFate::kNoPose) + count(FrameFate::kRefused);
  }
};

}  // namespace accrete::cli
