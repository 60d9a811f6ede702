// Times of the stages of one step: the core reads no clock, the program lends it one.
#pragma once

#include <array>
#include <chrono>

#include "accrete/step_report.h"

namespace accrete::cli {

class StageClock {
 public:
  using Clock = std::chrono::steady_clock;

  // Milliseconds spent in each stage since reset(), in the order of Stage.
  [[nodiscard]] const std::array<double, kStageCount>& times_ms() const { return times_ms_; }
  void reset() { times_ms_.fill(0); }
  [[nodiscard]] StageObserver observer() { return {&StageClock::notify, this}; }

  [[nodiscard]] static double milliseconds(Clock::duration d) {
    return std::chrono::duration<double, std::milli>(d).count();
  }

 private:
  static void notify(void* context, Stage stage, bool begins) {
    auto& self = *static_cast<StageClock*>(context);
    const auto i = static_cast<std::size_t>(stage);
    if (begins)
      self.begin_[i] = Clock::now();
    else
      self.times_ms_[i] += milliseconds(Clock::now() - self.begin_[i]);
  }

  std::array<double, kStageCount> times_ms_{};
  std::array<Clock::time_point, kStageCount> begin_{};
};

}  // namespace accrete::cli
