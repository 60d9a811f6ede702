// Threads that open and close at once never have two of what may be there once.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "accrete/hal/libcamera.h"
#include "libcamera/one_at_a_time.h"

namespace accrete::hal::libcam {
namespace {

struct Single {
  static inline std::atomic<int> alive = 0, most = 0, made = 0;
  Single() {
    ++made;
    const int now = ++alive;
    if (now > most) most = now;
  }
  ~Single() {
    std::this_thread::sleep_for(std::chrono::microseconds(100));  // as ending a camera manager takes its time
    --alive;
  }
};

std::unique_ptr<Single> make() { return std::make_unique<Single>(); }

TEST(OneAtATime, IsSharedAndEndsWithItsLastUser) {
  OneAtATime<Single> one;
  const int made = Single::made;
  auto first = one.get(make);
  const auto second = one.get(make);
  EXPECT_EQ(first.get(), second.get());
  auto copy = first;
  first.reset();
  EXPECT_EQ(Single::alive, 1);
  copy.reset();
  EXPECT_EQ(Single::alive, 1);
  EXPECT_EQ(Single::made, made + 1);
}

TEST(OneAtATime, NothingIsKeptOfWhatCannotBeMade) {
  OneAtATime<Single> one;
  EXPECT_EQ(one.get([] { return std::unique_ptr<Single>(); }), nullptr);
  EXPECT_NE(one.get(make), nullptr);
  EXPECT_EQ(Single::alive, 0);
}

TEST(OneAtATime, NeverTwoWhateverThreadsDo) {
  OneAtATime<Single> one;
  Single::most = 0;
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&one] {
      for (int i = 0; i < 300; ++i) {
        auto mine = one.get(make);
        if (i % 3 == 0) std::this_thread::yield();
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(Single::most, 1);
  EXPECT_EQ(Single::alive, 0);
}

// With libcamera itself, which ends a process that has two managers. The cameras of this machine, if any, do not
// matter.
TEST(OneAtATime, ThreadsMayListCamerasAtOnce) {
  std::vector<std::thread> threads;
  for (int t = 0; t < 2; ++t)
    threads.emplace_back([] {
      for (int i = 0; i < 20; ++i) (void)list_libcamera_cameras();
    });
  for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace accrete::hal::libcam
