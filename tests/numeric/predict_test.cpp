#include "predict/predict.h"

#include <gtest/gtest.h>

#include <limits>

#include "math/lane_records.h"
#include "numeric/dice.h"
#include "numeric/lane_bridge.h"
#include "predict/rigid_kernel.h"

namespace accrete {
namespace {

using namespace oracle;

struct Scene {
  std::vector<GeometryBlock> blocks;
  std::vector<Edge> states;
  Pose pose;
};

Scene random_scene(unsigned seed, std::size_t n) {
  Dice dice(seed);
  Scene scene;
  scene.blocks.resize((n + 15) / 16);
  Edge first = dice.edge();
  scene.pose = dice.pose(first);
  for (std::size_t i = 0; i < n; ++i) {
    Edge x = dice.edge();
    const Matrix3d back = scene.pose.R.transpose();
    x.p = back * (x.p - scene.pose.t);
    x.R = back * x.R;
    store(record_of(x), scene.blocks[i / 16], i % 16);
    scene.states.push_back(state_of(load(scene.blocks[i / 16], i % 16)));
  }
  return scene;
}

// The covariance that the state causes: the oracle's residuals against its own noiseless projection.
Matrix4d expected_covariance(const Edge& x, const Pose& pose, const Optics& optics) {
  std::vector<Observation> o;
  for (const double offset : {0.0, optics.baseline}) {
    const Image image = project(x, pose, optics, offset);
    LineElement e;
    e.x_px = static_cast<float>(image.x.x());
    e.y_px = static_cast<float>(image.x.y());
    e.c = static_cast<float>(std::cos(image.theta));
    e.s = static_cast<float>(std::sin(image.theta));
    o.push_back({offset, e});
  }
  return unscented_of_edge(x.P, [&](const VectorXd& d) { return residuals(moved(x, d), pose, optics, o); }).covariance;
}

Matrix4d covariance_of(const PredictedObservation& o) {
  Matrix4d c;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i; j < 4; ++j)
      c(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          c(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(i)) = o.covariance[packed_index(4, i, j)];
  return c;
}

TEST(Predict, projects_point_and_direction_into_both_cameras) {
  const Optics optics;
  const std::size_t n = 53;  // not a multiple of any lane width
  const Scene scene = random_scene(1, n);
  std::vector<std::uint32_t> slots;
  for (std::size_t i = 0; i < n; ++i) slots.push_back(static_cast<std::uint32_t>((i * 17) % n));
  slots.push_back(slots[3]);  // repeated
  std::vector<PredictedObservation> out(slots.size());
  predict_observations(scene.blocks, slots, scene.pose.aligned(), optics.aligned(), out);
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const Edge& x = scene.states[slots[i]];
    const Image l = project(x, scene.pose, optics, 0), r = project(x, scene.pose, optics, optics.baseline);
    ASSERT_TRUE(out[i].valid);
    EXPECT_NEAR(out[i].x_l, l.x.x(), 2e-3);
    EXPECT_NEAR(out[i].y_l, l.x.y(), 2e-3);
    EXPECT_NEAR(out[i].x_r, r.x.x(), 2e-3);
    EXPECT_NEAR(out[i].y_r, r.x.y(), 2e-3);
    EXPECT_NEAR(out[i].c_l, std::cos(l.theta), 1e-5);
    EXPECT_NEAR(out[i].s_l, std::sin(l.theta), 1e-5);
    EXPECT_NEAR(out[i].c_r, std::cos(r.theta), 1e-5);
    EXPECT_NEAR(out[i].s_r, std::sin(r.theta), 1e-5);
    EXPECT_NEAR(out[i].depth_m, (scene.pose.R * x.p + scene.pose.t).z(), 1e-5);
  }
}

TEST(Predict, covariance_is_the_unscented_one_with_each_points_own_normal) {
  const Optics optics;
  const Scene scene = random_scene(2, 64);
  std::vector<std::uint32_t> slots(64);
  for (std::uint32_t i = 0; i < 64; ++i) slots[i] = i;
  std::vector<PredictedObservation> out(64);
  predict_observations(scene.blocks, slots, scene.pose.aligned(), optics.aligned(), out);
  for (std::size_t i = 0; i < 64; ++i) {
    const Matrix4d expected = expected_covariance(scene.states[i], scene.pose, optics), got = covariance_of(out[i]);
    const Eigen::Vector4d s = expected.diagonal().cwiseSqrt().cwiseInverse();
    EXPECT_LT((s.asDiagonal() * (got - expected) * s.asDiagonal()).norm(), 1e-3) << got << "\n\n" << expected;
    EXPECT_GT(smallest_scaled_eigenvalue(got), 0);
  }
}

// For a small covariance the unscented transform is the first order: J P Jt with a numerical Jacobian.
TEST(Predict, small_covariance_is_propagated_by_the_jacobian) {
  const Optics optics;
  Dice dice(3);
  for (int k = 0; k < 20; ++k) {
    Edge x = dice.edge(1e-5, 1e-3, 1e-3);
    const Pose pose = dice.pose(x);
    const Geometry g = record_of(x);
    x = state_of(g);
    std::vector<Observation> o;
    for (const double offset : {0.0, optics.baseline})
      o.push_back({offset, dice.observe(x, pose, optics, offset, 0, 0, 0)});
    Eigen::Matrix<double, 4, 6> J;
    for (int i = 0; i < 6; ++i) {
      Vector6d d = Vector6d::Zero();
      d[i] = 1e-6;
      J.col(i) = (residuals(moved(x, d), pose, optics, o) - residuals(moved(x, -d), pose, optics, o)) / 2e-6;
    }
    std::vector<GeometryBlock> block(1);
    store(g, block[0], 5);
    const std::uint32_t slot = 5;
    PredictedObservation out;
    predict_observations(block, {&slot, 1}, pose.aligned(), optics.aligned(), {&out, 1});
    const Matrix4d expected = J * x.P * J.transpose();
    const Eigen::Vector4d s = expected.diagonal().cwiseSqrt().cwiseInverse();
    EXPECT_LT((s.asDiagonal() * (covariance_of(out) - expected) * s.asDiagonal()).norm(), 5e-3);
  }
}

TEST(Predict, refuses_what_cannot_be_seen) {
  Dice dice(4);
  const Optics optics;
  std::vector<GeometryBlock> blocks(1);
  const Edge good = dice.edge();
  for (std::size_t l = 0; l < 16; ++l) store(record_of(good), blocks[0], l);
  blocks[0].row[2][0] = -0.5F;                                    // behind
  blocks[0].row[2][1] = 1e-4F;                                    // in the plane of the cameras
  blocks[0].row[0][2] = std::numeric_limits<float>::quiet_NaN();  // no number
  blocks[0].row[4][3] = std::numeric_limits<float>::infinity();
  blocks[0].row[7][4] = -1.0F;  // no covariance
  for (std::size_t r = 7; r < 28; ++r) blocks[0].row[r][5] = 0;
  Edge away = good;  // its line passes through the left camera: the image is a point
  away.R.col(0) = away.p.normalized();
  away.R.col(1) = away.R.col(0).unitOrthogonal();
  away.R.col(2) = away.R.col(0).cross(away.R.col(1));
  store(record_of(away), blocks[0], 6);
  std::vector<std::uint32_t> slots(16);
  for (std::uint32_t i = 0; i < 16; ++i) slots[i] = i;
  std::vector<PredictedObservation> out(16);
  predict_observations(blocks, slots, Pose().aligned(), optics.aligned(), out);
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_EQ(out[i].valid, i > 6) << i;
    EXPECT_TRUE(std::isfinite(out[i].x_l) && std::isfinite(out[i].s_r) && std::isfinite(out[i].covariance[9]));
  }
}

// The other description of the same edge: directions turn, offsets change sign, and all covariances with them.
TEST(Predict, is_reversal_invariant) {
  Dice dice(5);
  const Optics optics;
  std::vector<GeometryBlock> blocks(1);
  std::vector<std::uint32_t> slots(16);
  for (std::uint32_t i = 0; i < 16; i += 2) {
    const Geometry g = record_of(dice.edge());
    store(g, blocks[0], i);
    store(reversed(g), blocks[0], i + 1);
    slots[i] = i;
    slots[i + 1] = i + 1;
  }
  std::vector<PredictedObservation> out(16);
  predict_observations(blocks, slots, Pose().aligned(), optics.aligned(), out);
  for (std::size_t i = 0; i < 16; i += 2) {
    const PredictedObservation &a = out[i], &b = out[i + 1];
    EXPECT_EQ(a.x_l, b.x_l);
    EXPECT_NEAR(a.c_l, -b.c_l, 1e-6F);
    EXPECT_NEAR(a.s_r, -b.s_r, 1e-6F);
    const Eigen::Vector4d sign(-1, 1, -1, 1);
    const Matrix4d expected = sign.asDiagonal() * covariance_of(a) * sign.asDiagonal();
    EXPECT_LT((covariance_of(b) - expected).norm(), 1e-4 * expected.norm());
  }
}

TEST(Predict, closed_form_of_a_rigid_motion_is_the_unscented_transform) {
  Dice dice(6);
  for (int k = 0; k < 50; ++k) {
    const Edge x = dice.edge(5e-3, 0.3, 0.9);
    const Matrix3d R = dice.rotation();
    const Vector3d t = dice.normal3();
    // Oracle: move the map under every sigma point, and read the error off in the moved state's own terms.
    Edge predicted = x;
    predicted.p = R * x.p + t;
    predicted.R = R * x.R;
    const Moments m = unscented(x.P, [&](const VectorXd& d) {
      const Edge y = moved(x, d);
      const Matrix3d relative = predicted.R.transpose() * (R * y.R);
      // Inverse of the retraction: the tilt that takes e_x to the tangent, then the roll that is left.
      const Vector3d tangent = relative.col(0);
      const double sine = std::hypot(tangent.y(), tangent.z()),
                   s = std::atan2(sine, tangent.x()) / std::max(sine, 1e-300);
      const Vector3d tilt(0, -tangent.z() * s, tangent.y() * s);
      const Matrix3d roll = exp_so3(tilt).transpose() * relative;
      VectorXd e(6);
      e << predicted.R.transpose() * (R * y.p + t - predicted.p), std::atan2(roll(2, 1), roll(1, 1)), tilt.y(),
          tilt.z();
      return e;
    });
    LaneState<double> lane = to_lane<double>(x);
    const Eigen::Quaterniond q(R);
    double rotation[9];
    for (int i = 0; i < 9; ++i) rotation[i] = R(i / 3, i % 3);
    predict_rigid(lane, rotation, Quat<double>{q.x(), q.y(), q.z(), q.w()}, t.data());
    const Edge got = to_state(lane);
    EXPECT_LT((got.p - predicted.p).norm(), 1e-12);
    EXPECT_LT((got.R - predicted.R).norm(), 1e-12);
    EXPECT_LT(m.mean.norm(), 1e-12);
    EXPECT_LT((got.P - m.covariance).norm(), 1e-12 * m.covariance.norm());
  }
}

// Every lane into a record of its own, in the opposite order; what is around them is not touched.
template <class S>
void expect_quads_stored() {
  constexpr int N = LaneTraits<S>::kLanes;
  constexpr int kStride = 7;
  float memory[kStride * N];
  for (float& m : memory) m = -1;
  S x[4];
  float* to[N];
  for (int m = 0; m < 4; ++m) {
    float value[N];
    for (int l = 0; l < N; ++l) value[l] = static_cast<float>(10 * l + m);
    x[m] = load_lanes<S>(value);
  }
  for (int l = 0; l < N; ++l) to[l] = memory + kStride * (N - 1 - l) + 2;
  store_quads(x, to);
  for (int r = 0; r < N; ++r)
    for (int k = 0; k < kStride; ++k) {
      const bool inside = k >= 2 && k < 6;
      EXPECT_EQ(memory[kStride * r + k], inside ? static_cast<float>(10 * (N - 1 - r) + k - 2) : -1.0F)
          << r << ' ' << k;
    }
}

TEST(StoreQuads, transpose_into_records) {
  expect_quads_stored<float>();
  expect_quads_stored<double>();
  expect_quads_stored<Pack<4>>();
  expect_quads_stored<Pack<8>>();
  expect_quads_stored<Pack<16>>();
}

}  // namespace
}  // namespace accrete
