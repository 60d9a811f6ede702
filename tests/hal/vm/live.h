// Frames of a live source for the tests: within a time, and with what they show.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <memory>

#include "accrete/hal/libcamera.h"
#include "accrete/hal/v4l2.h"
#include "frame_number.h"

namespace accrete::vm {

inline constexpr std::int64_t kMillisecond = 1'000'000;
// The emulator may take its time; what never comes takes as long as this.
inline constexpr std::int64_t kLimit_ns = 10'000 * kMillisecond;

enum class Library { kV4l2, kLibcamera };

inline hal::Outcome open_cameras(Library library, const hal::LiveOptions& options,
                                 std::unique_ptr<hal::LiveSource>& source) {
  return library == Library::kV4l2 ? hal::open_v4l2(options, source) : hal::open_libcamera({options, {}}, source);
}

inline std::unique_ptr<hal::LiveSource> opened(const hal::LiveOptions& options, Library library = Library::kV4l2) {
  std::unique_ptr<hal::LiveSource> source;
  const hal::Outcome outcome = open_cameras(library, options, source);
  EXPECT_TRUE(outcome.ok()) << outcome.message;
  return source;
}

// acquire() that may not take much longer than it says. The slack is for an emulator on a machine with other work.
inline hal::Outcome acquire(hal::StereoSource& source, std::int64_t timeout_ns, StereoFrame& frame) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  hal::Outcome outcome = source.acquire(timeout_ns, frame);
  EXPECT_LT((Clock::now() - begin).count(), timeout_ns + 3000 * kMillisecond) << outcome.message;
  return outcome;
}

// Takes `count` frames; false and a failure when they do not come. Timeouts on the way are no failure, the end is.
inline bool take(hal::StereoSource& source, int count, std::int64_t limit_ns = kLimit_ns) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::nanoseconds(limit_ns);
  hal::Outcome last;
  for (StereoFrame frame; count > 0 && std::chrono::steady_clock::now() < end;) {
    last = acquire(source, 500 * kMillisecond, frame);
    if (!last.ok() && last.status != Status::kTimeout) break;
    if (!last.ok()) continue;
    --count;
    source.release();
  }
  EXPECT_EQ(count, 0) << "frames did not come: " << last.message;
  return count == 0;
}

// Calls acquire() until it ends otherwise than with a frame or, unless that is looked for, a timeout.
inline hal::Outcome take_until(hal::StereoSource& source, Status wanted, std::int64_t limit_ns = kLimit_ns) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::nanoseconds(limit_ns);
  hal::Outcome last;
  StereoFrame frame;
  while (std::chrono::steady_clock::now() < end) {
    last = acquire(source, 200 * kMillisecond, frame);
    if (last.ok()) source.release();
    if (last.status == wanted) return last;
  }
  ADD_FAILURE() << "did not end with " << to_string(wanted) << " but: " << last.message;
  return last;
}

}  // namespace accrete::vm
