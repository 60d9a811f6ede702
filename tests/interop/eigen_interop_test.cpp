// Eigen's types on ours: views share memory, copies mean the same.
#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <type_traits>

#include "accrete/interop/eigen.h"
#include "accrete/model.h"

namespace accrete::interop {
namespace {

TEST(EigenInterop, views_share_memory) {
  Vec3 v{1, 2, 3};
  view(v)[1] = 7;
  EXPECT_EQ(v[1], 7);
  EXPECT_EQ(view(v).data(), v.data());

  PoseCovariance c = diagonal_pose_covariance(2, 3);
  matrix_view<6>(c)(0, 4) = 5;  // row 0, column 4
  EXPECT_EQ(c[4], 5);
  EXPECT_EQ(matrix_view<6>(std::as_const(c)).trace(), 3 * 4 + 3 * 9);

  Primitive3d p;
  p.geometry.position = {1, 2, 3};
  EXPECT_EQ(view(p.geometry.position).norm(), std::sqrt(14.0F));
  p.geometry.quaternion = {0.6F, 0, 0, 0.8F};
  EXPECT_EQ(rotation_view(p.geometry).x(), 0.6F);
  EXPECT_EQ(rotation_view(p.geometry).w(), 0.8F);
}

TEST(EigenInterop, blocks_are_arrays_of_lanes) {
  static GeometryBlock block{};
  Geometry g;
  g.position = {1, 2, 3};
  store(g, block, 5);
  const auto lanes = block_view(block.row);
  EXPECT_EQ(lanes.data(), &block.row[0][0]);
  EXPECT_EQ(lanes(GeometryBlock::kPosition + 2, 5), 3);
  EXPECT_EQ(lanes.col(5).segment<3>(GeometryBlock::kPosition).sum(), 6);
}

TEST(EigenInterop, packed_covariances_become_symmetric_matrices) {
  Geometry g;
  for (std::size_t i = 0; i < g.covariance.size(); ++i) g.covariance[i] = static_cast<float>(i);
  const auto c = covariance(g);
  EXPECT_EQ(c, c.transpose());
  EXPECT_EQ(c(0, 5), 5);   // the last of the first row
  EXPECT_EQ(c(1, 1), 6);   // the first of the second one
  EXPECT_EQ(c(5, 5), 20);  // the last
  AppearanceState a;
  a.covariance[27] = 2;
  EXPECT_EQ(covariance(a)(6, 6), 2);
}

TEST(EigenInterop, transforms_act_alike) {
  const double s = std::sqrt(0.5);
  const Transform<Left, Object> T_l_o{{s * 0.6, s * 0.8, 0, s}, {0.1, -0.2, 0.9}};
  const Vec3 p_o{0.3, 0.5, -0.7};
  const Vec3 p_l = T_l_o * p_o;
  const Eigen::Isometry3d E_l_o = to_eigen(T_l_o);
  EXPECT_LT((E_l_o * view(p_o) - view(p_l)).norm(), 1e-15);

  const auto back = from_eigen<Left, Object>(E_l_o);
  ASSERT_TRUE(back.ok());
  EXPECT_LT(rotation_angle(conjugate(back.value().rotation) * T_l_o.rotation), 1e-7);
  EXPECT_EQ(back.value().translation, T_l_o.translation);
  static_assert(std::is_same_v<decltype(back.value().inverse()), Transform<Object, Left>>);
}

TEST(EigenInterop, what_is_no_rigid_motion_is_refused) {
  Eigen::Isometry3d bad = Eigen::Isometry3d::Identity();
  bad.linear()(0, 0) = -1;  // a mirror
  EXPECT_EQ((from_eigen<Left, Object>(bad).status()), Status::kInvalidArgument);
  bad = Eigen::Isometry3d::Identity();
  bad.linear() *= 1.01;
  EXPECT_EQ((from_eigen<Left, Object>(bad).status()), Status::kInvalidArgument);
  bad = Eigen::Isometry3d::Identity();
  bad.translation()[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ((from_eigen<Left, Object>(bad).status()), Status::kInvalidArgument);
}

template <class T>
concept Viewable = requires {
  view(std::declval<T>());
};

TEST(EigenInterop, a_view_of_a_temporary_does_not_compile) {
  static_assert(Viewable<Vec3&> && Viewable<const Vec3&>);
  static_assert(!Viewable<Vec3>);
}

}  // namespace
}  // namespace accrete::interop
