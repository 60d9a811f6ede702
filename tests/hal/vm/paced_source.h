// A live source made a recording: the software cameras show picture after picture, each until it has arrived, and the
// number in the pixels gives the recording's time.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "accrete/hal/stereo_source.h"
#include "frame_number.h"
#include "live.h"
#include "orders.h"

namespace accrete::vm {

// Pictures begin 200 ms apart at least, left and right together; what is between is the emulator's own affair.
inline constexpr std::int64_t kPacedTolerance_ns = 90 * kMillisecond;

class PacedSource final : public hal::StereoSource {
 public:
  // `live` is configured; `times` are those of the recording's pictures.
  PacedSource(std::unique_ptr<hal::StereoSource> live, std::vector<Timestamp> times)
      : live_(std::move(live)), times_(std::move(times)) {}

  [[nodiscard]] std::uint64_t size() const override { return times_.size(); }
  [[nodiscard]] std::uint64_t repeated() const { return repeated_; }  // frames of pictures that were there already

 private:
  hal::Outcome do_configure() override {
    rig_ = live_->rig();
    return {};
  }
  hal::Outcome do_start() override {
    next_ = 0;
    order("show 0");
    return live_->start();
  }
  hal::Outcome do_acquire(std::int64_t /*timeout_ns*/, StereoFrame& frame) override {
    if (next_ == times_.size()) return {Status::kEndOfStream, "that was the last picture"};
    const int wanted = static_cast<int>(next_);
    order("show " + std::to_string(wanted));
    const std::int64_t end = std::chrono::steady_clock::now().time_since_epoch().count() + kLimit_ns;
    while (std::chrono::steady_clock::now().time_since_epoch().count() < end) {
      hal::Outcome outcome = live_->acquire(500 * kMillisecond, frame);
      if (outcome.status == Status::kTimeout) continue;  // lost; it is shown again
      if (!outcome.ok()) return outcome;
      if (read_number(frame.left) == FrameNumber{wanted, false} &&
          read_number(frame.right) == FrameNumber{wanted, true}) {
        frame.t_left = frame.t_right = times_[next_];
        frame.sequence = next_++;
        return {};
      }
      ++repeated_;
      live_->release();
    }
    return {Status::kTimeout, "picture " + std::to_string(wanted) + " does not arrive"};
  }
  void do_release() override { live_->release(); }
  void do_stop() override { live_->stop(); }

  std::unique_ptr<hal::StereoSource> live_;
  std::vector<Timestamp> times_;
  std::size_t next_ = 0;
  std::uint64_t repeated_ = 0;
};

}  // namespace accrete::vm
