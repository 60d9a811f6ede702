#include "accrete/primitive.h"

#include <gtest/gtest.h>

#include "numeric/dice.h"

namespace accrete {
namespace {

using oracle::Dice;

Geometry random_geometry(Dice& dice) { return oracle::record_of(dice.edge()); }

AppearanceState random_appearance(Dice& dice) {
  AppearanceState a;
  a.mean.phase = static_cast<float>(dice.uniform(-3, 3));
  for (float& c : a.mean.left) c = static_cast<float>(dice.uniform(0, 1));
  for (float& c : a.mean.right) c = static_cast<float>(dice.uniform(0, 1));
  const Eigen::MatrixXd P = dice.covariance(Eigen::VectorXd::Constant(7, 0.1));
  for (std::size_t i = 0; i < 7; ++i)
    for (std::size_t j = i; j < 7; ++j)
      a.covariance[packed_index(7, i, j)] =
          static_cast<float>(P(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
  return a;
}

TEST(Primitive, packed_index_counts_the_upper_triangle_row_by_row) {
  for (const std::size_t n : {4U, 6U, 7U}) {
    std::size_t next = 0;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i; j < n; ++j) EXPECT_EQ(packed_index(n, i, j), next++);
  }
}

TEST(Primitive, store_and_load_touch_one_lane_only) {
  Dice dice(1);
  GeometryBlock geometry{};
  AppearanceBlock appearance{};
  Geometry g[kBlockLanes];
  AppearanceState a[kBlockLanes];
  for (std::size_t l = 0; l < kBlockLanes; ++l) {
    g[l] = random_geometry(dice);
    a[l] = random_appearance(dice);
    store(g[l], geometry, l);
    store(a[l], appearance, l);
  }
  for (std::size_t l = 0; l < kBlockLanes; ++l) {
    const Geometry x = load(geometry, l);
    EXPECT_EQ(x.position, g[l].position);
    EXPECT_EQ(x.quaternion, g[l].quaternion);
    EXPECT_EQ(x.covariance, g[l].covariance);
    const AppearanceState y = load(appearance, l);
    EXPECT_EQ(y.mean.phase, a[l].mean.phase);
    EXPECT_EQ(y.mean.left, a[l].mean.left);
    EXPECT_EQ(y.mean.right, a[l].mean.right);
    EXPECT_EQ(y.covariance, a[l].covariance);
  }
}

TEST(Primitive, reversed_geometry_turns_tangent_and_b_and_keeps_a) {
  Dice dice(2);
  for (int k = 0; k < 100; ++k) {
    const Geometry g = random_geometry(dice);
    const oracle::Edge x = oracle::state_of(g), y = oracle::state_of(reversed(g));
    EXPECT_LT((x.R.col(0) + y.R.col(0)).norm(), 1e-6);
    EXPECT_LT((x.R.col(1) + y.R.col(1)).norm(), 1e-6);
    EXPECT_LT((x.R.col(2) - y.R.col(2)).norm(), 1e-6);
  }
}

// The covariance belongs to the same set of edges: an error d of one description is the error D d of the other.
TEST(Primitive, reversed_covariance_describes_the_same_errors) {
  Dice dice(3);
  for (int k = 0; k < 100; ++k) {
    const Geometry g = random_geometry(dice);
    const oracle::Edge x = oracle::state_of(g), y = oracle::state_of(reversed(g));
    const Eigen::Matrix<double, 6, 6> D = Eigen::Matrix<double, 6, 1>(-1, -1, 1, -1, -1, 1).asDiagonal();
    EXPECT_LT((D * x.P * D - y.P).norm(), 1e-12);
    oracle::Vector6d d = dice.normals(6) * 0.2;
    const oracle::Edge moved_then_reversed = oracle::state_of(reversed(oracle::record_of(oracle::moved(x, d))));
    const oracle::Edge reversed_then_moved = oracle::moved(y, D * d);
    EXPECT_LT((moved_then_reversed.R - reversed_then_moved.R).norm(), 1e-5);
  }
}

TEST(Primitive, reversing_twice_changes_nothing) {
  Dice dice(4);
  const Geometry g = random_geometry(dice), gg = reversed(reversed(g));
  const oracle::Edge x = oracle::state_of(g), y = oracle::state_of(gg);
  EXPECT_LT((x.R - y.R).norm(), 1e-6);
  EXPECT_EQ(gg.covariance, g.covariance);
  const AppearanceState a = random_appearance(dice), aa = reversed(reversed(a));
  EXPECT_EQ(aa.covariance, a.covariance);
  EXPECT_EQ(aa.mean.phase, a.mean.phase);
}

TEST(Primitive, reversed_appearance_swaps_sides_and_negates_the_phase) {
  Dice dice(5);
  const AppearanceState a = random_appearance(dice), r = reversed(a);
  EXPECT_EQ(r.mean.phase, -a.mean.phase);
  EXPECT_EQ(r.mean.left, a.mean.right);
  EXPECT_EQ(r.mean.right, a.mean.left);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(r.covariance[packed_index(7, 0, 1 + i)], -a.covariance[packed_index(7, 0, 4 + i)]);
    for (std::size_t j = i; j < 3; ++j)
      EXPECT_EQ(r.covariance[packed_index(7, 1 + i, 1 + j)], a.covariance[packed_index(7, 4 + i, 4 + j)]);
    for (std::size_t j = 0; j < 3; ++j)
      EXPECT_EQ(r.covariance[packed_index(7, 1 + i, 4 + j)], a.covariance[packed_index(7, 1 + j, 4 + i)]);
  }
}

}  // namespace
}  // namespace accrete
