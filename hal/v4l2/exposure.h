// Exposure, gain and white balance: automatic at first, then fixed and equal in both cameras. Colours on both sides of
// an edge are filtered over time, and matched between the eyes; neither bears a camera that changes its mind.
#pragma once

#include <cstdint>
#include <vector>

#include "accrete/hal/v4l2.h"
#include "v4l2/kernel.h"

namespace accrete::hal::v4l2 {

class ExposureLock {
 public:
  explicit ExposureLock(Kernel& kernel) : kernel_(kernel) {}

  // Lets a device find its own exposure, without lengthening the frame for it. What it cannot, it cannot.
  void make_automatic(int fd);
  // Reads what the left one has found, and fixes it in both. `right_fd` < 0: there is one device.
  void lock(int left_fd, LiveDeviceStatistics& left, int right_fd, LiveDeviceStatistics& right);
  // The same values again, in a device that came back.
  void apply(int fd, LiveDeviceStatistics& device);
  [[nodiscard]] bool locked() const { return locked_; }
  void forget();

 private:
  struct Value {
    const char* name;
    std::uint32_t id;
    std::int32_t value;
  };

  Kernel& kernel_;
  std::vector<Value> values_;
  bool locked_ = false;
};

}  // namespace accrete::hal::v4l2
