// Frames between whoever captures and whoever writes: a fixed number of slots, whose memory is used again.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <vector>

#include "accrete/status.h"
#include "accrete/stereo_frame.h"

namespace accrete::hal {

struct QueuedFrame {
  StereoFrame frame;  // its views show `left` and `right`
  std::vector<std::uint8_t> left, right;
  std::chrono::steady_clock::time_point taken;
};

class FrameQueue {
 public:
  explicit FrameQueue(std::size_t buffer_bytes) : buffer_bytes_(buffer_bytes) {}

  // Copies the frame into a free slot. kCapacityExceeded: there is none, and `wait` is false. kUnavailable: closed.
  Status put(const StereoFrame& frame, bool wait);
  // The oldest frame, null at the end; waits. It stays in its slot until done() is called.
  const QueuedFrame* front();
  void done();
  // No more frames; what waits is still handed out unless `drop`.
  void close(bool drop);

  [[nodiscard]] std::size_t capacity() const;
  [[nodiscard]] std::size_t most_waiting() const;

 private:
  const std::size_t buffer_bytes_;
  mutable std::mutex mutex_;
  std::condition_variable filled_, freed_;
  std::deque<QueuedFrame> waiting_;
  std::vector<QueuedFrame> free_;
  std::size_t capacity_ = 0;  // known from the first frame on
  std::size_t in_use_ = 0;    // slots that are filled or being filled
  std::size_t most_ = 0;
  bool closed_ = false;
};

}  // namespace accrete::hal
