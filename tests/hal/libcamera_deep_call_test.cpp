// A call from far down the stack.
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <stdexcept>

#include "libcamera/deep_call.h"

namespace accrete::hal::libcam {
namespace {

// In the frame of whoever asks.
[[gnu::noinline]] std::uintptr_t here() { return reinterpret_cast<std::uintptr_t>(__builtin_frame_address(0)); }

TEST(DeepCall, IsMadeFarBelowItsCaller) {
  const std::uintptr_t beside = here();
  const std::uintptr_t below = deep_call([] { return here(); });
  EXPECT_GE(beside - below, kFarDown_bytes);
  EXPECT_LT(beside - below, kFarDown_bytes + 4096);  // and no farther than it says
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
