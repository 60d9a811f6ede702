#include "filter/update.h"

#include <gtest/gtest.h>

#include "filter/update_kernel.h"
#include "numeric/dice.h"
#include "numeric/lane_bridge.h"

namespace accrete {
namespace {

using namespace oracle;

constexpr double kInf = std::numeric_limits<double>::infinity();

template <class S>
View<S> view_of(const LineElement& e, double offset) {
  return {S(e.x_px), S(e.y_px), S(e.c), S(e.s), S(offset)};
}

Edge kernel_update(const Edge& x, const Pose& pose, const Optics& optics, const std::vector<Observation>& o) {
  LaneState<double> lane = to_lane<double>(x);
  View<double> views[2];
  double variance[4];
  for (std::size_t i = 0; i < o.size(); ++i) {
    views[i] = view_of<double>(o[i].z, o[i].offset);
    variance[2 * i] = std::pow(double{o[i].z.sigma_n_px}, 2);
    variance[2 * i + 1] = std::pow(double{o[i].z.sigma_theta}, 2);
  }
  const Updated<double> done = o.size() == 2
                                   ? update_geometry<2>(lane, views, variance, pose.aligned(), optics.aligned(), kInf)
                                   : update_geometry<1>(lane, views, variance, pose.aligned(), optics.aligned(), kInf);
  EXPECT_TRUE(done.in_front);
  EXPECT_TRUE(done.good);
  return to_state(lane);
}

// Errors in units of the posterior's standard deviations.
void expect_same(const Edge& got, const Edge& expected, double tolerance) {
  const Vector6d s = expected.P.diagonal().cwiseSqrt().cwiseInverse();
  EXPECT_LT((s.asDiagonal() * (got.P - expected.P) * s.asDiagonal()).norm(), tolerance);
  EXPECT_LT((s.head<3>().cwiseProduct(got.p - expected.p)).norm(), tolerance);
  const Eigen::AngleAxisd turn(Matrix3d(expected.R.transpose() * got.R));
  EXPECT_LT(turn.angle() * s.tail<3>().maxCoeff(), tolerance);
}

// Poses and optics pass through float on the kernel's side; the oracle uses the same rounded values.
Pose rounded(const Pose& pose) {
  Pose r;
  const AlignedPose a = pose.aligned();
  for (int i = 0; i < 9; ++i) r.R(i / 3, i % 3) = double{a.R[i]};
  for (int i = 0; i < 3; ++i) r.t[i] = double{a.t[i]};
  return r;
}
Optics rounded(const Optics& o) { return {double{o.aligned().focal_px}, double{o.aligned().baseline_m}}; }

TEST(UpdateKernel, stereo_is_the_plain_unscented_update) {
  Dice dice(1);
  const Optics optics = rounded(Optics{});
  for (int k = 0; k < 100; ++k) {
    Edge x = dice.edge(2e-3, 0.15, 0.8);
    const Pose pose = rounded(dice.pose(x));
    const Edge truth = moved(x, 0.7 * MatrixXd(x.P.llt().matrixL()) * dice.normals(6));
    const std::vector<Observation> o = {
        {0, dice.observe(truth, pose, optics, 0, 0.3, 0.03, 3)},
        {optics.baseline, dice.observe(truth, pose, optics, optics.baseline, 0.3, 0.03, 3)}};
    expect_same(kernel_update(x, pose, optics, o), updated(x, pose, optics, o), 2e-4);
  }
}

TEST(UpdateKernel, mono_is_the_plain_unscented_update_in_either_eye) {
  Dice dice(2);
  const Optics optics = rounded(Optics{});
  for (int k = 0; k < 100; ++k) {
    Edge x = dice.edge(2e-3, 0.15, 0.8);
    const Pose pose = rounded(dice.pose(x));
    const Edge truth = moved(x, 0.7 * MatrixXd(x.P.llt().matrixL()) * dice.normals(6));
    const double offset = k % 2 == 0 ? 0 : optics.baseline;
    const std::vector<Observation> o = {{offset, dice.observe(truth, pose, optics, offset, 0.3, 0.03, 3)}};
    expect_same(kernel_update(x, pose, optics, o), updated(x, pose, optics, o), 2e-4);
  }
}

// A small covariance makes the observation linear: there the unscented update is the Kalman update with the Jacobian.
TEST(UpdateKernel, unscented_is_kalman_when_linear) {
  Dice dice(3);
  const Optics optics = rounded(Optics{});
  for (int k = 0; k < 50; ++k) {
    Edge x = dice.edge(1e-6, 1e-5, 1e-5);
    const Pose pose = rounded(dice.pose(x));
    std::vector<Observation> o = {{0, dice.observe(x, pose, optics, 0, 1e-3, 1e-5, 0)},
                                  {optics.baseline, dice.observe(x, pose, optics, optics.baseline, 1e-3, 1e-5, 0)}};
    Eigen::Matrix<double, 4, 6> H;
    for (int i = 0; i < 6; ++i) {
      Vector6d d = Vector6d::Zero();
      d[i] = 1e-6;
      H.col(i) = -(residuals(moved(x, d), pose, optics, o) - residuals(moved(x, -d), pose, optics, o)) / 2e-6;
    }
    Eigen::Vector4d noise;
    for (int i = 0; i < 4; ++i)
      noise[i] = std::pow(double{i % 2 == 0 ? o[i / 2U].z.sigma_n_px : o[i / 2U].z.sigma_theta}, 2);
    const Matrix4d S = H * x.P * H.transpose() + Matrix4d(noise.asDiagonal());
    const Eigen::Matrix<double, 6, 4> K = x.P * H.transpose() * S.inverse();
    Edge expected = moved(x, K * residuals(x, pose, optics, o));
    expected.P = x.P - K * S * K.transpose();
    // The kernel adds (0.1 um)^2 and (1 urad)^2 so that nothing ever shrinks to zero.
    expected.P.diagonal() +=
        (Vector6d() << kPositionFloor, kPositionFloor, kPositionFloor, kRotationFloor, kRotationFloor, kRotationFloor)
            .finished();
    expect_same(kernel_update(x, pose, optics, o), expected, 1e-3);
  }
}

struct Batch {
  std::vector<GeometryBlock> blocks;
  std::vector<std::uint32_t> slots;
  std::vector<LineElement> left, right;
  Pose pose;
};
Batch random_batch(unsigned seed, std::size_t n) {
  Dice dice(seed);
  Batch b;
  b.blocks.resize((n + 15) / 16);
  const Optics optics;
  for (std::size_t i = 0; i < n; ++i) {
    const Edge x = dice.edge(3e-3, 0.2, 0.8);
    store(record_of(x), b.blocks[i / 16], i % 16);
    const Edge truth = moved(x, MatrixXd(x.P.llt().matrixL()) * dice.normals(6));
    b.left.push_back(dice.observe(truth, b.pose, optics, 0, 0.3, 0.035, 2));
    b.right.push_back(dice.observe(truth, b.pose, optics, optics.baseline, 0.3, 0.035, 2));
    b.slots.push_back(static_cast<std::uint32_t>(i));
  }
  std::shuffle(b.slots.begin(), b.slots.end(), dice.engine());
  const std::vector<LineElement> left = b.left, right = b.right;
  for (std::size_t i = 0; i < n; ++i) {
    b.left[i] = left[b.slots[i]];
    b.right[i] = right[b.slots[i]];
  }
  return b;
}

TEST(UpdateStereo, float_lanes_agree_with_the_double_oracle) {
  const Optics optics;
  Batch b = random_batch(4, 333);
  const std::vector<GeometryBlock> before = b.blocks;
  std::vector<UpdateOutcome> out(b.slots.size());
  update_stereo(b.blocks, b.slots, b.left, b.right, b.pose.aligned(), optics.aligned(), out);
  for (std::size_t i = 0; i < b.slots.size(); ++i) {
    ASSERT_EQ(out[i], UpdateOutcome::kUpdated);
    const std::uint32_t s = b.slots[i];
    const Edge x = state_of(load(before[s / 16], s % 16)), y = state_of(load(b.blocks[s / 16], s % 16));
    const Edge expected = updated(x, b.pose, optics, {{0, b.left[i]}, {optics.baseline, b.right[i]}});
    expect_same(y, expected, 5e-3);
  }
}

TEST(UpdateStereo, touches_only_the_slots_that_it_is_given) {
  const Optics optics;
  Batch b = random_batch(5, 64);
  const std::vector<GeometryBlock> before = b.blocks;
  b.slots.resize(21);
  b.left.resize(21);
  b.right.resize(21);
  std::vector<UpdateOutcome> out(21);
  update_stereo(b.blocks, b.slots, b.left, b.right, b.pose.aligned(), optics.aligned(), out);
  for (std::uint32_t s = 0; s < 64; ++s) {
    const bool given = std::find(b.slots.begin(), b.slots.end(), s) != b.slots.end();
    EXPECT_EQ(load(b.blocks[s / 16], s % 16).covariance != load(before[s / 16], s % 16).covariance, given);
  }
}

// Whatever the width, each lane computes the same. Where the processor fuses multiplication and addition the compiler
// may do so differently in each width, unless it is told not to (the preset `deterministic`).
template <class S>
std::vector<float> updated_floats(const Batch& b) {
  std::vector<float> all;
  const Optics optics;
  constexpr int n = LaneTraits<S>::kLanes;
  for (std::size_t i = 0; i + n <= b.slots.size(); i += n) {
    float x[16][40];
    for (std::size_t l = 0; l < n; ++l) {
      const std::uint32_t s = b.slots[i + l];
      const LineElement *e = &b.left[i + l], *r = &b.right[i + l];
      for (std::size_t k = 0; k < 28; ++k) x[l][k] = b.blocks[s / 16].row[k][s % 16];
      const float elements[8] = {e->x_px, e->y_px, e->c, e->s, r->x_px, r->y_px, r->c, r->s};
      std::copy(elements, elements + 8, x[l] + 28);
    }
    const auto column = [&](int k) {
      float v[16];
      for (int l = 0; l < n; ++l) v[l] = x[l][k];
      return load_lanes<S>(v);
    };
    LaneState<S> state;
    state.p = {column(0), column(1), column(2)};
    state.q = {column(3), column(4), column(5), column(6)};
    for (int k = 0; k < 21; ++k) state.P.v[k] = column(7 + k);
    const View<S> views[2] = {{column(28), column(29), column(30), column(31), S(0)},
                              {column(32), column(33), column(34), column(35), S(0.12F)}};
    const S variance[4] = {S(0.09F), S(1e-3F), S(0.09F), S(1e-3F)};
    update_geometry<2>(state, views, variance, b.pose.aligned(), optics.aligned(), S(1e-5F));
    for (int l = 0; l < n; ++l) {
      for (int k = 0; k < 3; ++k) all.push_back(lane(state.p[k], l));
      all.push_back(lane(state.q.w, l));
      for (int k = 0; k < 21; ++k) all.push_back(lane(state.P.v[k], l));
    }
  }
  return all;
}

TEST(UpdateKernel, every_lane_width_gives_the_same_result) {
  const Batch b = random_batch(6, 160);
  const std::vector<float> one = updated_floats<float>(b);
  for (const std::vector<float>& other :
       {updated_floats<Pack<4>>(b), updated_floats<Pack<8>>(b), updated_floats<Pack<16>>(b)}) {
    ASSERT_EQ(other.size(), one.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
#if defined(__FP_FAST_FMAF) || defined(__FMA__)
      EXPECT_NEAR(other[i], one[i], 1e-3F * std::abs(one[i]) + 1e-7F);
#else
      EXPECT_EQ(other[i], one[i]);
#endif
    }
  }
}

}  // namespace
}  // namespace accrete
