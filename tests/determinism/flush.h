// The processor's own way with subnormal numbers: results must not depend on it.
#pragma once

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace accrete::determinism {

// From now on subnormal results and operands are zeros in this thread, until `on` is false. False where the processor
// has no such mode.
inline bool flush_subnormals([[maybe_unused]] bool on = true) {
#if defined(__SSE2__)
  constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x0040;
  const unsigned mode = kFlushToZero | kDenormalsAreZero;
  _mm_setcsr(on ? _mm_getcsr() | mode : _mm_getcsr() & ~mode);
  return true;
#elif defined(__aarch64__)
  unsigned long fpcr = 0;
  __asm__ volatile("mrs %0, fpcr" : "=r"(fpcr));
  constexpr unsigned long kFlushToZero = 1UL << 24;
  fpcr = on ? fpcr | kFlushToZero : fpcr & ~kFlushToZero;
  __asm__ volatile("msr fpcr, %0" : : "r"(fpcr));
  return true;
#elif defined(__arm__) && defined(__ARM_FP)
  unsigned fpscr = 0;
  __asm__ volatile("vmrs %0, fpscr" : "=r"(fpscr));
  constexpr unsigned kFlushToZero = 1U << 24;
  fpscr = on ? fpscr | kFlushToZero : fpscr & ~kFlushToZero;
  __asm__ volatile("vmsr fpscr, %0" : : "r"(fpscr));
  return true;
#else
  return false;
#endif
}

}  // namespace accrete::determinism
