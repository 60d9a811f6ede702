// Calls into libcamera that its own thread carries out. The caller waits on a semaphore on its stack, and libcamera
// notifies it once more after letting it go (0.0.3, Semaphore::release): if the caller is quicker, into whatever lies
// on the stack by then. tests/hal/vm/late_wake_ups.cpp provokes that. What is called from far down leaves its semaphore
// where nothing else comes soon; the next calls go to other depths, and libcamera's thread, which has to carry them
// out, is past that notification before they return. Only libcamera can mend it for good.
#pragma once

#include <cstddef>

namespace accrete::hal::libcam {

// Between two depths. A step of the filter takes 6 KiB (docs/memory.md), libcamera's and libstdc++'s own calls a few; a
// thread's stack has 128 KiB where it is small (musl).
inline constexpr std::size_t kApart_bytes = std::size_t{16} << 10;
// Some calls are carried out at once, by the caller: two cameras are opened, or closed, between two that wait.
inline constexpr int kDepths = 4;

template <int kDepth, class Call>
[[gnu::noinline]] decltype(auto) call_at_depth(int depth, Call& call) {
  volatile std::byte between[kApart_bytes];
  between[0] = std::byte{0};  // or there would be no array
  struct Keep {               // until the call is over: no tail call
    volatile std::byte* array;
    ~Keep() { array[kApart_bytes - 1] = std::byte{0}; }
  } const keep{between};
  if constexpr (kDepth + 1 < kDepths)
    if (depth > kDepth) return call_at_depth<kDepth + 1>(depth, call);
  return call();
}

// What `call()` returns or throws.
template <class Call>
decltype(auto) deep_call(Call&& call) {
  thread_local int next = 0;
  next = (next + 1) % kDepths;
  return call_at_depth<0>(next, call);
}

}  // namespace accrete::hal::libcam
