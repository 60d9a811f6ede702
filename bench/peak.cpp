#include "peak.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include <cmath>

namespace accrete::bench {
namespace {

constexpr long kLoops = 4000;
constexpr int kChains = 12;  // enough to hide a latency of 4..5 cycles on two or four ports

volatile double sink;

// Twelve independent chains in registers; the empty assembly keeps the compiler from folding them. Contraction is on
// for this file (CMakeLists.txt): a * m + c is one instruction where the target has one.
#define ACCRETE_STEP(X, REGISTER, EXPRESSION) \
  {                                           \
    auto& x = X;                              \
    x = EXPRESSION;                           \
    asm volatile("" : "+" REGISTER(X));       \
  }
#define ACCRETE_LOOP(NAME, TARGET, VECTOR, REGISTER, EXPRESSION)                                                     \
  TARGET __attribute__((noinline)) void NAME() {                                                                     \
    const VECTOR m = VECTOR{} + 0.999F, c = VECTOR{} + 1e-3F;                                                        \
    VECTOR a0 = c + 1.0F, a1 = a0 + m, a2 = a0 + c, a3 = a1 + c, a4 = a2 + c, a5 = a3 + c, a6 = a4 + c, a7 = a5 + c, \
           a8 = a6 + c, a9 = a7 + c, a10 = a8 + c, a11 = a9 + c;                                                     \
    for (long i = 0; i < kLoops; ++i) {                                                                              \
      ACCRETE_STEP(a0, REGISTER, EXPRESSION)                                                                         \
      ACCRETE_STEP(a1, REGISTER, EXPRESSION)                                                                         \
      ACCRETE_STEP(a2, REGISTER, EXPRESSION)                                                                         \
      ACCRETE_STEP(a3, REGISTER, EXPRESSION)                                                                         \
      ACCRETE_STEP(a4, REGISTER, EXPRESSION)                                                                         \
      ACCRETE_STEP(a5, REGISTER, EXPRESSION)                                                                         \
      ACCRETE_STEP(a6, REGISTER, EXPRESSION)                                                                         \
      ACCRETE_STEP(a7, REGISTER, EXPRESSION)                                                                         \
      ACCRETE_STEP(a8, REGISTER, EXPRESSION)                                                                         \
      ACCRETE_STEP(a9, REGISTER, EXPRESSION)                                                                         \
      ACCRETE_STEP(a10, REGISTER, EXPRESSION)                                                                        \
      ACCRETE_STEP(a11, REGISTER, EXPRESSION)                                                                        \
    }                                                                                                                \
    const VECTOR sum = a0 + a1 + a2 + a3 + a4 + a5 + a6 + a7 + a8 + a9 + a10 + a11;                                  \
    float out[sizeof(VECTOR) / 4];                                                                                   \
    __builtin_memcpy(out, &sum, sizeof(sum));                                                                        \
    sink = static_cast<double>(out[0]);                                                                              \
  }

#if defined(__x86_64__)
typedef float V16 __attribute__((vector_size(64)));
typedef float V8 __attribute__((vector_size(32)));
typedef float V4 __attribute__((vector_size(16)));
#define ACCRETE_AVX512 __attribute__((target("avx512f,avx512vl")))
#define ACCRETE_AVX2 __attribute__((target("avx2,fma")))
ACCRETE_LOOP(add16, ACCRETE_AVX512, V16, "v", x* m + c)
ACCRETE_LOOP(divide16, ACCRETE_AVX512, V16, "v", c / x)
ACCRETE_LOOP(root16, ACCRETE_AVX512, V16, "v", V16(_mm512_maskz_sqrt_ps(0xFFFF, __m512(x))))
ACCRETE_LOOP(add8, ACCRETE_AVX2, V8, "x", x* m + c)
ACCRETE_LOOP(divide8, ACCRETE_AVX2, V8, "x", c / x)
ACCRETE_LOOP(root8, ACCRETE_AVX2, V8, "x", V8(_mm256_sqrt_ps(__m256(x))))
ACCRETE_LOOP(fused1, __attribute__((target("fma"))), float, "x", x* m + c)
ACCRETE_LOOP(add4, , V4, "x", x* m + c)
ACCRETE_LOOP(divide4, , V4, "x", c / x)
ACCRETE_LOOP(root4, , V4, "x", V4(_mm_sqrt_ps(__m128(x))))
#define ACCRETE_REGISTER "x"
#else
#define ACCRETE_REGISTER "w"
#endif
ACCRETE_LOOP(add1, , float, ACCRETE_REGISTER, x* m + c)
ACCRETE_LOOP(divide1, , float, ACCRETE_REGISTER, c / x)
ACCRETE_LOOP(root1, , float, ACCRETE_REGISTER, std::sqrt(x))
ACCRETE_LOOP(add_double, , double, ACCRETE_REGISTER, x* m + c)
ACCRETE_LOOP(divide_double, , double, ACCRETE_REGISTER, c / x)
ACCRETE_LOOP(root_double, , double, ACCRETE_REGISTER, std::sqrt(x))

}  // namespace

bool can_run(int lanes) {
#if defined(__x86_64__)
  if (lanes == 16) return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512vl") != 0;
  if (lanes == 8) return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
  return true;
#else
  return lanes == 1;
#endif
}

void add_peak(const Arithmetic& a, std::vector<cli::Contender>& contenders) {
  const auto add = [&](const char* name, void (*loop)()) {
    contenders.push_back({name, [] {}, loop, static_cast<double>(kLoops) * kChains});
  };
  if (a.is_double) {
    add("multiply-add", add_double), add("divide", divide_double), add("root", root_double);
    return;
  }
#if defined(__x86_64__)
  if (a.lanes == 16) add("multiply-add", add16), add("divide", divide16), add("root", root16);
  if (a.lanes == 8) add("multiply-add", add8), add("divide", divide8), add("root", root8);
  if (a.lanes == 4) add("multiply-add", add4), add("divide", divide4), add("root", root4);
  if (a.lanes == 1 && a.fused) add("multiply-add", fused1), add("divide", divide1), add("root", root1);
  if (a.lanes == 1 && !a.fused) add("multiply-add", add1), add("divide", divide1), add("root", root1);
#else
  if (a.lanes == 1) add("multiply-add", add1), add("divide", divide1), add("root", root1);
#endif
}

Peak peak_from(const Arithmetic& a, const cli::Contender* first) {
  return {a.lanes, a.fused, first[0].median_ns, first[1].median_ns, first[2].median_ns};
}

}  // namespace accrete::bench
