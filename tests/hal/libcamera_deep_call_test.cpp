// A call from far down the stack.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <vector>

#include "libcamera/deep_call.h"

namespace accrete::hal::libcam {
namespace {

// In the frame of whoever asks.
[[gnu::noinline]] std::uintptr_t here() { return reinterpret_cast<std::uintptr_t>(__builtin_frame_address(0)); }

TEST(DeepCall, IsMadeFarBelowItsCallerAndTheNextOnesElsewhere) {
  const std::uintptr_t beside = here();
  std::vector<std::size_t> below;
  for (int i = 0; i < 2 * kDepths; ++i) below.push_back(beside - deep_call([] { return here(); }));
  for (std::size_t i = 0; i < below.size(); ++i) {
    EXPECT_GE(below[i], kApart_bytes);
    EXPECT_LT(below[i], kDepths * kApart_bytes + 8192);  // and no farther than it says
    for (std::size_t k = i + 1; k < i + kDepths && k < below.size(); ++k)
      EXPECT_GE(std::max(below[i], below[k]) - std::min(below[i], below[k]), kApart_bytes);
  }
}

TEST(DeepCall, GivesWhatTheCallGives) {
  int called = 0;
  deep_call([&] { ++called; });
  EXPECT_EQ(called, 1);
  EXPECT_EQ(*deep_call([] { return std::make_unique<int>(7); }), 7);
  EXPECT_EQ(&deep_call([&]() -> int& { return called; }), &called);
  EXPECT_THROW(deep_call([] { throw std::runtime_error("no"); }), std::runtime_error);
}

}  // namespace
}  // namespace accrete::hal::libcam
