// From libcamera's thread to the reader's: images in the order in which they were completed. At most as many letters as
// there are buffers, and one for each camera that is gone.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>

#include "camera/pairer.h"

namespace accrete::hal::libcam {

struct Letter {
  enum class What : std::uint8_t { kImage, kDamaged, kGone };
  What what = What::kImage;
  camera::Eye eye = camera::Eye::kLeft;
  int slot = -1;
  std::int64_t t_ns = 0;     // CLOCK_MONOTONIC
  bool of_exposure = false;  // t_ns is the sensor's, not the buffer's
  std::uint32_t sequence = 0;
};

class Mailbox {
 public:
  void push(const Letter& letter);
  // The next one, waiting until `deadline_ns` of CLOCK_MONOTONIC. False: none came.
  [[nodiscard]] bool pop(std::int64_t deadline_ns, Letter& letter);
  void clear();

 private:
  std::mutex mutex_;
  std::condition_variable filled_;
  std::deque<Letter> letters_;
};

}  // namespace accrete::hal::libcam
