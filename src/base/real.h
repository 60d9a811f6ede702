// What elementary.h needs to know of a scalar: its bits, and whole numbers in it. src/math/lane_real.h tells it of
// packs of lanes.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace accrete {

// IEEE binary32 and binary64. kShift: 1.5 * 2^(bits of the fraction). A number of up to a quarter of that is rounded to
// a whole one, ties to even, by adding and subtracting it, and the sum's bits hold that number: no instruction for
// conversion, which every machine has differently for lanes, is needed.
struct Binary32 {
  using Scalar = float;
  static constexpr int kFraction = 23, kBias = 127;
  static constexpr float kShift = 12582912.0F, kInfinity = __builtin_inff(), kSmallest = 0x1p-126F;
};
struct Binary64 {
  using Scalar = double;
  static constexpr int kFraction = 52, kBias = 1023;
  static constexpr double kShift = 6755399441055744.0, kInfinity = __builtin_inf(), kSmallest = 0x1p-1022;
};

template <class S>
struct Real;
template <>
struct Real<float> {
  using Format = Binary32;
  using Int = std::int32_t;
  static Int bits(float x) { return std::bit_cast<Int>(x); }
  static float from_bits(Int i) { return std::bit_cast<float>(i); }
  static bool is_set(Int i) { return i != 0; }
  static float choose(bool m, float a, float b) { return m ? a : b; }
  static float root(float x) { return std::sqrt(x); }
};
template <>
struct Real<double> {
  using Format = Binary64;
  using Int = std::int64_t;
  static Int bits(double x) { return std::bit_cast<Int>(x); }
  static double from_bits(Int i) { return std::bit_cast<double>(i); }
  static bool is_set(Int i) { return i != 0; }
  static double choose(bool m, double a, double b) { return m ? a : b; }
  static double root(double x) { return std::sqrt(x); }
};

}  // namespace accrete
