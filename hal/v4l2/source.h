// Two cameras by V4L2, or one for both eyes.
#pragma once

#include <vector>

#include "camera/paired_source.h"
#include "v4l2/capture.h"
#include "v4l2/exposure.h"

namespace accrete::hal::v4l2 {

using camera::Eye, camera::Size;

class Source final : public camera::PairedSource {
 public:
  Source(Kernel& kernel, LiveOptions options);

 private:
  struct Device {
    explicit Device(Kernel& kernel) : capture(kernel) {}
    Capture capture;
    Identity identity;
  };

  // configure.cpp
  Outcome configure_devices() override;
  Outcome check_format() const;
  Outcome negotiate_all();
  Outcome negotiate_with(const KnownFormat* known);
  [[nodiscard]] std::vector<const KnownFormat*> candidates();

  // source.cpp
  [[nodiscard]] Size negotiated_size(Eye eye) const override;
  Outcome start_streams() override;
  void stop_streams() override;
  void close_all() override;
  void collect(std::int64_t deadline_ns) override;
  void give_back(Eye eye, int slot) override { at(eye).capture.give_back(slot); }
  [[nodiscard]] RawImage raw(Eye eye, int slot) const override { return at(eye).capture.raw(slot); }
  void lock_exposure() override;
  void forget_exposure() override { exposure_.forget(); }
  [[nodiscard]] LiveDeviceStatistics& device(Eye eye) override { return at(eye).capture.statistics; }
  [[nodiscard]] const LiveDeviceStatistics& device(Eye eye) const override { return at(eye).capture.statistics; }
  [[nodiscard]] std::string who(Eye eye) const override { return at(eye).capture.who(); }
  [[nodiscard]] int fewest_buffers() const override;
  [[nodiscard]] double rate_hz(Eye eye) const override { return at(eye).capture.format().rate_hz; }
  [[nodiscard]] std::int64_t now_ns() const override { return kernel_.now_ns(); }
  void sleep_until(std::int64_t t_ns) override { wait(kernel_, nullptr, 0, t_ns); }

  Outcome open_again(Device& device);
  void take_from(Eye eye, short revents, std::int64_t deadline_ns);
  [[nodiscard]] std::vector<Device*> devices();
  [[nodiscard]] Device& at(Eye eye) { return eye == Eye::kLeft ? left_ : right_; }
  [[nodiscard]] const Device& at(Eye eye) const { return eye == Eye::kLeft ? left_ : right_; }

  Kernel& kernel_;
  Device left_, right_;  // one device: left_
  ExposureLock exposure_;
};

}  // namespace accrete::hal::v4l2
