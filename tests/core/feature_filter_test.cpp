// The filter of any kind of feature: against the edge's own kernels, against a Kalman filter, and the laws of each
// kind.
#include <gtest/gtest.h>

#include <limits>

#include "core/feature_world.h"
#include "feature/motion.h"
#include "filter/update.h"
#include "math/record_state.h"
#include "predict/predict.h"
#include "predict/rigid_kernel.h"

namespace accrete::test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// An estimate near the truth, with a covariance like that of a birth.
template <class F>
feature::Estimate<F, float> guess(Dice& dice, const typename F::template State<float>& truth, double sigma_m,
                                  double sigma_rad) {
  constexpr int N = F::kTangent;
  feature::Estimate<F, float> e;
  oracle::VectorXd sigma(N);
  for (int i = 0; i < N; ++i) sigma[i] = i < 3 ? sigma_m : sigma_rad;
  const oracle::MatrixXd P = dice.covariance(sigma);
  for (int i = 0; i < N; ++i)
    for (int j = i; j < N; ++j) e.P(i, j) = static_cast<float>(P(i, j));
  const oracle::VectorXd d = P.llt().matrixL() * dice.normals(N);
  float step[N];
  for (int i = 0; i < N; ++i) step[i] = static_cast<float>(d[i]);
  e.x = F::retract(truth, step);
  return e;
}

template <int N>
double difference_of(const Symmetric<float, N>& a, const Symmetric<float, N>& b) {  // in units of deviations
  double worst = 0;
  for (int i = 0; i < N; ++i)
    for (int j = i; j < N; ++j)
      worst = std::max(worst, std::fabs(double{a(i, j)} - b(i, j)) / std::sqrt(double{b(i, i)} * b(j, j)));
  return worst;
}

Geometry record_of_estimate(const feature::Estimate<Edge, float>& e) {
  return accrete::record_of(LaneState<float>{e.x.p, e.x.q, e.P});
}

TEST(FeatureFilter, an_edge_is_updated_as_its_lane_kernels_do) {
  Dice dice(1);
  const Optics optics;
  for (const bool stereo : {true, false}) {
    for (int k = 0; k < 100; ++k) {
      const Truth<Edge> truth(dice);
      feature::Estimate<Edge, float> e = guess<Edge>(dice, truth.state(), 2e-3, 0.1);
      std::vector<GeometryBlock> block(1);
      const std::uint32_t slot = 3;
      store(record_of_estimate(e), block[0], slot);
      const Pose pose;
      const Edge::View<float> seen[2] = {truth.observe(dice, pose, optics, 0),
                                         truth.observe(dice, pose, optics, optics.baseline)};
      const auto element = [](const Edge::View<float>& v) {
        return LineElement{v.x, v.y, v.c, v.s, v.sigma_px, v.sigma_angle};
      };
      const LineElement l = element(seen[0]), r = element(seen[1]);
      UpdateOutcome outcome{};
      const Eye right = Eye::kRight;
      const auto cameras = feature::cameras<float>(pose.aligned(), optics.aligned());
      if (stereo)
        update_stereo(block, {&slot, 1}, {&l, 1}, {&r, 1}, pose.aligned(), optics.aligned(), {&outcome, 1});
      else
        update_mono(block, {&slot, 1}, {&r, 1}, {&right, 1}, pose.aligned(), optics.aligned(), {&outcome, 1});
      const auto done = stereo ? feature::update<Edge, 2>(e, cameras.data(), seen)
                               : feature::update<Edge, 1>(e, &cameras[1], &seen[1]);
      ASSERT_TRUE(done.good && done.visible);
      ASSERT_EQ(outcome, UpdateOutcome::kUpdated);
      const LaneState<float> kernel = accrete::state_of<float>(load(block[0], slot));
      float d[6];
      Edge::local(e.x, {kernel.p, kernel.q}, d);
      for (int i = 0; i < 6; ++i) EXPECT_LT(std::fabs(d[i]), 2e-3 * std::sqrt(e.P(i, i))) << i;
      EXPECT_LT(difference_of<6>(e.P, kernel.P), 2e-3);
    }
  }
}

TEST(FeatureFilter, an_edge_moves_as_its_lane_kernels_do) {
  Dice dice(2);
  for (int k = 0; k < 50; ++k) {
    const Truth<Edge> truth(dice);
    feature::Estimate<Edge, float> e = guess<Edge>(dice, truth.state(), 2e-3, 0.1);
    LaneState<float> kernel{e.x.p, e.x.q, e.P};
    const Matrix3d R = dice.rotation();
    const Vector3d t = dice.normal3();
    float rotation[9];
    for (int i = 0; i < 9; ++i) rotation[i] = static_cast<float>(R(i / 3, i % 3));
    const Vector3<float> tf = t.cast<float>();
    predict_rigid(kernel, rotation, quat<float>(R), tf.data());
    feature::move(e, feature::Rigid<float>{R.cast<float>(), quat<float>(R), tf});
    PoseCovariance covariance{};
    for (std::size_t i = 0; i < 6; ++i) covariance[7 * i] = 1e-6;
    const MotionNoise noise = motion_noise_in_map({{0, 0, 0, 1}, {0.1, -0.2, 0.3}}, covariance);
    add_motion_noise(kernel, noise);
    ASSERT_TRUE(feature::add_motion_noise(e, noise));
    float d[6];
    Edge::local(e.x, {kernel.p, kernel.q}, d);
    for (int i = 0; i < 6; ++i) EXPECT_LT(std::fabs(d[i]), 2e-6) << i;
    EXPECT_LT(difference_of<6>(e.P, kernel.P), 2e-3);
  }
}

TEST(FeatureFilter, the_appearance_of_an_edge_is_updated_as_its_lane_kernel_does) {
  Dice dice(3);
  for (int k = 0; k < 50; ++k) {
    LaneAppearance<float> kernel;
    feature::LinearEstimate<float, 7> e;
    const oracle::MatrixXd P = dice.covariance(oracle::VectorXd::Constant(7, 0.1));
    float seen[7], noise[7], process[7];
    for (int i = 0; i < 7; ++i) {
      kernel.mean[i] = e.mean[i] = static_cast<float>(i == 0 ? dice.uniform(-3.1, 3.1) : dice.uniform(0, 1));
      seen[i] = static_cast<float>(i == 0 ? dice.uniform(-3.1, 3.1) : dice.uniform(0, 1));
      noise[i] = static_cast<float>(dice.uniform(0.001, 0.1));
      process[i] = 0.001F;
      for (int j = i; j < 7; ++j) kernel.P(i, j) = e.P(i, j) = static_cast<float>(P(i, j));
    }
    ASSERT_EQ(feature::update_linear<1>(e, seen, noise, process), update_appearance(kernel, seen, noise, process));
    for (int i = 0; i < 7; ++i) EXPECT_NEAR(e.mean[i], kernel.mean[i], 1e-6);
    EXPECT_LT(difference_of<7>(e.P, kernel.P), 1e-5);
  }
}

// A kind as simple as can be, and linear: a point whose coordinates each eye measures in its own frame.
struct Point {
  static constexpr bool kPositionInMap = true;
  static constexpr int kTangent = 3, kObservable = 3, kAcross = 2, kSenses = 1, kPhases = 0, kColours = 1;
  static constexpr double kSpread2 = 3;
  static constexpr int residuals(int eyes) { return 3 * eyes; }
  template <class S>
  struct State {
    Vector3<S> p;
  };
  template <class S>
  struct View {
    Vector3<S> q;
    S sigma;
  };
  template <class S>
  static State<S> retract(const State<S>& x, const S* d) {
    return {{x.p[0] + d[0], x.p[1] + d[1], x.p[2] + d[2]}};
  }
  template <class S>
  static void local(const State<S>& from, const State<S>& to, S* d) {
    for (int i = 0; i < 3; ++i) d[i] = to.p[i] - from.p[i];
  }
  template <class S>
  static void settle(Symmetric<S, 3>&, const S*) {}
  template <class S>
  static State<S> moved(const State<S>& x, const feature::Rigid<S>& motion) {
    return {motion * x.p};
  }
  template <class S>
  static Bool<S> look(const State<S>& x, const feature::Camera<S>& camera, View<S>& view) {
    view = {feature::Rigid<S>{camera.R, {}, camera.t} * x.p, S(0)};
    return S(0) == S(0);
  }
  template <int Eyes, class S>
  static void difference(const View<S>* predicted, const View<S>* observed, S* r) {
    for (int m = 0; m < 3 * Eyes; ++m) r[m] = observed[m / 3].q[m % 3] - predicted[m / 3].q[m % 3];
  }
  template <int Eyes, class S>
  static void noise(const View<S>* observed, Symmetric<S, 3 * Eyes>& R) {
    for (S& v : R.v) v = S(0);
    for (int m = 0; m < 3 * Eyes; ++m) R(m, m) = observed[m / 3].sigma * observed[m / 3].sigma;
  }
  template <class S>
  static void observable(const State<S>& from, const State<S>& to, S* d, S (*J)[3]) {
    local(from, to, d);
    for (int i = 0; i < 9; ++i) J[i / 3][i % 3] = S(i / 3 == i % 3 ? 1 : 0);
  }
  static View<float> described(const View<float>& v, int) { return v; }
  static std::array<float, 3> described(const std::array<float, 3>& a, int) { return a; }
  static bool near(const View<float>&, const View<float>&) { return true; }
  static float log_chance(int) { return 0; }
};
static_assert(feature::Feature<Point>);
struct Blind : Point {  // what is missing is named by the compiler: "F::look(x, camera, view) is invalid"
  static void look() {}
};
static_assert(!feature::Feature<Blind> && feature::Comparable<Blind>);

TEST(FeatureFilter, of_what_is_linear_is_the_kalman_filter) {
  Dice dice(4);
  const Optics optics;
  for (int k = 0; k < 50; ++k) {
    Pose pose;
    pose.R = dice.rotation();
    pose.t = dice.normal3();
    const auto cameras = feature::cameras<double>(pose.aligned(), optics.aligned());
    feature::Estimate<Point, double> e;
    e.x.p = dice.normal3();
    const Matrix3d P = dice.covariance(Vector3d(0.1, 0.2, 0.3));
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) e.P(i, j) = P(i, j);
    const Vector3d prior = e.x.p;
    Point::View<double> seen[2];
    Eigen::Matrix<double, 6, 3> H;
    Eigen::Matrix<double, 6, 1> innovation;
    for (int eye = 0; eye < 2; ++eye) {
      const auto& c = cameras[static_cast<std::size_t>(eye)];
      H.block<3, 3>(3 * eye, 0) = c.R;
      const Vector3d predicted = c.R * prior + c.t;
      seen[eye] = {predicted + 0.2 * dice.normal3(), 0.05};
      innovation.segment<3>(3 * eye) = seen[eye].q - predicted;
    }
    const Eigen::Matrix<double, 6, 6> S = H * P * H.transpose() + 0.0025 * Eigen::Matrix<double, 6, 6>::Identity();
    const Eigen::Matrix<double, 3, 6> K = P * H.transpose() * S.inverse();
    const Vector3d mean = prior + K * innovation;
    const Matrix3d posterior = P - K * S * K.transpose();
    const auto done = feature::update<Point, 2>(e, cameras.data(), seen);
    ASSERT_TRUE(done.good);
    EXPECT_LT((e.x.p - mean).norm(), 1e-9);
    EXPECT_LT((oracle::to_matrix(e.P) - posterior).norm(), 1e-9);
  }
}

template <class F>
class FeatureKind : public testing::Test {};
using Kinds = testing::Types<Edge, Junction<2>, Junction<3>, Junction<4>, Patch>;
TYPED_TEST_SUITE(FeatureKind, Kinds);

TYPED_TEST(FeatureKind, local_is_the_inverse_of_the_retraction) {
  constexpr int N = TypeParam::kTangent;
  Dice dice(5);
  for (int k = 0; k < 200; ++k) {
    const Truth<TypeParam> truth(dice);
    float d[N], back[N];
    for (int i = 0; i < N; ++i) d[i] = static_cast<float>(dice.uniform(-0.8, 0.8));
    TypeParam::local(truth.state(), TypeParam::retract(truth.state(), d), back);
    for (int i = 0; i < N; ++i) EXPECT_NEAR(back[i], d[i], 5e-6) << i;
  }
}

// With the errors of a sample: moved, they are the errors of the moved sample; and an uncertain motion adds what its
// samples scatter.
TYPED_TEST(FeatureKind, a_rigid_motion_moves_the_errors_as_it_moves_samples) {
  constexpr int N = TypeParam::kTangent, kSamples = 20000;
  using State = typename TypeParam::template State<float>;
  Dice dice(6);
  const Truth<TypeParam> truth(dice);
  feature::Estimate<TypeParam, float> e = guess<TypeParam>(dice, truth.state(), 2e-3, 0.1);
  const State before = e.x;
  const oracle::MatrixXd L = oracle::to_matrix(e.P).llt().matrixL();
  const Matrix3d R = dice.rotation();
  const feature::Rigid<float> motion{R.cast<float>(), quat<float>(R), dice.normal3().cast<float>()};
  PoseCovariance covariance{};
  const oracle::MatrixXd Q = dice.covariance((oracle::VectorXd(6) << 1e-3, 2e-3, 1e-3, 4e-3, 6e-3, 1e-2).finished());
  for (std::size_t i = 0; i < 36; ++i) covariance[i] = Q(static_cast<int>(i / 6), static_cast<int>(i % 6));
  const MotionNoise noise = motion_noise_in_map({{0, 0, 0, 1}, {0.1, -0.2, 0.3}}, covariance);
  feature::move(e, motion);
  const Symmetric<float, N> exact = e.P;
  ASSERT_TRUE(feature::add_motion_noise(e, noise));

  const oracle::MatrixXd LQ = Q.llt().matrixL();
  oracle::MatrixXd moved = oracle::MatrixXd::Zero(N, N), uncertain = moved;
  for (int k = 0; k < kSamples; ++k) {
    const oracle::VectorXd d = L * dice.normals(N), w = LQ * dice.normals(6);
    float step[N], error[N];
    for (int i = 0; i < N; ++i) step[i] = static_cast<float>(d[i]);
    const State sample = TypeParam::moved(TypeParam::retract(before, step), motion);
    TypeParam::local(e.x, sample, error);
    oracle::VectorXd v(N);
    for (int i = 0; i < N; ++i) v[i] = error[i];
    moved += v * v.transpose() / kSamples;
    const Vector3d centre(0.1, -0.2, 0.3);
    const Matrix3d turn = oracle::exp_so3(w.tail<3>());
    const feature::Rigid<float> other{turn.cast<float>(), quat<float>(turn),
                                      (centre - turn * centre + w.head<3>()).cast<float>()};
    TypeParam::local(e.x, TypeParam::moved(sample, other), error);
    for (int i = 0; i < N; ++i) v[i] = error[i];
    uncertain += v * v.transpose() / kSamples;
  }
  const auto compare = [](const oracle::MatrixXd& a, const oracle::MatrixXd& b) {
    const oracle::VectorXd s = b.diagonal().cwiseSqrt().cwiseInverse();
    return (s.asDiagonal() * (a - b) * s.asDiagonal()).cwiseAbs().maxCoeff();
  };
  EXPECT_LT(compare(moved, oracle::to_matrix(exact)), 0.05);  // five deviations of 20,000 samples
  EXPECT_LT(compare(uncertain, oracle::to_matrix(e.P)), 0.05);
}

// What settle() says of the covariance about the new mean, against the errors of samples about it.
TYPED_TEST(FeatureKind, settling_is_the_derivative_of_the_change_of_charts) {
  constexpr int N = TypeParam::kTangent;
  constexpr float kStep = 1e-2F;
  Dice dice(7);
  for (int k = 0; k < 20; ++k) {
    const Truth<TypeParam> truth(dice);
    const auto e = guess<TypeParam>(dice, truth.state(), 1e-3, 0.1);
    float d[N];
    for (int i = 0; i < N; ++i) d[i] = static_cast<float>(i < 3 ? 0 : dice.uniform(-0.3, 0.3));
    const auto settled = TypeParam::retract(e.x, d);
    oracle::MatrixXd J(N, N);
    for (int i = 0; i < N; ++i) {
      float plus[N], minus[N], a[N], b[N];
      for (int j = 0; j < N; ++j) {
        plus[j] = d[j] + (i == j ? kStep : 0);
        minus[j] = d[j] - (i == j ? kStep : 0);
      }
      TypeParam::local(settled, TypeParam::retract(e.x, plus), a);
      TypeParam::local(settled, TypeParam::retract(e.x, minus), b);
      for (int j = 0; j < N; ++j) J(j, i) = (a[j] - b[j]) / (2 * kStep);
    }
    if (std::is_same_v<TypeParam, Edge>) J.row(3) = oracle::VectorXd::Unit(N, 3);  // the roll is kept apart
    const oracle::MatrixXd expected = J * oracle::to_matrix(e.P) * J.transpose();
    auto P = e.P;
    TypeParam::settle(P, d);
    const oracle::VectorXd s = expected.diagonal().cwiseSqrt().cwiseInverse();
    // To first order in d: tilts of 0.3 rad shrink by 1.5 % across themselves.
    EXPECT_LT((s.asDiagonal() * (oracle::to_matrix(P) - expected) * s.asDiagonal()).cwiseAbs().maxCoeff(), 0.07);
  }
}

TYPED_TEST(FeatureKind, every_lane_does_what_one_alone_does) {
  constexpr int N = TypeParam::kTangent;
  using P4 = Pack<4>;
  Dice dice(8);
  const Optics optics;
  const Pose pose;
  feature::Estimate<TypeParam, float> alone[4];
  feature::Estimate<TypeParam, P4> lanes;
  typename TypeParam::template View<float> seen[4][2];
  typename TypeParam::template View<P4> packed[2];
  static_assert(sizeof(lanes) == 4 * sizeof(alone[0]) && sizeof(packed) == 4 * sizeof(seen[0]));
  const auto pack = [](const auto* from, std::size_t stride, auto& to) {  // both are floats and nothing else
    for (std::size_t i = 0; i < sizeof(to) / 16; ++i)
      for (std::size_t l = 0; l < 4; ++l)
        std::memcpy(reinterpret_cast<char*>(&to) + 16 * i + 4 * l,
                    reinterpret_cast<const char*>(from) + l * stride + 4 * i, 4);
  };
  for (int l = 0; l < 4; ++l) {
    const Truth<TypeParam> truth(dice);
    alone[l] = guess<TypeParam>(dice, truth.state(), 1e-3, 0.05);
    for (int eye = 0; eye < 2; ++eye) seen[l][eye] = truth.observe(dice, pose, optics, eye == 0 ? 0 : optics.baseline);
  }
  pack(alone, sizeof(alone[0]), lanes);
  pack(seen, sizeof(seen[0]), packed);
  const auto one = feature::cameras<float>(pose.aligned(), optics.aligned());
  const auto four = feature::cameras<P4>(pose.aligned(), optics.aligned());
  const auto done = feature::update<TypeParam, 2>(lanes, four.data(), packed);
  for (int l = 0; l < 4; ++l) {
    const auto single = feature::update<TypeParam, 2>(alone[l], one.data(), seen[l]);
    EXPECT_EQ(single.good && single.visible, done.good[l] && done.visible[l]);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(lanes.x.p[i][l], alone[l].x.p[i], 1e-6);
    for (int i = 0; i < N; ++i) EXPECT_NEAR(lanes.P(i, i)[l], alone[l].P(i, i), 1e-4F * alone[l].P(i, i));
  }
}

// Nothing that is not a number, behind or without a shape gets in.
TYPED_TEST(FeatureKind, what_cannot_be_seen_is_refused) {
  Dice dice(9);
  const Optics optics;
  const Pose pose;
  const auto cameras = feature::cameras<float>(pose.aligned(), optics.aligned());
  const Truth<TypeParam> truth(dice);
  const auto sound = guess<TypeParam>(dice, truth.state(), 1e-3, 0.05);
  typename TypeParam::template View<float> seen[2] = {truth.observe(dice, pose, optics, 0),
                                                      truth.observe(dice, pose, optics, optics.baseline)};
  const auto refused = [&](feature::Estimate<TypeParam, float> e) {
    const auto done = feature::update<TypeParam, 2>(e, cameras.data(), seen);
    return !(done.visible && done.good);
  };
  EXPECT_FALSE(refused(sound));
  auto e = sound;
  e.x.p[2] = -0.5F;
  EXPECT_TRUE(refused(e)) << "behind";
  e = sound;
  e.x.p[0] = kNaN;
  EXPECT_TRUE(refused(e));
  e = sound;
  e.P(1, 1) = -1;
  EXPECT_TRUE(refused(e));
  e = sound;
  e.P(2, 3) = kNaN;
  EXPECT_TRUE(refused(e));
  seen[1].y = kNaN;
  EXPECT_TRUE(refused(sound));
}

}  // namespace
}  // namespace accrete::test
