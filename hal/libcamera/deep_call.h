// Calls into libcamera that its own thread carries out. The caller waits on a semaphore on its stack, and libcamera
// notifies it once more after letting it go (0.0.3, Semaphore::release): if the caller is quicker, into whatever lies
// on the stack by then. tests/hal/vm/late_wake_ups.cpp makes that certain. What is called from far down leaves its
// semaphore where nothing else comes soon: that makes the fault unlikely, and only libcamera can mend it.
#pragma once

#include <cstddef>
#include <utility>

namespace accrete::hal::libcam {

// A step of the filter takes 6 KiB (docs/memory.md), libcamera's and libstdc++'s own calls a few; a thread's stack has
// 128 KiB where it is small (musl).
inline constexpr std::size_t kFarDown_bytes = std::size_t{32} << 10;

// What `call()` returns or throws.
template <class Call>
[[gnu::noinline]] decltype(auto) deep_call(Call&& call) {
  volatile std::byte between[kFarDown_bytes];
  between[0] = std::byte{0};  // or there would be no array
  struct Keep {               // until the call is over: no tail call
    volatile std::byte* array;
    ~Keep() { array[kFarDown_bytes - 1] = std::byte{0}; }
  } const keep{between};
  return std::forward<Call>(call)();
}

}  // namespace accrete::hal::libcam
