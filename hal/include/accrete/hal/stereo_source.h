// Where stereo frames come from. The public, non-virtual layer checks the caller once; a back-end implements the three
// small private hooks.
#pragma once

#include <cstdint>
#include <string>

#include "accrete/camera.h"
#include "accrete/stereo_frame.h"

namespace accrete::hal {

// A failure with its sentence: what, where, what to do. The HAL may allocate; the core may not.
struct Outcome {
  Status status = Status::kOk;
  std::string message;

  [[nodiscard]] bool ok() const { return status == Status::kOk; }  // then the message is empty
};

struct SourceCounters {
  std::uint64_t delivered = 0;
  std::uint64_t dropped = 0;   // frames known to be lost or unreadable
  std::uint64_t unpaired = 0;  // an image without its partner
};

class StereoSource {
 public:
  virtual ~StereoSource() = default;
  StereoSource(const StereoSource&) = delete;
  StereoSource& operator=(const StereoSource&) = delete;

  enum class SourceState : std::uint8_t { kClosed, kConfigured, kStreaming };

  // closed -> configured. Afterwards rig() is known where the source has a calibration.
  Outcome configure();
  // configured -> streaming.
  Outcome start();
  // Lends the next frame; valid until release() or stop(). kEndOfStream after the last one; kTimeout; kDataLoss for one
  // damaged frame (the next call goes on with the frame after it); kUnavailable when not streaming or a frame is out.
  Outcome acquire(std::int64_t timeout_ns, StereoFrame& frame);
  void release();
  void stop();  // streaming -> configured

  [[nodiscard]] SourceState state() const { return state_; }
  [[nodiscard]] const StereoRig& rig() const { return rig_; }
  [[nodiscard]] const SourceCounters& counters() const { return counters_; }
  // Number of frames when known beforehand, otherwise 0.
  [[nodiscard]] virtual std::uint64_t size() const { return 0; }

 protected:
  StereoSource() = default;
  StereoRig rig_;
  SourceCounters counters_;

 private:
  virtual Outcome do_configure() = 0;
  virtual Outcome do_start() = 0;
  virtual Outcome do_acquire(std::int64_t timeout_ns, StereoFrame& frame) = 0;
  virtual void do_release() {}
  virtual void do_stop() {}

  SourceState state_ = SourceState::kClosed;
  bool lent_ = false;
};

}  // namespace accrete::hal
