// What live cameras have in common, whoever delivers their images: options, warming up, pairing, conversion, numbers
// and statistics, and the search for a camera that is gone. A back-end opens devices, and brings images.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "accrete/hal/live_source.h"
#include "camera/eyes.h"
#include "camera/pairer.h"

namespace accrete::hal::camera {

class PairedSource : public LiveSource {
 public:
  [[nodiscard]] LiveStatistics statistics() const override;

 protected:
  explicit PairedSource(LiveOptions options);

  // ---- The back-end's part. One device for both eyes is the left one.
  // Opens the devices and agrees on a format for wanted_size(); settle_size() follows. On failure close_all() is
  // called.
  virtual Outcome configure_devices() = 0;
  // The size of the device's images, negotiated.
  [[nodiscard]] virtual Size negotiated_size(Eye eye) const = 0;
  // Opens again what is closed, and starts. All or nothing: after a failure everything is closed.
  virtual Outcome start_streams() = 0;
  virtual void stop_streams() = 0;  // devices stay open; whatever a frame lent is gone
  virtual void close_all() = 0;
  // Waits until `deadline_ns` at most for what happens next: arrived(), lose(), or nothing.
  virtual void collect(std::int64_t deadline_ns) = 0;
  virtual void give_back(Eye eye, int slot) = 0;
  [[nodiscard]] virtual RawImage raw(Eye eye, int slot) const = 0;
  // Exposure, gain and white balance stay from now on as the left camera has found them, until forget_exposure().
  virtual void lock_exposure() = 0;
  virtual void forget_exposure() = 0;
  [[nodiscard]] virtual LiveDeviceStatistics& device(Eye eye) = 0;
  [[nodiscard]] virtual const LiveDeviceStatistics& device(Eye eye) const = 0;
  // "/dev/video0 (card)", for a sentence
  [[nodiscard]] virtual std::string who(Eye eye) const = 0;
  [[nodiscard]] virtual int fewest_buffers() const = 0;     // of the devices
  [[nodiscard]] virtual double rate_hz(Eye eye) const = 0;  // negotiated, 0: unknown
  [[nodiscard]] virtual std::int64_t now_ns() const = 0;    // CLOCK_MONOTONIC
  virtual void sleep_until(std::int64_t t_ns) = 0;          // a signal may end it sooner

  // ---- For the back-end.
  [[nodiscard]] bool two() const { return options_.layout == StereoLayout::kTwoDevices; }
  // Of one eye; 0: free.
  [[nodiscard]] Size wanted_size() const { return eye_; }
  [[nodiscard]] const LiveOptions& options() const { return options_; }
  [[nodiscard]] std::int64_t period_ns() const;  // 0: unknown
  void arrived(Eye eye, const Waiting& image);
  // A camera is gone: everything is torn down, on both sides.
  void lose(const std::string& why);
  void interrupted() { ++interruptions_; }
  [[nodiscard]] bool reconnecting() const { return statistics_.state == LiveState::kReconnecting; }

 private:
  static constexpr int kMaxInterruptions = 100;  // signals in a row that end an acquire()

  // paired_source.cpp
  Outcome do_configure() final;
  Outcome settle_size();
  Outcome do_start() final;
  void do_release() final;
  void do_stop() final;
  void reset_statistics();
  void streams_started();
  Outcome reconnect(std::int64_t deadline_ns);

  // paired_acquire.cpp
  Outcome do_acquire(std::int64_t timeout_ns, StereoFrame& frame) final;
  [[nodiscard]] bool next_frame(StereoFrame& frame);
  [[nodiscard]] bool next_pair(Pair& pair);
  [[nodiscard]] bool deliver(const Pair& pair, StereoFrame& frame);
  [[nodiscard]] bool warm_up();
  void number(const Pair& pair, StereoFrame& frame);
  void give_back(const Pair& pair);
  [[nodiscard]] Outcome too_late(std::int64_t timeout_ns) const;
  void update_counters();

  LiveOptions options_;
  Size eye_;
  Eyes eyes_;
  Pairer pairer_;
  std::vector<Waiting> singles_;  // one device: images that wait for their turn
  std::optional<Pair> held_;      // its images lie in the devices' buffers and are lent

  LiveStatistics statistics_;  // without the devices' own
  double skew_sum_ns_ = 0;
  int interruptions_ = 0;                 // in a row
  std::uint64_t arrived_before_[2] = {};  // at the beginning of this acquire()

  bool outage_ = false;  // lost, and no image since
  std::int64_t lost_at_ns_ = 0, next_try_ns_ = 0;
  std::string last_failure_;
  bool gap_ = false;                   // the next pair is the first after a loss
  std::optional<std::uint64_t> base_;  // what is added to the driver's numbers
  std::uint64_t last_number_ = 0;
  std::int64_t last_t_ns_ = 0;
};

}  // namespace accrete::hal::camera
