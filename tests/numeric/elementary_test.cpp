// The library's own elementary functions against libm in long double: the bounds that docs/math/elementary.md states.
// ELEMENTARY_STRIDE=1 visits every float (hours); the default visits one in some thousands.
#include "base/elementary.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>

#include "math/lane_real.h"

namespace accrete {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <class T>
double ulps(T got, long double expected) {
  const T rounded = std::fabs(static_cast<T>(expected));
  const T ulp = std::nextafter(rounded, std::numeric_limits<T>::infinity()) - rounded;
  return static_cast<double>(std::fabs(static_cast<long double>(got) - expected) / ulp);
}

struct Error {
  double ulps = 0, absolute = 0;
};

std::uint32_t stride() {
  const char* text = std::getenv("ELEMENTARY_STRIDE");
  return text != nullptr && std::atoi(text) > 0 ? static_cast<std::uint32_t>(std::atoi(text)) : 4099;  // a prime
}

template <class Mine, class Reference>
Error floats(double low, double high, Mine mine, Reference reference) {
  Error worst;
  std::uint64_t count = 0;
  for (std::uint64_t i = 0x00800000; i < 0x7f800000; i += stride())
    for (const float x :
         {std::bit_cast<float>(static_cast<std::uint32_t>(i)), -std::bit_cast<float>(static_cast<std::uint32_t>(i))}) {
      if (!(x >= low && x <= high)) continue;
      const float y = mine(x);
      const long double expected = reference(static_cast<long double>(x));
      worst.ulps = std::max(worst.ulps, ulps(y, expected));
      worst.absolute = std::max(worst.absolute, static_cast<double>(std::fabs(y - expected)));
      ++count;
    }
  EXPECT_GT(count, 1000U);
  return worst;
}

template <class Mine, class Reference>
Error doubles(double low, double high, Mine mine, Reference reference) {
  Error worst;
  std::uint64_t seed = 1;
  for (int i = 0; i < 300000; ++i) {
    seed = seed * 6364136223846793005U + 1442695040888963407U;
    const double u = static_cast<double>(seed >> 11) * 0x1p-53;
    const double x = i % 2 == 0 ? low + (high - low) * u : std::ldexp(u - 0.5, -static_cast<int>(seed & 63));
    if (!(x >= low && x <= high)) continue;
    const double y = mine(x);
    const long double expected = reference(static_cast<long double>(x));
    worst.ulps = std::max(worst.ulps, ulps(y, expected));
    worst.absolute = std::max(worst.absolute, static_cast<double>(std::fabs(y - expected)));
  }
  return worst;
}

using L = long double;
const auto sin_l = [](L x) { return std::sin(x); };
const auto cos_l = [](L x) { return std::cos(x); };
const auto exp_l = [](L x) { return std::exp(x); };
const auto log_l = [](L x) { return std::log(x); };
const auto atan_l = [](L x) { return std::atan(x); };
const auto asin_l = [](L x) { return std::asin(x); };
const auto acos_l = [](L x) { return std::acos(x); };

TEST(Elementary, errors_of_float_are_bounded) {
  const auto sine = [](float x) { return sin_of(x); };
  const auto cosine = [](float x) { return cos_of(x); };
  EXPECT_LT(floats(-3.2, 3.2, sine, sin_l).ulps, 1.6);
  EXPECT_LT(floats(-3.2, 3.2, cosine, cos_l).ulps, 1.7);
  EXPECT_LT(floats(-4096, 4096, sine, sin_l).absolute, 1.3e-7);
  EXPECT_LT(floats(-4096, 4096, cosine, cos_l).absolute, 1.3e-7);
  EXPECT_LT(floats(
                -87.33, 88.72, [](float x) { return exp_of(x); }, exp_l)
                .ulps,
            1.1);
  EXPECT_LT(floats(
                0, kInfinity, [](float x) { return log_of(x); }, log_l)
                .ulps,
            0.9);
  EXPECT_LT(floats(
                -kInfinity, kInfinity, [](float x) { return atan_of(x); }, atan_l)
                .ulps,
            2.7);
  EXPECT_LT(floats(
                -1e37, 1e37, [](float x) { return atan2_of(x, -1.0F); }, [](L x) { return std::atan2(x, L(-1)); })
                .ulps,
            1.4);
  EXPECT_LT(floats(
                -1, 1, [](float x) { return asin_of(x); }, asin_l)
                .ulps,
            3.5);
  EXPECT_LT(floats(
                -1, 1, [](float x) { return acos_of(x); }, acos_l)
                .ulps,
            3.5);
  const auto cdf = [](float x) { return normal_cdf_of(x); };
  const auto cdf_l = [](L x) { return 0.5L * std::erfc(-x / std::sqrt(2.0L)); };
  EXPECT_LT(floats(-13, 13, cdf, cdf_l).absolute, 2.5e-7);
  EXPECT_LT(floats(-4, 4, cdf, cdf_l).ulps, 25);
}

TEST(Elementary, errors_of_double_are_bounded) {
  if (std::numeric_limits<L>::digits <= std::numeric_limits<double>::digits)  // 32-bit ARM
    GTEST_SKIP() << "long double is no wider than double here: nothing to hold it against";
  EXPECT_LT(doubles(
                -4, 4, [](double x) { return sin_of(x); }, sin_l)
                .ulps,
            1.7);
  EXPECT_LT(doubles(
                -4, 4, [](double x) { return cos_of(x); }, cos_l)
                .ulps,
            1.7);
  EXPECT_LT(doubles(
                -1e6, 1e6, [](double x) { return sin_of(x); }, sin_l)
                .absolute,
            2.5e-16);
  EXPECT_LT(doubles(
                -708, 709, [](double x) { return exp_of(x); }, exp_l)
                .ulps,
            1.1);
  EXPECT_LT(doubles(
                1e-300, 1e6, [](double x) { return log_of(x); }, log_l)
                .ulps,
            0.9);
  EXPECT_LT(doubles(
                -40, 40, [](double x) { return atan_of(x); }, atan_l)
                .ulps,
            2.2);
  EXPECT_LT(doubles(
                -1, 1, [](double x) { return asin_of(x); }, asin_l)
                .ulps,
            3.5);
  EXPECT_LT(doubles(
                -1, 1, [](double x) { return acos_of(x); }, acos_l)
                .ulps,
            3.5);
  EXPECT_LT(doubles(
                -1.5, 1.5, [](double x) { return tan_of(x); }, [](L x) { return std::tan(x); })
                .ulps,
            4);
}

// The worst of a reduction: multiples of pi / 2, and the numbers beside them.
TEST(Elementary, reductions_are_good_beside_multiples) {
  for (int k = -2600; k <= 2600; ++k) {
    const auto near = static_cast<float>(k * 1.57079632679489662L);
    for (const float x : {near, std::nextafter(near, -1e9F), std::nextafter(near, 1e9F)}) {
      ASSERT_LT(std::fabs(sin_of(x) - std::sin(L{x})), 1.3e-7) << x;
      ASSERT_LT(std::fabs(cos_of(x) - std::cos(L{x})), 1.3e-7) << x;
    }
  }
  for (int k = -87; k <= 88; ++k)
    for (const float part : {-0.5F, -0.4999999F, 0.5F}) {
      const float x = (static_cast<float>(k) + part) * 0.6931472F;
      if (x < -87.3F) continue;
      ASSERT_LT(ulps(exp_of(x), std::exp(L{x})), 1.1) << x;
    }
}

TEST(Elementary, ends_of_the_domains) {
  constexpr float kInf = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();
  for (const float none : {kNan, kInf, -kInf}) {
    EXPECT_TRUE(std::isnan(sin_of(none)));
    EXPECT_TRUE(std::isnan(cos_of(none)));
  }
  EXPECT_EQ(sin_of(4097.0F), 0);
  EXPECT_EQ(cos_of(-1e30F), 1);
  EXPECT_EQ(sin_of(0.0F), 0);
  EXPECT_EQ(cos_of(-0.0F), 1);
  EXPECT_EQ(exp_of(-kInf), 0);
  EXPECT_EQ(exp_of(-87.4F), 0);
  EXPECT_EQ(exp_of(kInf), kInf);
  EXPECT_EQ(exp_of(88.73F), kInf);
  EXPECT_TRUE(std::isnan(exp_of(kNan)));
  EXPECT_EQ(exp_of(0.0F), 1);
  for (const float zero : {0.0F, -0.0F, 1e-40F}) EXPECT_EQ(log_of(zero), -kInf);
  EXPECT_EQ(log_of(1.0F), 0);
  EXPECT_EQ(log_of(kInf), kInf);
  EXPECT_TRUE(std::isnan(log_of(-1.0F)));
  EXPECT_TRUE(std::isnan(log_of(kNan)));
  const float pi = 3.14159274F;
  EXPECT_EQ(atan2_of(0.0F, -0.0F), 0);
  EXPECT_EQ(atan2_of(-0.0F, -1.0F), pi);
  EXPECT_EQ(atan2_of(1e-40F, -1.0F), pi);
  EXPECT_EQ(atan2_of(kInf, 1.0F), pi / 2);
  EXPECT_EQ(atan2_of(-kInf, kInf), -pi / 4);
  EXPECT_TRUE(std::isnan(atan2_of(kNan, 1.0F)));
  EXPECT_TRUE(std::isnan(atan2_of(1.0F, kNan)));
  EXPECT_EQ(acos_of(1.5F), 0);
  EXPECT_EQ(acos_of(-1.0F), pi);
  EXPECT_EQ(normal_cdf_of(0.0F), 0.5F);
  EXPECT_EQ(normal_cdf_of(-40.0F), 0);
  EXPECT_EQ(normal_cdf_of(40.0F), 1);
}

// Lanes have the same bits as one number alone.
TEST(Elementary, lanes_compute_the_same) {
  using Four = Pack<4>;
  std::uint64_t seed = 7;
  const auto next = [&](float scale) {
    seed = seed * 6364136223846793005U + 1442695040888963407U;
    return scale * static_cast<float>(static_cast<double>(seed >> 40) * 0x1p-23 - 1);
  };
  for (int i = 0; i < 20000; ++i) {
    float x[4], y[4];
    for (int l = 0; l < 4; ++l) x[l] = next(i % 2 == 0 ? 4.0F : 90.0F), y[l] = next(3.0F);
    const Four a = load_lanes<Four>(x), b = load_lanes<Four>(y);
    const Four s = sin_of(a), c = cos_of(a), e = exp_of(a), g = log_of(a), t = atan2_of(a, b);
    for (int l = 0; l < 4; ++l) {
      const auto same = [](float p, float q) { return std::bit_cast<int>(p) == std::bit_cast<int>(q); };
      ASSERT_TRUE(same(s[l], sin_of(x[l])) && same(c[l], cos_of(x[l])) && same(e[l], exp_of(x[l]))) << x[l];
      ASSERT_TRUE(same(t[l], atan2_of(x[l], y[l]))) << x[l] << " " << y[l];
      ASSERT_TRUE(x[l] < 0 || same(g[l], log_of(x[l]))) << x[l];
    }
  }
}

}  // namespace
}  // namespace accrete
