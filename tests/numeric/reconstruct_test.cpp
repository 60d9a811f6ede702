#include "stereo/reconstruct.h"

#include <gtest/gtest.h>

#include <limits>

#include "numeric/dice.h"
#include "numeric/lane_bridge.h"
#include "stereo/reconstruct_kernel.h"

namespace accrete {
namespace {

using namespace oracle;

const Optics kOptics;
constexpr float kSlide = 1.15F, kRoll = 0.8727F;

std::pair<LineElement, LineElement> views(Dice& dice, const Edge& x, double sigma_n = 0, double sigma_theta = 0) {
  auto l = dice.observe(x, Pose(), kOptics, 0, sigma_n, sigma_theta, 0);
  auto r = dice.observe(x, Pose(), kOptics, kOptics.baseline, sigma_n, sigma_theta, 2);
  for (LineElement* e : {&l, &r}) {
    e->sigma_n_px = 0.3F;
    e->sigma_theta = 0.0349F;
  }
  return {l, r};
}
Element<double> element(const Edge& x, double offset, double slide) {
  const Image image = project(x, Pose(), kOptics, offset);
  const double c = std::cos(image.theta), s = std::sin(image.theta);
  return {image.x.x() + slide * c, image.x.y() + slide * s, c, s};
}

TEST(Reconstruct, of_noiseless_projections_is_exact) {
  Dice dice(1);
  const Noise5<double> sigma = {1.15, 0.3, 0.0349, 0.3, 0.0349};
  for (int k = 0; k < 200; ++k) {
    const Edge x = dice.edge();
    LaneState<double> y;
    // The right point lies elsewhere on the edge: the left one decides.
    ASSERT_EQ(reconstruct<double>(element(x, 0, 0), element(x, kOptics.baseline, dice.uniform(-5, 5)), sigma,
                                  kOptics.focal, kOptics.baseline, 0.8727, 0.0175, y),
              ReconstructOutcome::kOk);
    const Edge got = to_state(y);
    EXPECT_LT((got.p - x.p).norm(), 1e-12);
    EXPECT_LT((got.R.col(0) - x.R.col(0)).norm(), 1e-11);
  }
}

TEST(Reconstruct, in_float_is_exact_to_a_thousandth_of_its_sigma) {
  Dice dice(2);
  for (int k = 0; k < 200; ++k) {
    const Edge x = dice.edge();
    const auto [l, r] = views(dice, x);
    Geometry g;
    ASSERT_EQ(reconstruct(l, r, kOptics.aligned(), kSlide, kRoll, g), ReconstructOutcome::kOk);
    const Edge got = state_of(g);
    EXPECT_LT((got.p - x.p).norm(), 1e-5);
    EXPECT_LT((got.R.col(0) - x.R.col(0)).norm(), 3e-4);
  }
}

TEST(Reconstruct, frame_has_b_on_the_right_and_a_away_from_the_viewer) {
  Dice dice(3);
  for (int k = 0; k < 100; ++k) {
    const Edge x = dice.edge();
    const auto [l, r] = views(dice, x);
    Geometry g;
    ASSERT_EQ(reconstruct(l, r, kOptics.aligned(), kSlide, kRoll, g), ReconstructOutcome::kOk);
    const Edge y = state_of(g);
    EXPECT_NEAR(y.R.determinant(), 1, 1e-5);
    const Vector3d ray = y.p - Vector3d(0.5 * kOptics.baseline, 0, 0);
    EXPECT_GT(ray.dot(y.R.col(2)), 0);
    EXPECT_NEAR(ray.dot(y.R.col(1)), 0, 1e-5);
    // A point a little along b is seen on the right of the direction: along (-s, c).
    const Vector3d q = y.p + 1e-3 * y.R.col(1);
    const Vector2d d(kOptics.focal * q.x() / q.z() - double{l.x_px}, kOptics.focal * q.y() / q.z() - double{l.y_px});
    EXPECT_GT(d.dot(Vector2d(-double{l.s}, double{l.c})), 0.3);
  }
}

TEST(Reconstruct, the_slide_moves_the_point_along_the_edge_only) {
  Dice dice(4);
  for (int k = 0; k < 50; ++k) {
    const Edge x = dice.edge();
    LaneState<double> with, without;
    const Noise5<double> sigma = {3, 0.3, 0.0349, 0.3, 0.0349}, none = {0, 0.3, 0.0349, 0.3, 0.0349};
    const auto run = [&](const Noise5<double>& s, LaneState<double>& y) {
      return reconstruct<double>(element(x, 0, 0), element(x, kOptics.baseline, 0), s, kOptics.focal, kOptics.baseline,
                                 0.8727, 0.0175, y);
    };
    ASSERT_EQ(run(sigma, with), ReconstructOutcome::kOk);
    ASSERT_EQ(run(none, without), ReconstructOutcome::kOk);
    const Matrix6d difference = to_state(with).P - to_state(without).P;
    const Vector3d t = x.R.col(0);
    const double along = difference(0, 0);
    EXPECT_GT(along, 1e-8);
    Matrix6d expected = Matrix6d::Zero();
    expected(0, 0) = along;
    EXPECT_LT((difference - expected).norm(), 0.1 * along);  // curvature: pixels are not evenly spaced along it
    // Exactly: slid along the image of the edge, the left element is the same edge.
    const EdgePoint<double> slid = intersect<double>(moved<double>(element(x, 0, 0), dice.uniform(-5, 5), 0, 0),
                                                     element(x, kOptics.baseline, 0), kOptics.focal, kOptics.baseline);
    EXPECT_LT(Vector3d(slid.point - x.p).cross(t).norm(), 1e-12);
    EXPECT_LT((slid.tangent - t).norm(), 1e-11);
  }
}

TEST(Reconstruct, is_reversal_invariant) {
  Dice dice(5);
  for (int k = 0; k < 50; ++k) {
    const auto [l, r] = views(dice, dice.edge(), 0.3, 0.035);
    Geometry a, b;
    ASSERT_EQ(reconstruct(l, r, kOptics.aligned(), kSlide, kRoll, a), ReconstructOutcome::kOk);
    ASSERT_EQ(reconstruct(reversed(l), reversed(r), kOptics.aligned(), kSlide, kRoll, b), ReconstructOutcome::kOk);
    const Edge x = state_of(a), y = state_of(reversed(b));
    EXPECT_LT((x.p - y.p).norm(), 1e-6);
    EXPECT_LT((x.R - y.R).norm(), 1e-5);
    const Vector6d s = x.P.diagonal().cwiseSqrt().cwiseInverse();
    EXPECT_LT((s.asDiagonal() * (x.P - y.P) * s.asDiagonal()).norm(), 1e-3);
  }
}

TEST(Reconstruct, refuses_degenerate_pairs_and_points_behind) {
  Geometry g;
  g.position = {9, 9, 9};
  const auto outcome = [&](float x_l, float y_l, float theta_l, float x_r, float y_r, float theta_r) {
    const LineElement l = {x_l, y_l, std::cos(theta_l), std::sin(theta_l), 0.3F, 0.035F};
    const LineElement r = {x_r, y_r, std::cos(theta_r), std::sin(theta_r), 0.3F, 0.035F};
    return reconstruct(l, r, kOptics.aligned(), kSlide, kRoll, g);
  };
  const float pi = 3.14159265F;
  EXPECT_EQ(outcome(50, 20, 0, -50, 20, 0), ReconstructOutcome::kDegenerate);  // along the epipolar line
  EXPECT_EQ(outcome(50, 20, 0.004F, -50, 20, 0.004F), ReconstructOutcome::kDegenerate);
  EXPECT_EQ(outcome(50, 20, pi / 2, 45, 20, pi / 2), ReconstructOutcome::kDegenerate);  // 150 baselines away
  EXPECT_EQ(outcome(50, 20, pi / 2, 50, 20, pi / 2), ReconstructOutcome::kDegenerate);  // no disparity
  EXPECT_EQ(outcome(-50, 20, pi / 2, 50, 20, pi / 2), ReconstructOutcome::kBehind);
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  EXPECT_EQ(outcome(nan, 20, pi / 2, 0, 20, pi / 2), ReconstructOutcome::kDegenerate);
  EXPECT_NE(outcome(50, 20, pi / 2, -inf, 20, pi / 2), ReconstructOutcome::kOk);
  EXPECT_EQ(g.position[0], 9.0F);  // nothing was written
  EXPECT_EQ(outcome(50, 20, pi / 2, -50, 20, pi / 2), ReconstructOutcome::kOk);
  EXPECT_NE(g.position[0], 9.0F);
}

TEST(Reconstruct, covariances_are_positive_definite_for_any_noise) {
  Dice dice(6);
  int good = 0;
  for (int k = 0; k < 3000; ++k) {
    auto [l, r] = views(dice, dice.edge(), 1, 0.1);
    for (LineElement* e : {&l, &r}) {
      e->sigma_n_px = static_cast<float>(std::pow(10, dice.uniform(-4, 1.5)));
      e->sigma_theta = static_cast<float>(std::pow(10, dice.uniform(-5, 0)));
    }
    Geometry g;
    if (reconstruct(l, r, kOptics.aligned(), kSlide, kRoll, g) != ReconstructOutcome::kOk) continue;
    ++good;
    ASSERT_GT(smallest_scaled_eigenvalue(covariance_of(g)), 0);
    for (const float v : g.quaternion) ASSERT_TRUE(std::isfinite(v));
  }
  EXPECT_GT(good, 2000);
}

TEST(Transform, takes_a_primitive_into_another_frame) {
  Dice dice(7);
  for (int k = 0; k < 100; ++k) {
    const Geometry g = record_of(dice.edge());
    const Edge x = state_of(g);
    const Matrix3d R = dice.rotation();
    const Vector3d t = dice.normal3();
    Pose pose;
    pose.R = R;
    pose.t = t;
    const AlignedPose a = pose.aligned();
    Geometry moved_geometry = g;
    ASSERT_TRUE(transform(moved_geometry, a.R, a.t));
    const Edge y = state_of(moved_geometry);
    EXPECT_LT((y.p - (R * x.p + t)).norm(), 1e-6);
    EXPECT_LT((y.R - R * x.R).norm(), 1e-6);
    EXPECT_EQ(y.P, x.P);  // of errors in the own frame
  }
}

}  // namespace
}  // namespace accrete
