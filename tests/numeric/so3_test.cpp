#include "math/so3.h"

#include <gtest/gtest.h>

#include "filter/reconstructed_kernel.h"
#include "numeric/dice.h"
#include "numeric/lane_bridge.h"
#include "stereo/reconstruct_kernel.h"

namespace accrete {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using oracle::Dice;
using oracle::exp_so3;
using oracle::kDegree;

Quat<double> to_quat(const Matrix3d& R) {
  const Eigen::Quaterniond q(R);
  return {q.x(), q.y(), q.z(), q.w()};
}
template <class S>
Matrix3d to_eigen(const Quat<S>& q) {
  const Matrix3<S> m = rotation_matrix(q);
  return m.template cast<double>();
}

TEST(So3, rotation_matrix_is_that_of_eigen) {
  Dice dice(1);
  for (int k = 0; k < 100; ++k) {
    const Matrix3d R = dice.rotation();
    EXPECT_LT((to_eigen(to_quat(R)) - R).norm(), 1e-14);
  }
}

TEST(So3, exponential_is_right_to_1e4_up_to_140_degrees) {
  Dice dice(2);
  for (int k = 0; k < 1000; ++k) {
    const Vector3d w = dice.normal3().normalized() * dice.uniform(0, 140 * kDegree);
    EXPECT_LT((to_eigen(exp_rotation(w.x(), w.y(), w.z())) - exp_so3(w)).norm(), 1.2e-4);
  }
  for (int k = 0; k < 100; ++k) {  // and to the precision of float where filters work
    const Vector3d w = dice.normal3().normalized() * dice.uniform(0, 40 * kDegree);
    EXPECT_LT((to_eigen(exp_rotation(w.x(), w.y(), w.z())) - exp_so3(w)).norm(), 3e-8);
  }
}

TEST(So3, exponential_is_a_unit_quaternion_for_any_angle) {
  for (const float angle : {0.0F, 1e-30F, 1e-6F, 1.0F, 3.14F, 6.28F, 6.3246F, 100.0F, 1e5F}) {
    const Quat<float> q = exp_rotation(angle, -angle, 0.5F * angle);
    EXPECT_NEAR(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w, 1.0F, 1e-6F) << angle;
  }
}

TEST(So3, retraction_by_nothing_changes_nothing) {
  Dice dice(3);
  const Matrix3d R = dice.rotation();
  EXPECT_LT((to_eigen(retract(to_quat(R), 0.0, 0.0, 0.0)) - R).norm(), 1e-15);
}

TEST(So3, retraction_tilts_first_and_rolls_about_the_new_tangent) {
  Dice dice(4);
  for (int k = 0; k < 200; ++k) {
    const Matrix3d R = dice.rotation();
    const double roll = dice.uniform(-2, 2), b = dice.uniform(-0.8, 0.8), a = dice.uniform(-0.8, 0.8);
    const Matrix3d expected = R * exp_so3({0, b, a}) * exp_so3({roll, 0, 0});
    const Matrix3d got = to_eigen(retract(to_quat(R), roll, b, a));
    EXPECT_LT((got - expected).norm(), 1e-4);
    // The tangent does not know of the roll.
    EXPECT_LT((got.col(0) - to_eigen(retract(to_quat(R), 0.0, b, a)).col(0)).norm(), 1e-14);
    EXPECT_LT((got.transpose() * got - Matrix3d::Identity()).norm(), 1e-14);
  }
}

TEST(So3, a_tilt_and_its_opposite_about_the_new_frame_undo_each_other) {
  Dice dice(5);
  for (int k = 0; k < 100; ++k) {
    const Matrix3d R = dice.rotation();
    const double b = dice.uniform(-1, 1), a = dice.uniform(-1, 1);
    EXPECT_LT((to_eigen(retract(retract(to_quat(R), 0.0, b, a), 0.0, -b, -a)) - R).norm(), 1e-14);
  }
}

TEST(So3, tilted_tangent_is_the_first_column_of_the_retraction) {
  Dice dice(6);
  for (int k = 0; k < 200; ++k) {
    const double b = dice.uniform(-1.2, 1.2), a = dice.uniform(-1.2, 1.2);
    const TiltedTangent<double> t = tilted_tangent(b, a);
    const Vector3d expected = to_eigen(exp_rotation(0.0, b, a)).col(0);
    EXPECT_LT((Vector3d(t.along, t.across_b, t.across_a) - expected).norm(), 1e-14);
  }
}

TEST(So3, tilt_to_is_the_inverse_of_the_tilt) {
  Dice dice(7);
  for (int k = 0; k < 500; ++k) {
    const double angle = dice.uniform(0, 150 * kDegree), side = dice.uniform(-3.14, 3.14);
    const Vector3d w(0, angle * std::cos(side), angle * std::sin(side));
    const Vector3d t = exp_so3(w).col(0);
    const Tilt<double> tilt = tilt_to(t.x(), t.y(), t.z());
    EXPECT_NEAR(tilt.b, w.y(), 1e-7 * angle);
    EXPECT_NEAR(tilt.a, w.z(), 1e-7 * angle);
  }
  const Tilt<float> none = tilt_to(1.0F, 0.0F, 0.0F);
  EXPECT_EQ(none.b, 0.0F);
  EXPECT_EQ(none.a, 0.0F);
  for (const float x : {-1.0F, -1.0001F, 1.0001F}) EXPECT_TRUE(std::isfinite(tilt_to(x, 1e-4F, 0.0F).a)) << x;
}

TEST(So3, angle_over_sine_from_the_cosine) {
  EXPECT_EQ(arc_over_sine(1.0), 1.0);
  EXPECT_EQ(angle_over_sine(1.0F), 1.0F);
  for (int k = 1; k < 1799; ++k) {
    const double angle = 0.1 * k * kDegree, expected = angle / std::sin(angle);
    EXPECT_NEAR(angle_over_sine(std::cos(angle)), expected, 7e-8 * expected) << 0.1 * k;
    if (k > 900) continue;
    EXPECT_NEAR(arc_over_sine(std::cos(angle)), expected, 7e-8 * expected) << 0.1 * k;
    EXPECT_NEAR(arc_over_sine(static_cast<float>(std::cos(angle))), expected, 3e-7 * expected) << 0.1 * k;
  }
}

TEST(So3, rotation_between_two_frames_is_the_tilt_and_the_roll_that_made_the_second) {
  Dice dice(10);
  for (int k = 0; k < 500; ++k) {
    const Matrix3d R = dice.rotation();
    const double roll = dice.uniform(-3.1, 3.1), tilt = dice.uniform(0, 170 * kDegree), side = dice.uniform(-3.1, 3.1);
    const double b = tilt * std::cos(side), a = tilt * std::sin(side);
    Quat<double> to = to_quat(R * exp_so3({0, b, a}) * exp_so3({roll, 0, 0}));
    if (k % 2 == 0) to = {-to.x, -to.y, -to.z, -to.w};  // the same rotation
    const RotationBetween<double> d = rotation_between(to_quat(R), to);
    EXPECT_NEAR(d.roll, roll, 1e-7 * std::abs(roll) + 1e-12);
    EXPECT_NEAR(d.b, b, 1e-7 * tilt + 1e-12);
    EXPECT_NEAR(d.a, a, 1e-7 * tilt + 1e-12);
    EXPECT_NEAR(d.sine, std::sin(roll), 1e-12);
    EXPECT_NEAR(d.cosine, std::cos(roll), 1e-12);
    EXPECT_LT((Matrix3d(d.m) - exp_so3({0, b, a}) * exp_so3({roll, 0, 0})).norm(), 1e-13);
  }
  // Opposite tangents have no such tilt; what comes out is finite.
  const RotationBetween<float> turned = rotation_between(Quat<float>{0, 0, 0, 1}, Quat<float>{0, 1, 0, 0});
  for (const float x : {turned.roll, turned.b, turned.a, turned.sine, turned.cosine}) EXPECT_TRUE(std::isfinite(x));
}

TEST(So3, turned_axes_are_those_of_the_frame_after_a_tilt_and_a_roll) {
  Dice dice(8);
  for (int k = 0; k < 100; ++k) {
    const oracle::Edge x = dice.edge();
    const double roll = dice.uniform(-2.2, 2.2), b = dice.uniform(-1, 1), a = dice.uniform(-1, 1);
    for (const bool with_tilt : {false, true}) {
      LaneState<double> lane = oracle::to_lane<double>(x);
      const HalfTurn<double> turn = half_turn(roll);
      if (with_tilt)
        turn_axes(lane.P, turn_of(turn, b, a), turn);
      else
        turn_axes(lane.P, turn);
      oracle::Matrix6d J = oracle::Matrix6d::Identity();
      const Matrix3d back = exp_so3({-roll, 0, 0});
      J.topLeftCorner<3, 3>() = with_tilt ? Matrix3d(back * exp_so3({0, -b, -a})) : back;
      J.bottomRightCorner<3, 3>() = back;
      EXPECT_LT((oracle::to_matrix(lane.P) - J * x.P * J.transpose()).norm(), 1e-5);
    }
  }
}

TEST(So3, quaternion_of_a_matrix_in_each_of_its_four_branches) {
  Dice dice(9);
  int branch[4] = {};
  for (int k = 0; k < 400; ++k) {
    const Matrix3d R = dice.rotation();
    Matrix3<double> m = R;
    const Quat<double> q = quaternion_of(m);
    EXPECT_LT((to_eigen(q) - R).norm(), 1e-14);
    const double v[4] = {std::abs(q.x), std::abs(q.y), std::abs(q.z), std::abs(q.w)};
    ++branch[std::max_element(v, v + 4) - v];
  }
  for (const int n : branch) EXPECT_GT(n, 10);
}

}  // namespace
}  // namespace accrete
