// Numbers and times of one device's images, as its driver gives them: continued beyond 32 bits, gaps counted, images
// that repeat a time refused.
#pragma once

#include <cstdint>
#include <optional>

namespace accrete::hal::camera {

class Arrivals {
 public:
  // Images that are missing before this one.
  [[nodiscard]] std::uint64_t count(std::uint32_t driver_sequence);
  // Of the last one that was counted, from 0.
  [[nodiscard]] std::uint64_t sequence() const { return sequence_; }
  // False for an image that is no later than the one before: of no use. A clock that was set back for good is followed
  // after a few images.
  [[nodiscard]] bool later(std::int64_t t_ns);

 private:
  std::optional<std::uint32_t> last_driver_sequence_;
  std::uint64_t sequence_ = 0;
  std::optional<std::int64_t> last_t_ns_;
  int backwards_ = 0;  // in a row
};

}  // namespace accrete::hal::camera
