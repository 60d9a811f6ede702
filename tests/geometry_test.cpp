#include "accrete/geometry.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <random>

namespace accrete {
namespace {

// Frames are part of the type: what does not fit together does not compile.
template <class A, class B>
concept Composable = requires(A a, B b) {
  a* b;
};
static_assert(Composable<Transform<Right, Left>, Transform<Left, Object>>);
static_assert(!Composable<Transform<Left, Right>, Transform<Left, Object>>);
static_assert(!Composable<Transform<Left, World>, Transform<Object, Left>>);
static_assert(std::is_same_v<decltype(Transform<Right, Left>{} * Transform<Left, World>{}), Transform<Right, World>>);
static_assert(std::is_same_v<decltype(Transform<Right, Left>{}.inverse()), Transform<Left, Right>>);
static_assert(!std::is_convertible_v<Transform<Left, Object>, Transform<Left, World>>);
static_assert(!std::is_convertible_v<Transform<Left, Object>, Transform<Object, Left>>);

Quaternion random_rotation(std::mt19937& rng) {
  std::normal_distribution<double> n;
  const double x = n(rng), y = n(rng), z = n(rng), w = n(rng), s = 1 / std::sqrt(x * x + y * y + z * z + w * w);
  return {s * x, s * y, s * z, s * w};
}

// q and -q are one rotation.
double distance(const Quaternion& a, const Quaternion& b) { return rotation_angle(conjugate(a) * b); }

TEST(Geometry, TransformComposesAndInverts) {
  std::mt19937 rng(1);
  std::normal_distribution<double> n;
  for (int i = 0; i < 100; ++i) {
    const Transform<Right, Left> T_r_l{random_rotation(rng), {n(rng), n(rng), n(rng)}};
    const Transform<Left, World> T_l_w{random_rotation(rng), {n(rng), n(rng), n(rng)}};
    const Vec3 p{n(rng), n(rng), n(rng)};
    EXPECT_LT(norm((T_r_l * T_l_w) * p - T_r_l * (T_l_w * p)), 1e-13);
    EXPECT_LT(norm(T_l_w.inverse() * (T_l_w * p) - p), 1e-13);
  }
}

TEST(Geometry, QuaternionOfAKnownRotation) {
  // A quarter turn about z takes x to y.
  const double h = std::sqrt(0.5);
  const Vec3 y = to_matrix(Quaternion{0, 0, h, h}) * Vec3{1, 0, 0};
  EXPECT_NEAR(y[0], 0, 1e-15);
  EXPECT_NEAR(y[1], 1, 1e-15);
  EXPECT_NEAR(rotation_angle({0, 0, h, h}), std::numbers::pi / 2, 1e-15);
  EXPECT_NEAR(rotation_angle({0, 0, -h, -h}), std::numbers::pi / 2, 1e-15);
}

TEST(Geometry, MatrixToQuaternionAndBack) {
  std::mt19937 rng(2);
  for (int i = 0; i < 1000; ++i) {
    const Quaternion q = random_rotation(rng);
    const auto back = to_quaternion(to_matrix(q));
    ASSERT_TRUE(back.ok());
    EXPECT_LT(distance(q, back.value()), 1e-14);
  }
  // Half turns about each axis: three different branches, w = 0.
  for (const Quaternion q : {Quaternion{1, 0, 0, 0}, Quaternion{0, 1, 0, 0}, Quaternion{0, 0, 1, 0}}) {
    const auto back = to_quaternion(to_matrix(q));
    ASSERT_TRUE(back.ok());
    EXPECT_LT(distance(q, back.value()), 1e-14);
  }
}

TEST(Geometry, NearestRotationOfARoundedMatrix) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> u(-3e-4, 3e-4);
  for (int i = 0; i < 100; ++i) {
    const Quaternion q = random_rotation(rng);
    Mat3 m = to_matrix(q);
    for (double& v : m) v += u(rng);
    const auto got = to_quaternion(m);
    ASSERT_TRUE(got.ok());
    // Nearest: m Rt is symmetric there, the first-order condition of the polar factor.
    const Mat3 s = m * transposed(to_matrix(got.value()));
    EXPECT_NEAR(s[1], s[3], 1e-13);
    EXPECT_NEAR(s[2], s[6], 1e-13);
    EXPECT_NEAR(s[5], s[7], 1e-13);
  }
}

TEST(Geometry, RefusesWhatIsNoRotation) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Mat3 reflection{1, 0, 0, 0, 1, 0, 0, 0, -1}, scaled{2, 0, 0, 0, 2, 0, 0, 0, 2},
      sheared{1, 0.1, 0, 0, 1, 0, 0, 0, 1}, zero{}, not_a_number{1, 0, 0, 0, nan, 0, 0, 0, 1};
  for (const Mat3& m : {reflection, scaled, sheared, zero, not_a_number})
    EXPECT_EQ(to_quaternion(m).status(), Status::kInvalidArgument);
  EXPECT_EQ(normalized({0, 0, 0, 0}).status(), Status::kInvalidArgument);
  EXPECT_EQ(normalized({0, 0, 0, nan}).status(), Status::kInvalidArgument);
  EXPECT_EQ(normalized({3, 0, 0, 0}).status(), Status::kInvalidArgument);
  ASSERT_TRUE(normalized({0, 0, 0, 1.001}).ok());
  EXPECT_EQ(normalized({0, 0, 0, 1.001}).value().w, 1.0);
}

TEST(Geometry, SlerpIsUniformAndTakesTheShorterWay) {
  std::mt19937 rng(4);
  for (int i = 0; i < 200; ++i) {
    const Quaternion a = random_rotation(rng), b = random_rotation(rng);
    const double angle = distance(a, b);
    EXPECT_LT(distance(slerp(a, b, 0), a), 1e-7);
    EXPECT_LT(distance(slerp(a, b, 1), b), 1e-7);
    EXPECT_NEAR(distance(a, slerp(a, b, 0.25)), 0.25 * angle, 1e-7);
    EXPECT_NEAR(distance(slerp(a, b, 0.25), b), 0.75 * angle, 1e-7);
  }
  // Nearly equal: no digit is lost.
  const Quaternion a{0, 0, 0, 1}, b = slerp(a, {std::sin(5e-7), 0, 0, std::cos(5e-7)}, 0.5);
  EXPECT_NEAR(b.x, 2.5e-7, 1e-18);
}

}  // namespace
}  // namespace accrete
