// Two cameras, or one for both eyes, as a StereoSource: paired, converted, and looked for when they are gone.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "accrete/hal/v4l2.h"
#include "v4l2/capture.h"
#include "v4l2/exposure.h"
#include "v4l2/eyes.h"
#include "v4l2/pairer.h"

namespace accrete::hal::v4l2 {

class LiveSource final : public V4l2Source {
 public:
  LiveSource(Kernel& kernel, V4l2Options options);

  [[nodiscard]] V4l2Statistics statistics() const override;

 private:
  struct Device {
    explicit Device(Kernel& kernel) : capture(kernel) {}
    Capture capture;
    Identity identity;
  };

  // live_configure.cpp
  Outcome do_configure() override;
  Outcome check_options() const;
  Outcome read_calibration();
  Outcome configure_devices();
  Outcome negotiate_all();
  Outcome negotiate_with(const KnownFormat* known);
  [[nodiscard]] std::vector<const KnownFormat*> candidates();
  Outcome settle_size();

  // live_source.cpp
  Outcome do_start() override;
  void do_release() override;
  void do_stop() override;
  Outcome open_again(Device& device);
  Outcome start_streams();
  void close_all();
  void reset_statistics();

  // live_acquire.cpp
  Outcome do_acquire(std::int64_t timeout_ns, StereoFrame& frame) override;
  [[nodiscard]] bool next_frame(StereoFrame& frame);
  [[nodiscard]] bool next_pair(Pair& pair);
  [[nodiscard]] bool deliver(const Pair& pair, StereoFrame& frame);
  [[nodiscard]] bool warm_up(const Pair& pair);
  void number(const Pair& pair, StereoFrame& frame);
  void give_back(const Pair& pair);
  void collect(std::int64_t deadline_ns);
  void take_from(Device& device, Eye eye, short revents, std::int64_t deadline_ns);
  void lose(const std::string& why);
  Outcome reconnect(std::int64_t deadline_ns);
  [[nodiscard]] Outcome too_late(std::int64_t timeout_ns) const;
  void update_counters();

  [[nodiscard]] bool two() const { return options_.layout == V4l2Layout::kTwoDevices; }
  [[nodiscard]] std::vector<Device*> devices();
  [[nodiscard]] double period_ns() const;  // 0: unknown

  Kernel& kernel_;
  V4l2Options options_;
  Device left_, right_;  // one device: left_
  Size eye_;
  ExposureLock exposure_;
  Eyes eyes_;
  Pairer pairer_;
  std::vector<Waiting> singles_;  // one device: images that wait for their turn
  std::optional<Pair> held_;      // its images lie in the drivers' buffers and are lent

  V4l2Statistics statistics_;  // without the devices' own
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

}  // namespace accrete::hal::v4l2
