#include "libcamera/mailbox.h"

#include <algorithm>
#include <chrono>

namespace accrete::hal::libcam {

void Mailbox::push(const Letter& letter) {
  {
    const std::lock_guard lock(mutex_);
    letters_.push_back(letter);
  }
  filled_.notify_one();
}

bool Mailbox::pop(std::int64_t deadline_ns, Letter& letter) {
  std::unique_lock lock(mutex_);
  // steady_clock is CLOCK_MONOTONIC here. Far deadlines would overflow inside the library.
  const std::int64_t now = std::chrono::steady_clock::now().time_since_epoch().count();
  const std::int64_t until = std::min(deadline_ns, now + std::int64_t{3'600'000'000'000});
  const bool any = filled_.wait_until(lock, std::chrono::steady_clock::time_point(std::chrono::nanoseconds(until)),
                                      [this] { return !letters_.empty(); });
  if (!any) return false;
  letter = letters_.front();
  letters_.pop_front();
  return true;
}

void Mailbox::clear() {
  const std::lock_guard lock(mutex_);
  letters_.clear();
}

}  // namespace accrete::hal::libcam
