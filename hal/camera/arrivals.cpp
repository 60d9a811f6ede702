#include "camera/arrivals.h"

#include "camera/pairer.h"

namespace accrete::hal::camera {

// The difference is signed: a number that comes twice (seen with vivid in an emulator) or late is no gap of 2^32, and a
// wrap from 2^32 - 1 to 0 is none at all.
std::uint64_t Arrivals::count(std::uint32_t driver_sequence) {
  std::uint64_t missing = 0;
  if (last_driver_sequence_) {
    const auto step = static_cast<std::int32_t>(driver_sequence - *last_driver_sequence_);
    if (step > 1) missing = static_cast<std::uint64_t>(step) - 1;
    sequence_ += 1 + missing;
  }
  last_driver_sequence_ = driver_sequence;
  return missing;
}

bool Arrivals::later(std::int64_t t_ns) {
  constexpr int kMaxBackwards = 8;
  if (last_t_ns_ && time_difference(t_ns, *last_t_ns_) <= 0 && ++backwards_ < kMaxBackwards) return false;
  backwards_ = 0;
  last_t_ns_ = t_ns;
  return true;
}

}  // namespace accrete::hal::camera
