// A pack of float lanes, each of which works on a primitive of its own: the filter is written once over a scalar S,
// which is a Pack, float, or (the oracle of the tests) double. Plain IEEE arithmetic: no lane ever sees another, so the
// width changes no result. Branches become select().
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#if defined(__SSE2__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

#include "math/isa.h"

#if defined(__OPTIMIZE_SIZE__)  // half the code; the order of the arithmetic stays, and so do the bits
#define ACCRETE_UNROLL ACCRETE_ROLLED
#elif defined(__clang__)
#define ACCRETE_UNROLL _Pragma("clang loop unroll(full)")
#else
#define ACCRETE_UNROLL _Pragma("GCC unroll 64")
#endif
#define ACCRETE_INLINE inline __attribute__((always_inline))

namespace accrete::inline ACCRETE_ISA {

inline constexpr int kLaneWidth = ACCRETE_LANE_WIDTH;

// g++ ignores vector_size(4 * N) as long as N is a template parameter: one specialisation for each width.
template <int N>
struct NativeLanes;
#define ACCRETE_NATIVE_LANES(n)                                                          \
  template <>                                                                            \
  struct NativeLanes<n> {                                                                \
    typedef float Float __attribute__((vector_size(4 * (n))));                           \
    typedef std::int32_t Int __attribute__((vector_size(4 * (n))));                      \
    /* of any alignment; std::memcpy() would go through the stack */                     \
    typedef float InMemory __attribute__((vector_size(4 * (n)), aligned(4), may_alias)); \
  }
ACCRETE_NATIVE_LANES(4);
ACCRETE_NATIVE_LANES(8);
ACCRETE_NATIVE_LANES(16);
#undef ACCRETE_NATIVE_LANES

// All bits of a lane are set (true) or clear.
template <int N>
struct Mask {
  using Native = typename NativeLanes<N>::Int;
  Native v;

  ACCRETE_INLINE friend Mask operator&(Mask a, Mask b) { return {a.v & b.v}; }
  ACCRETE_INLINE friend Mask operator|(Mask a, Mask b) { return {a.v | b.v}; }
  ACCRETE_INLINE Mask operator!() const { return {~v}; }
  [[nodiscard]] ACCRETE_INLINE bool operator[](int lane) const { return v[lane] != 0; }
};

template <int N>
struct Pack {
  using Native = typename NativeLanes<N>::Float;
  Native v;

  Pack() = default;
  // Not defaulted: g++ 12 copies a class from memory to memory and keeps room for whole matrices on the stack for it;
  // a vector it keeps in a register (a stereo update's stack: 8.8 to 5 kB with 8 lanes).
  ACCRETE_INLINE Pack(const Pack& other) : v(other.v) {}  // NOLINT(modernize-use-equals-default)
  ACCRETE_INLINE Pack& operator=(const Pack& other) {     // NOLINT(modernize-use-equals-default)
    v = other.v;
    return *this;
  }
  ACCRETE_INLINE Pack(Native native) : v(native) {}  // NOLINT(google-explicit-constructor): a pack is its vector
  ACCRETE_INLINE Pack(float x) : v(Native{} + x) {}  // NOLINT(google-explicit-constructor): scalars broadcast
  ACCRETE_INLINE Pack(double x) : Pack(static_cast<float>(x)) {}  // NOLINT(google-explicit-constructor): constants
  ACCRETE_INLINE Pack(int x) : Pack(static_cast<float>(x)) {}  // NOLINT(google-explicit-constructor): Eigen's 0 and 1

  ACCRETE_INLINE friend Pack operator+(Pack a, Pack b) { return a.v + b.v; }
  ACCRETE_INLINE friend Pack operator-(Pack a, Pack b) { return a.v - b.v; }
  ACCRETE_INLINE friend Pack operator*(Pack a, Pack b) { return a.v * b.v; }
  ACCRETE_INLINE friend Pack operator/(Pack a, Pack b) { return a.v / b.v; }
  ACCRETE_INLINE Pack operator-() const { return -v; }
  ACCRETE_INLINE Pack& operator+=(Pack b) { return *this = *this + b; }
  ACCRETE_INLINE Pack& operator-=(Pack b) { return *this = *this - b; }
  ACCRETE_INLINE Pack& operator*=(Pack b) { return *this = *this * b; }
  ACCRETE_INLINE Pack& operator/=(Pack b) { return *this = *this / b; }
  ACCRETE_INLINE friend Mask<N> operator<(Pack a, Pack b) { return {a.v < b.v}; }
  ACCRETE_INLINE friend Mask<N> operator>(Pack a, Pack b) { return {a.v > b.v}; }
  ACCRETE_INLINE friend Mask<N> operator<=(Pack a, Pack b) { return {a.v <= b.v}; }
  ACCRETE_INLINE friend Mask<N> operator>=(Pack a, Pack b) { return {a.v >= b.v}; }
  ACCRETE_INLINE friend Mask<N> operator==(Pack a, Pack b) { return {a.v == b.v}; }
  [[nodiscard]] ACCRETE_INLINE float operator[](int lane) const { return v[lane]; }
};

// What a scalar of the kernels is: number of lanes, and the result of its comparisons.
template <class S>
struct LaneTraits {  // float, double
  static constexpr int kLanes = 1;
  using Bool = bool;
};
template <int N>
struct LaneTraits<Pack<N>> {
  static constexpr int kLanes = N;
  using Bool = Mask<N>;
};
template <class S>
using Bool = typename LaneTraits<S>::Bool;

// What the functions on lanes work with: kLaneWidth lanes at once.
template <int N>
struct LanesOf {
  using Type = Pack<N>;
};
template <>
struct LanesOf<1> {
  using Type = ACCRETE_LANE_SCALAR;
};
using Lanes = LanesOf<kLaneWidth>::Type;
using Flags = Bool<Lanes>;

template <int N>
ACCRETE_INLINE Pack<N> select(Mask<N> m, Pack<N> a, Pack<N> b) {
  return m.v ? a.v : b.v;
}
ACCRETE_INLINE float select(bool m, float a, float b) { return m ? a : b; }
ACCRETE_INLINE double select(bool m, double a, double b) { return m ? a : b; }

template <int N>
ACCRETE_INLINE bool lane(Mask<N> m, int i) {
  return m[i];
}
ACCRETE_INLINE bool lane(bool m, int) { return m; }
template <int N>
ACCRETE_INLINE float lane(Pack<N> x, int i) {
  return x[i];
}
ACCRETE_INLINE float lane(float x, int) { return x; }
ACCRETE_INLINE double lane(double x, int) { return x; }

// True in all lanes: what is rare is done behind a branch, and only in the lanes that need it.
template <int N>
ACCRETE_INLINE bool all_of(Mask<N> m) {
#if defined(__AVX512F__)
  if constexpr (N == 16) return _mm512_test_epi32_mask(__m512i(m.v), __m512i(m.v)) == 0xFFFF;
#endif
#if defined(__AVX__)
  if constexpr (N == 8) return _mm256_movemask_ps(__m256(m.v)) == 0xFF;
#endif
#if defined(__SSE2__)
  if constexpr (N == 4) return _mm_movemask_ps(__m128(m.v)) == 0xF;
#elif defined(__aarch64__)
  if constexpr (N == 4) return vminvq_u32(uint32x4_t(m.v)) != 0;
#endif
  bool all = true;
  for (int i = 0; i < N; ++i) all &= m.v[i] != 0;
  return all;
}
ACCRETE_INLINE bool all_of(bool m) { return m; }

// A NaN in `b` never gets through (in `a` it does): min and max of the hardware have the same rule.
template <class S>
ACCRETE_INLINE S min_of(S a, S b) {
  return select(b < a, b, a);
}
template <class S>
ACCRETE_INLINE S max_of(S a, S b) {
  return select(b > a, b, a);
}
ACCRETE_INLINE float abs_of(float a) { return std::fabs(a); }
ACCRETE_INLINE double abs_of(double a) { return std::fabs(a); }
template <int N>
ACCRETE_INLINE Pack<N> abs_of(Pack<N> a) {
  using Int = typename Mask<N>::Native;
  return typename Pack<N>::Native(Int(a.v) & 0x7FFFFFFF);
}
// false for NaN and infinity (and in double beyond float, so that the oracle decides as float does). By a comparison
// alone: a difference would be waited for, and equality takes one lane two branches.
inline constexpr float kLargest = 3.40282347e38F;
template <class S>
ACCRETE_INLINE Bool<S> is_finite(S a) {
  return abs_of(a) <= S(kLargest);
}

ACCRETE_INLINE float sqrt_of(float x) { return std::sqrt(x); }
ACCRETE_INLINE double sqrt_of(double x) { return std::sqrt(x); }
template <int N>
ACCRETE_INLINE Pack<N> sqrt_of(Pack<N> x) {
  using Native = typename Pack<N>::Native;
#if defined(__AVX512F__)
  if constexpr (N == 16) return Native(_mm512_maskz_sqrt_ps(0xFFFF, __m512(x.v)));  // the plain form warns in g++ 12
#endif
#if defined(__AVX__)
  if constexpr (N == 8) return Native(_mm256_sqrt_ps(__m256(x.v)));
#endif
#if defined(__SSE2__)
  if constexpr (N == 4) return Native(_mm_sqrt_ps(__m128(x.v)));
#elif defined(__aarch64__)
  if constexpr (N == 4) return Native(vsqrtq_f32(float32x4_t(x.v)));
#endif
  Native r{};
  for (int i = 0; i < N; ++i) r[i] = std::sqrt(x.v[i]);
  return r;
}
template <class S>
ACCRETE_INLINE S inverse_sqrt(S x) {
  return S(1) / sqrt_of(x);
}

// LaneTraits<S>::kLanes values from (to) memory of any alignment.
template <class S, class T>
ACCRETE_INLINE S load_lanes(const T* from) {
  if constexpr (LaneTraits<S>::kLanes == 1) {
    return static_cast<S>(*from);
  } else {
    using InMemory = typename NativeLanes<LaneTraits<S>::kLanes>::InMemory;
    return typename S::Native(*reinterpret_cast<const InMemory*>(from));
  }
}
template <class S, class T>
ACCRETE_INLINE void store_lanes(S x, T* to) {
  if constexpr (LaneTraits<S>::kLanes == 1) {
    *to = static_cast<T>(x);
  } else {
    using InMemory = typename NativeLanes<LaneTraits<S>::kLanes>::InMemory;
    *reinterpret_cast<InMemory*>(to) = x.v;
  }
}

// One number a lane, not zero where the mask is true.
template <int N>
ACCRETE_INLINE void store_mask(Mask<N> m, std::int32_t* to) {
  std::memcpy(to, &m.v, sizeof(m.v));
}
ACCRETE_INLINE void store_mask(bool m, std::int32_t* to) { *to = m ? -1 : 0; }

// Values below this are lost as zeros: their products would be subnormal, and those cost a hundred cycles each
// (PERFORMANCE B.6). The smallest normal float is 1.2e-38.
inline constexpr float kTinyFactor = 1e-18F;
template <class S>
ACCRETE_INLINE S flush_tiny(S x) {
  return select(abs_of(x) < S(kTinyFactor), S(0), x);
}

}  // namespace accrete::inline ACCRETE_ISA
