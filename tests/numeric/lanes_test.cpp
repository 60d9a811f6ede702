#include "math/lanes.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "math/matrix.h"

namespace accrete {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

template <class P>
class Lanes : public testing::Test {};
using Widths = testing::Types<Pack<4>, Pack<8>, Pack<16>>;
TYPED_TEST_SUITE(Lanes, Widths);

// Awkward values first, so that even four lanes see some in turn.
const std::vector<float> kValues = {1.5F, -2.25F, 0.0F,  1e-30F, 3e10F, -7.0F, 0.3F,  1e-20F,
                                    kInf, kNan,   -kInf, -0.0F,  2.0F,  9.0F,  1e-4F, 5.0F};

template <class P>
P pick(std::size_t first) {
  float x[16];
  for (std::size_t l = 0; l < 16; ++l) x[l] = kValues[(first + l) % 16];
  return load_lanes<P>(x);
}
bool same(float a, float b) { return a == b || (a != a && b != b); }

TYPED_TEST(Lanes, every_operation_is_the_scalar_one_in_each_lane) {
  constexpr int n = LaneTraits<TypeParam>::kLanes;
  for (std::size_t i = 0; i < 16; ++i)
    for (std::size_t j = 0; j < 16; ++j) {
      const TypeParam a = pick<TypeParam>(i), b = pick<TypeParam>(j);
      for (int l = 0; l < n; ++l) {
        const float x = a[l], y = b[l];
        EXPECT_TRUE(same((a + b)[l], x + y));
        EXPECT_TRUE(same((a - b)[l], x - y));
        EXPECT_TRUE(same((a * b)[l], x * y));
        EXPECT_TRUE(same((a / b)[l], x / y));
        EXPECT_TRUE(same((-a)[l], -x));
        EXPECT_EQ((a < b)[l], x < y);
        EXPECT_EQ((a >= b)[l], x >= y);
        EXPECT_EQ((a == b)[l], x == y);
        EXPECT_EQ((!(a < b))[l], !(x < y));
        EXPECT_EQ(((a < b) | (a > b))[l], x < y || x > y);
        EXPECT_TRUE(same(select(a < b, a, b)[l], x < y ? x : y));
        EXPECT_TRUE(same(min_of(a, b)[l], min_of(x, y)));
        EXPECT_TRUE(same(max_of(a, b)[l], max_of(x, y)));
        EXPECT_TRUE(same(abs_of(a)[l], std::fabs(x)));
        EXPECT_TRUE(same(sqrt_of(a)[l], std::sqrt(x)) || x < 0);
        EXPECT_EQ(is_finite(a)[l], std::isfinite(x));
        EXPECT_TRUE(same(flush_tiny(a)[l], std::fabs(x) < 1e-18F ? 0.0F : x));
      }
    }
}

TYPED_TEST(Lanes, memory_round_trip) {
  constexpr int n = LaneTraits<TypeParam>::kLanes;
  float in[17], out[17] = {};
  for (int i = 0; i < 17; ++i) in[i] = static_cast<float>(i);
  store_lanes(load_lanes<TypeParam>(in + 1), out);  // not aligned
  for (int i = 0; i < n; ++i) EXPECT_EQ(out[i], in[i + 1]);
  EXPECT_EQ(out[n], 0.0F);
}

TYPED_TEST(Lanes, are_a_scalar_of_eigen) {
  constexpr int n = LaneTraits<TypeParam>::kLanes;
  Eigen::Matrix<TypeParam, 3, 3> m;
  Eigen::Matrix<TypeParam, 3, 1> v;
  for (int i = 0; i < 3; ++i) {
    v[i] = pick<TypeParam>(0) + TypeParam(i);
    for (int j = 0; j < 3; ++j) m(i, j) = TypeParam(10 * i + j);
  }
  const Eigen::Matrix<TypeParam, 3, 1> product = m * v + v;
  for (int l = 0; l < n; ++l)
    for (int i = 0; i < 3; ++i) {
      float sum = v[i][l];
      for (int j = 0; j < 3; ++j) sum += static_cast<float>(10 * i + j) * v[j][l];
      if (!std::isfinite(sum)) continue;
      EXPECT_NEAR(product[i][l], sum, 1e-5F * (1 + std::fabs(sum)));
    }
}

TEST(LaneWidth, is_what_the_instruction_set_holds) {
#if defined(__AVX512F__)
  EXPECT_EQ(kLaneWidth, 16);
#elif defined(__AVX2__)
  EXPECT_EQ(kLaneWidth, 8);
#else
  EXPECT_EQ(kLaneWidth, 4);
#endif
}

}  // namespace
}  // namespace accrete
