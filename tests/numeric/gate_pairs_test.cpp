// The gate of a pair against its definition, with Eigen in double: one scalar, and all lanes at once.
#include "associate/gate_pairs.h"

#include <gtest/gtest.h>

#include "associate/gate_kernel.h"
#include "kernels/kernels.h"
#include "math/lane_gather.h"
#include "numeric/dice.h"

namespace accrete::associate {
namespace {

using namespace oracle;

constexpr double kTurn = 2 * 3.14159265358979323846;

// Pairs (i, i, i): an expected primitive, and what both eyes saw of it or of something else.
struct Crowd {
  std::vector<Expected> expected;
  std::vector<Primitive2d> left, right;
  std::vector<float> density[2];
  Clutter clutter[2];

  [[nodiscard]] EyeView view(int eye) const { return {eye == 0 ? left : right, nullptr, &clutter[eye]}; }
};

Appearance look_near(Dice& dice, const Appearance& a, double by) {
  Appearance b = a;
  b.phase = static_cast<float>(std::remainder(double{a.phase} + 3 * by * dice.normal(), kTurn));
  for (auto* side : {&b.left, &b.right})
    for (float& c : *side) c += static_cast<float>(by * dice.normal());
  return b;
}

Crowd random_crowd(unsigned seed, std::size_t n) {
  Dice dice(seed);
  Crowd w;
  for (std::size_t i = 0; i < n; ++i) {
    Expected e;
    VectorXd sigma(4);
    sigma << 0.4, 0.02, 0.5, 0.03;
    const MatrixXd P = dice.covariance(sigma * dice.uniform(0.2, 3));
    for (int a = 0; a < 4; ++a)
      for (int b = a; b < 4; ++b)
        e.predicted.covariance[packed_index(4, static_cast<std::size_t>(a), static_cast<std::size_t>(b))] =
            static_cast<float>(P(a, b));
    e.mean.phase = static_cast<float>(dice.uniform(-3.14, 3.14));
    for (auto* side : {&e.mean.left, &e.mean.right})
      for (float& c : *side) c = static_cast<float>(dice.uniform(0, 1));
    for (float& v : e.variance) v = static_cast<float>(dice.uniform(0, 0.02));
    e.visible = static_cast<float>(dice.uniform(0, 1));
    e.detection = static_cast<float>(dice.uniform(0.1, 0.95));
    e.noise = {static_cast<float>(dice.uniform(0, 0.1)), static_cast<float>(dice.uniform(0, 1e-3))};
    const double away = dice.uniform(0, 5), other = i % 5 == 0 ? 0.4 : 0.05;
    for (int eye = 0; eye < 2; ++eye) {
      const double x = dice.uniform(-300, 300), y = dice.uniform(-200, 200), angle = dice.uniform(-3.14, 3.14);
      float* at = eye == 0 ? &e.predicted.x_l : &e.predicted.x_r;
      at[0] = static_cast<float>(x), at[1] = static_cast<float>(y);
      at[2] = static_cast<float>(std::cos(angle)), at[3] = static_cast<float>(std::sin(angle));
      const double n_px = away * 0.5 * dice.normal(), slide = dice.uniform(-4.5, 4.5);
      const double seen = angle + 0.03 * away * dice.normal();
      Primitive2d p;
      p.aligned.x_px = static_cast<float>(x + slide * std::cos(angle) - n_px * std::sin(angle));
      p.aligned.y_px = static_cast<float>(y + slide * std::sin(angle) + n_px * std::cos(angle));
      p.aligned.c = static_cast<float>(std::cos(seen));
      p.aligned.s = static_cast<float>(std::sin(seen));
      p.aligned.sigma_n_px = static_cast<float>(dice.uniform(0.15, 0.5));
      p.aligned.sigma_theta = static_cast<float>(dice.uniform(0.01, 0.05));
      p.appearance = look_near(dice, e.mean, other);
      p.sigma_phase = static_cast<float>(dice.uniform(0.1, 0.4));
      p.sigma_colour = static_cast<float>(dice.uniform(0.01, 0.08));
      if (dice.index(2) == 0) {
        p.aligned = reversed(p.aligned);
        p.appearance = reversed(p.appearance);
      }
      (eye == 0 ? w.left : w.right).push_back(p);
    }
    w.expected.push_back(e);
  }
  std::vector<std::uint32_t> begin(Grid::kCells + 1);
  std::vector<std::uint16_t> order(n);
  for (int eye = 0; eye < 2; ++eye) {
    const auto& image = eye == 0 ? w.left : w.right;
    Grid grid{begin, order};
    grid.build(image);
    w.density[eye].resize(n);
    w.clutter[eye].density = w.density[eye];
    w.clutter[eye].measure(image, grid, 9);
  }
  return w;
}

struct Truth {
  double d2, all, log_likelihood;  // geometry, with appearance, of the bracket whether the gates are open or not
  bool reversed[2];
};

// docs/math/association.md, word for word. eyes: which, bit 0 the left one.
Truth truth_of(const Crowd& w, std::size_t i, int eyes) {
  const Expected& e = w.expected[i];
  const bool both = eyes == 3;
  const Clutter& clutter = w.clutter[eyes == 2 ? 1 : 0];
  Truth out{};
  const auto m = both ? 4 : 2;
  VectorXd z(m);
  MatrixXd J = MatrixXd::Identity(m, m), P(m, m), R = MatrixXd::Zero(m, m);
  double log_beta = 0, sine = 0, cosine = 0, sigma_phase = 0, sigma_colour = 0;
  VectorXd colours = VectorXd::Zero(6);
  int at = 0;
  for (int eye = 0; eye < 2; ++eye) {
    if ((eyes >> eye & 1) == 0) continue;
    const float* p = eye == 0 ? &e.predicted.x_l : &e.predicted.x_r;
    const Primitive2d& o = (eye == 0 ? w.left : w.right)[i];
    const Vector2d direction(p[2], p[3]), seen(o.aligned.c, o.aligned.s);
    const Vector2d d(double{o.aligned.x_px} - double{p[0]}, double{o.aligned.y_px} - double{p[1]});
    const bool turned = direction.dot(seen) < 0;
    const Vector2d along = turned ? Vector2d(-seen) : seen;
    out.reversed[eye] = turned;
    z[at] = direction[0] * d[1] - direction[1] * d[0];
    z[at + 1] = direction[0] * along[1] - direction[1] * along[0];
    J(at, at + 1) = direction.dot(d);
    R(at, at) = std::pow(double{o.aligned.sigma_n_px}, 2) + double{e.noise.variance_n_px2};
    R(at + 1, at + 1) = std::pow(double{o.aligned.sigma_theta}, 2) + double{e.noise.variance_theta};
    for (int a = 0; a < m; ++a)
      for (int b = 0; b < m; ++b) {
        const int shift = eyes == 2 ? 2 : 0;
        P(a, b) = e.predicted.covariance[packed_index(4, static_cast<std::size_t>(std::min(a, b) + shift),
                                                      static_cast<std::size_t>(std::max(a, b) + shift))];
      }
    const Appearance look = turned ? reversed(o.appearance) : o.appearance;
    const double part = both ? 0.5 : 1;
    sine += std::sin(double{look.phase}), cosine += std::cos(double{look.phase});
    sigma_phase += part * double{o.sigma_phase}, sigma_colour += part * double{o.sigma_colour};
    for (std::size_t c = 0; c < 3; ++c) {
      colours[static_cast<int>(c)] += part * double{look.left[c]};
      colours[static_cast<int>(3 + c)] += part * double{look.right[c]};
    }
    log_beta += std::log(double{w.density[eye][i]});
    at += 2;
  }
  const MatrixXd S = J * P * J.transpose() + R;
  out.d2 = z.dot(S.inverse() * z);
  double log_g = -0.5 * (out.d2 + std::log((kTurn * S).determinant()));

  const double phase = std::atan2(sine, cosine), k3 = double{clutter.independent_channels} / 3;
  double side[2] = {0, 0};
  for (int c = 0; c < 6; ++c) {
    const double v = double{e.variance[1 + c]} + sigma_colour * sigma_colour + 0.05 * 0.05;
    const double mean =
        c < 3 ? e.mean.left[static_cast<std::size_t>(c)] : e.mean.right[static_cast<std::size_t>(c - 3)];
    side[c / 3] += k3 * std::pow(colours[c] - mean, 2) / v;
    log_g -= 0.5 * k3 * std::log(kTurn * v);
    const double chance = clutter.variance[static_cast<std::size_t>(c % 3)];
    log_beta -= k3 * (0.5 * std::pow(colours[c] - double{clutter.mean[static_cast<std::size_t>(c % 3)]}, 2) / chance +
                      0.5 * std::log(kTurn * chance));
  }
  const double vp = double{e.variance[0]} + sigma_phase * sigma_phase + 0.35 * 0.35;
  const double phase2 = std::pow(std::remainder(phase - double{e.mean.phase}, kTurn), 2) / vp;
  const bool changed = side[0] > 9 && side[1] > 9;
  const double a2 = std::min(side[0], 9.0) + std::min(side[1], 9.0) + (changed ? phase2 : std::min(phase2, 9.0));
  log_g -= 0.5 * (a2 + std::log(kTurn * vp));
  const auto bin = static_cast<std::size_t>((phase + kTurn / 2) / kTurn * Clutter::kPhaseBins);
  log_beta += std::log(0.5 * (double{clutter.phase_density[bin]} + double{clutter.phase_density[7 - bin]}));
  out.all = out.d2 + a2;

  const double v = e.visible, d = e.detection, q = 1 - 0.99 * d;
  out.log_likelihood =
      std::log(1 - v + v * q * q + v * d * (both ? d : 1 - d) * std::exp(std::min(log_g - log_beta, 30.0)));
  return out;
}

// `i`: of the crowd, lane by lane.
template <int Eyes, class S>
LanePair<Eyes, S> pair_of(const Crowd& w, std::size_t first, int eyes) {
  LanePair<Eyes, S> p;
  const auto set = [&](S& to, int lane, float value) {
    if constexpr (LaneTraits<S>::kLanes == 1)
      to = S(value);
    else
      to.v[lane] = value;
  };
  for (int l = 0; l < LaneTraits<S>::kLanes; ++l) {
    const std::size_t i = first + static_cast<std::size_t>(l);
    const Expected& e = w.expected[i];
    int at = 0;
    for (int eye = 0; eye < 2; ++eye) {
      if ((eyes >> eye & 1) == 0) continue;
      const float* x = eye == 0 ? &e.predicted.x_l : &e.predicted.x_r;
      const Primitive2d& o = (eye == 0 ? w.left : w.right)[i];
      set(p.expected[at].x, l, x[0]), set(p.expected[at].y, l, x[1]);
      set(p.expected[at].c, l, x[2]), set(p.expected[at].s, l, x[3]);
      set(p.seen[at].x, l, o.aligned.x_px), set(p.seen[at].y, l, o.aligned.y_px);
      set(p.seen[at].c, l, o.aligned.c), set(p.seen[at].s, l, o.aligned.s);
      set(p.noise[2 * at], l, o.aligned.sigma_n_px * o.aligned.sigma_n_px + e.noise.variance_n_px2);
      set(p.noise[2 * at + 1], l, o.aligned.sigma_theta * o.aligned.sigma_theta + e.noise.variance_theta);
      set(p.look[at].a[0], l, o.appearance.phase);
      for (std::size_t c = 0; c < 3; ++c) {
        set(p.look[at].a[1 + c], l, o.appearance.left[c]);
        set(p.look[at].a[4 + c], l, o.appearance.right[c]);
      }
      set(p.look[at].sigma_phase, l, o.sigma_phase);
      set(p.look[at].sigma_colour, l, o.sigma_colour);
      set(p.density[at], l, w.density[eye][i]);
      ++at;
    }
    const std::size_t shift = eyes == 2 ? 2 : 0;
    for (int a = 0; a < 2 * Eyes; ++a)
      for (int b = a; b < 2 * Eyes; ++b)
        set(p.P(a, b), l,
            e.predicted
                .covariance[packed_index(4, static_cast<std::size_t>(a) + shift, static_cast<std::size_t>(b) + shift)]);
    set(p.mean[0], l, e.mean.phase);
    for (std::size_t c = 0; c < 3; ++c) {
      set(p.mean[1 + c], l, e.mean.left[c]);
      set(p.mean[4 + c], l, e.mean.right[c]);
    }
    for (int k = 0; k < 7; ++k) set(p.variance[k], l, e.variance[k]);
    set(p.visible, l, e.visible);
    set(p.detection, l, e.detection);
  }
  return p;
}

// Gates as the documentation has them: 9.21, 27.88; 13.28, 31.26. 0: closed, 1: open, 2: too near to tell.
int is_open(const Truth& t, bool both, double margin) {
  const double a = t.d2 - (both ? 13.28 : 9.21), b = t.all - (both ? 31.26 : 27.88);
  if (std::max(a, b) < -margin) return 1;
  return std::max(a, b) > margin ? 0 : 2;
}

template <int Eyes>
void expect_true(const Crowd& w, std::size_t i, int eyes, double d2, double log_likelihood, double tolerance) {
  const Truth t = truth_of(w, i, eyes);
  EXPECT_NEAR(d2, t.d2, tolerance * (1 + t.d2));
  const int open = is_open(t, Eyes == 2, 40 * tolerance);
  if (open == 1) {
    EXPECT_NEAR(log_likelihood, t.log_likelihood, tolerance * (1 + std::fabs(t.log_likelihood))) << i;
  }
  if (open == 0) {
    EXPECT_TRUE(std::isinf(log_likelihood)) << i;
  }
}

TEST(GatePairs, double_is_the_definition) {
  const Crowd w = random_crowd(1, 600);
  int open = 0;
  for (std::size_t i = 0; i < w.expected.size(); ++i) {
    auto both = pair_of<2, double>(w, i, 3);
    const auto v = gate_pair(both, w.clutter[0]);
    // Constants and what is measured of the image are floats.
    expect_true<2>(w, i, 3, v.d2, v.log_likelihood, 1e-5);
    EXPECT_EQ(v.reversed[0], truth_of(w, i, 3).reversed[0]);
    EXPECT_EQ(v.reversed[1], truth_of(w, i, 3).reversed[1]);
    open += is_open(truth_of(w, i, 3), true, 0) == 1 ? 1 : 0;
    for (int eye = 0; eye < 2; ++eye) {
      auto one = pair_of<1, double>(w, i, 1 << eye);
      const auto u = gate_pair(one, w.clutter[eye]);
      expect_true<1>(w, i, 1 << eye, u.d2, u.log_likelihood, 1e-5);
    }
  }
  EXPECT_GT(open, 200);  // and neither all nor none
  EXPECT_LT(open, 500);
}

// Every instruction set, full and ragged batches, and records that are shared and out of order.
TEST(GatePairs, lanes_are_the_definition) {
  const Crowd w = random_crowd(2, 200);
  Dice dice(3);
  for (const InstructionSet set : {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    if (!is_available(set)) continue;
    const GateKernels& gate = kernels(set).gate;
    for (std::size_t count = 0; count <= PairBatch::kCapacity; ++count) {
      PairBatch b;
      b.count = count;
      std::vector<std::size_t> pick(count);
      for (std::size_t k = 0; k < count; ++k) {
        pick[k] = dice.index(200);
        b.expected[k] = static_cast<std::uint32_t>(pick[k]);
        b.left[k] = b.right[k] = static_cast<std::uint16_t>(pick[k]);
      }
      gate.both_eyes(w.expected, w.view(0), w.view(1), b);
      for (std::size_t k = 0; k < count; ++k) {
        expect_true<2>(w, pick[k], 3, b.d2[k], b.log_likelihood[k], 1e-3);
        EXPECT_EQ(b.left_reversed[k] != 0, truth_of(w, pick[k], 3).reversed[0]);
        EXPECT_EQ(b.right_reversed[k] != 0, truth_of(w, pick[k], 3).reversed[1]);
      }
      for (int eye = 0; eye < 2; ++eye) {
        gate.one_eye(w.expected, w.view(eye), eye, b);
        for (std::size_t k = 0; k < count; ++k)
          expect_true<1>(w, pick[k], 1 << eye, b.d2[k], b.log_likelihood[k], 1e-3);
      }
      EXPECT_EQ(b.count, count);
    }
  }
}

template <int N>
void expect_same_as_one_lane(const Crowd& w) {
  for (std::size_t i = 0; i + N <= w.expected.size(); i += N) {
    auto packed = pair_of<2, Pack<N>>(w, i, 3);
    const auto v = gate_pair(packed, w.clutter[0]);
    for (int l = 0; l < N; ++l) {
      auto one = pair_of<2, float>(w, i + static_cast<std::size_t>(l), 3);
      const auto u = gate_pair(one, w.clutter[0]);
#if defined(ACCRETE_SAME_BITS)
      EXPECT_EQ(v.d2[l], u.d2);
      EXPECT_EQ(v.log_likelihood[l], u.log_likelihood);
#else
      EXPECT_NEAR(v.d2[l], u.d2, 1e-4F * (1 + u.d2));
#endif
      EXPECT_EQ(v.reversed[0][l], u.reversed[0]);
    }
  }
}

TEST(GatePairs, no_lane_sees_another) {
  const Crowd w = random_crowd(4, 160);
  expect_same_as_one_lane<4>(w);
  expect_same_as_one_lane<8>(w);
  expect_same_as_one_lane<16>(w);
}

#if defined(ACCRETE_SAME_BITS)
TEST(GatePairs, all_instruction_sets_give_the_same_bits) {
  const Crowd w = random_crowd(6, 61);
  PairBatch start;
  start.count = 61;
  for (std::size_t k = 0; k < 61; ++k)
    start.expected[k] = start.left[k] = start.right[k] = static_cast<std::uint16_t>(k);
  PairBatch reference = start;
  gate_both_eyes(w.expected, w.view(0), w.view(1), reference);
  for (const InstructionSet set : {InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    if (!is_available(set)) continue;
    PairBatch b = start;
    kernels(set).gate.both_eyes(w.expected, w.view(0), w.view(1), b);
    for (std::size_t k = 0; k < 61; ++k) {
      EXPECT_EQ(b.d2[k], reference.d2[k]);
      EXPECT_EQ(b.log_likelihood[k], reference.log_likelihood[k]);
    }
  }
}
#endif

TEST(GatePairs, what_is_no_covariance_closes_the_gate) {
  Crowd w = random_crowd(5, 2);
  w.expected[0].predicted.covariance[0] = -5;
  w.expected[1].predicted.covariance[3] = __builtin_nanf("");
  PairBatch b;
  b.count = 2;
  for (std::size_t k = 0; k < 2; ++k) b.expected[k] = b.left[k] = b.right[k] = static_cast<std::uint16_t>(k);
  gate_both_eyes(w.expected, w.view(0), w.view(1), b);
  for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(b.log_likelihood[k], -__builtin_inff()) << k;
}

template <class S>
void expect_transposed() {
  constexpr int N = LaneTraits<S>::kLanes;
  float memory[40 * N];
  for (int i = 0; i < 40 * N; ++i) memory[i] = static_cast<float>(i);
  const float* from[N];
  for (int l = 0; l < N; ++l) from[l] = memory + (7 * l * l + 3) % (39 * N - 8);
  S out[8];
  load_octs<S>(from, out);
  for (int m = 0; m < 8; ++m)
    for (int l = 0; l < N; ++l) EXPECT_EQ(lane(out[m], l), from[l][m]);
}

TEST(GatePairs, octs_are_transposed) {
  expect_transposed<float>();
  expect_transposed<double>();
  expect_transposed<Pack<4>>();
  expect_transposed<Pack<8>>();
  expect_transposed<Pack<16>>();
}

}  // namespace
}  // namespace accrete::associate
