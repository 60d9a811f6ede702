// Two cameras by libcamera, or one for both eyes.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "camera/arrivals.h"
#include "camera/paired_source.h"
#include "libcamera/cameras.h"

namespace accrete::hal::libcam {

class Source final : public camera::PairedSource {
 public:
  Source(std::unique_ptr<Cameras> cameras, LibcameraOptions options);
  ~Source() override { close_all(); }

 private:
  using Eye = camera::Eye;
  struct Side {
    std::unique_ptr<Device> device;  // null: closed
    std::string id, model;
    Negotiated negotiated;
    camera::Arrivals arrivals;
    LiveDeviceStatistics statistics;
  };

  Outcome configure_devices() override;
  [[nodiscard]] camera::Size negotiated_size(Eye eye) const override { return at(eye).negotiated.size; }
  Outcome start_streams() override;
  void stop_streams() override;
  void close_all() override;
  void collect(std::int64_t deadline_ns) override;
  void give_back(Eye eye, int slot) override;
  [[nodiscard]] camera::RawImage raw(Eye eye, int slot) const override { return at(eye).device->raw(slot); }
  void lock_exposure() override;
  void forget_exposure() override { locked_.clear(); }
  [[nodiscard]] LiveDeviceStatistics& device(Eye eye) override { return at(eye).statistics; }
  [[nodiscard]] const LiveDeviceStatistics& device(Eye eye) const override { return at(eye).statistics; }
  [[nodiscard]] std::string who(Eye eye) const override;
  [[nodiscard]] int fewest_buffers() const override;
  [[nodiscard]] double rate_hz(Eye eye) const override { return at(eye).statistics.rate_hz; }
  [[nodiscard]] std::int64_t now_ns() const override;
  void sleep_until(std::int64_t t_ns) override;

  Outcome check_format() const;
  Outcome choose_cameras();
  Outcome open_and_configure(const KnownFormat& format);
  [[nodiscard]] std::vector<const KnownFormat*> candidates() const;
  [[nodiscard]] std::vector<LibcameraControl> at_start(const Side& side) const;
  void take(const Letter& letter);
  [[nodiscard]] Side& at(Eye eye) { return eye == Eye::kLeft ? left_ : right_; }
  [[nodiscard]] const Side& at(Eye eye) const { return eye == Eye::kLeft ? left_ : right_; }

  std::unique_ptr<Cameras> cameras_;
  std::vector<LibcameraControl> controls_;  // the user's
  std::vector<LibcameraControl> locked_;    // empty: nothing is
  Mailbox mailbox_;                         // outlives the devices that write to it
  Side left_, right_;                       // one device: left_
};

// The number, id or model of a camera among `cameras`. kNotFound, kInvalidArgument (a model that several have).
[[nodiscard]] Outcome find_camera(const std::vector<LibcameraCamera>& cameras, const std::string& name,
                                  LibcameraCamera& found);

}  // namespace accrete::hal::libcam
