// How far a run is: one line that is drawn over on a terminal, a line now and then elsewhere.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>

#include "cli/run/record.h"

namespace accrete::cli {

class Progress {
 public:
  // `total`: frames in all, 0 when unknown. Nothing is printed when `quiet`.
  Progress(std::FILE* stream, std::uint64_t total, bool quiet);

  void update(const FrameRecord& frame, const RunRecord& run);
  // A line of its own in the middle of a run.
  void say(const std::string& line);
  // Ends the line that is drawn over.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  std::FILE* stream_;
  std::uint64_t total_;
  bool quiet_, terminal_, drawn_ = false;
  Clock::time_point begin_ = Clock::now(), last_{};
  std::uint64_t next_plain_ = 0;
  StepReport levels_;  // of the last frame that was used
};

}  // namespace accrete::cli
