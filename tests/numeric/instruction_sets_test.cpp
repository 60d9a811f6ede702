// The same lane functions, compiled for several instruction sets: what one computes all compute, but for the last
// digits where multiplication and addition are fused. In the preset deterministic they are not, and all bits are the
// same.
#include <gtest/gtest.h>

#include <cstring>

#include "kernels/kernels.h"
#include "numeric/dice.h"

namespace accrete {
namespace {

using namespace oracle;

struct World {
  std::vector<GeometryBlock> geometry;
  std::vector<AppearanceBlock> appearance;
  std::vector<std::uint32_t> slots;
  std::vector<LineElement> left, right;
  std::vector<Appearance> looks;
  Pose pose;
};

World random_world(unsigned seed, std::size_t n) {
  Dice dice(seed);
  World w;
  w.geometry.resize((n + 15) / 16);
  w.appearance.resize(w.geometry.size());
  const Optics optics;
  for (std::size_t i = 0; i < n; ++i) {
    const Edge x = dice.edge(3e-3, 0.2, 0.8);
    store(record_of(x), w.geometry[i / 16], i % 16);
    AppearanceState a;
    for (std::size_t k = 0; k < 7; ++k) a.covariance[packed_index(7, k, k)] = 0.01F;
    store(a, w.appearance[i / 16], i % 16);
    const Edge truth = moved(x, MatrixXd(x.P.llt().matrixL()) * dice.normals(6));
    w.left.push_back(dice.observe(truth, w.pose, optics, 0, 0.3, 0.035, 2));
    w.right.push_back(dice.observe(truth, w.pose, optics, optics.baseline, 0.3, 0.035, 2));
    w.slots.push_back(static_cast<std::uint32_t>(i));
    Appearance look;
    look.phase = static_cast<float>(dice.uniform(-3, 3));
    for (auto* side : {&look.left, &look.right})
      for (float& c : *side) c = static_cast<float>(dice.uniform(0, 1));
    w.looks.push_back(look);
  }
  return w;
}

// Everything that a step asks of the lanes, once.
std::vector<PredictedObservation> frame(const Kernels& k, World& w) {
  const std::size_t n = w.slots.size();
  std::vector<PredictedObservation> seen(n);
  std::vector<UpdateOutcome> out(n);
  const AlignedOptics optics = Optics{}.aligned();
  const AlignedPose pose = w.pose.aligned();
  PoseCovariance increment{};
  for (std::size_t i = 0; i < 6; ++i) increment[7 * i] = 1e-8;
  k.add_incremental_motion_noise(w.geometry, {}, increment);
  k.predict_observations(w.geometry, w.slots, pose, optics, seen);
  const std::span<const std::uint32_t> all(w.slots);
  const std::size_t half = n / 2;
  const std::span<UpdateOutcome> outcomes(out);
  const std::vector<Eye> eyes(n - half, Eye::kRight);
  const std::span<const LineElement> left(w.left), right(w.right);
  k.update_stereo(w.geometry, all.first(half), left.first(half), right.first(half), pose, optics, outcomes.first(half),
                  {});
  k.update_mono(w.geometry, all.subspan(half), right.subspan(half), eyes, pose, optics, outcomes.subspan(half), {});
  k.update_roll(w.geometry, all, pose, optics, 0.87F, out);
  const std::vector<float> sigma(n, 0.1F), q(n, 1e-4F);
  k.update_appearance(w.appearance, all, w.looks, sigma, sigma, sigma, q, q, out);
  for (const UpdateOutcome o : out) EXPECT_EQ(o, UpdateOutcome::kUpdated);
  return seen;
}

TEST(InstructionSets, have_their_names_and_widths) {
  EXPECT_TRUE(is_available(InstructionSet::kBest));
  EXPECT_TRUE(is_available(InstructionSet::kBaseline));
  for (const auto& [set, lanes] : {std::pair{InstructionSet::kAvx2, 8}, std::pair{InstructionSet::kAvx512, 16}}) {
    if (!is_available(set)) continue;
    EXPECT_EQ(kernels(set).lanes, lanes);
    EXPECT_STREQ(name(set), lanes == 8 ? "avx2" : "avx512");
    EXPECT_GE(kernels(InstructionSet::kBest).lanes, lanes);
  }
  EXPECT_EQ(kernels(InstructionSet::kBaseline).lanes, ACCRETE_LANE_WIDTH);
}

TEST(InstructionSets, compute_the_same) {
  const World start = random_world(1, 333);
  World reference = start;
  const auto expected = frame(kernels(InstructionSet::kBaseline), reference);
  int compared = 0;
  for (const InstructionSet set : {InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    if (!is_available(set)) continue;
    ++compared;
    World w = start;
    const auto seen = frame(kernels(set), w);
#if defined(ACCRETE_SAME_BITS)
    EXPECT_EQ(std::memcmp(w.geometry.data(), reference.geometry.data(), w.geometry.size() * sizeof(GeometryBlock)), 0);
    EXPECT_EQ(
        std::memcmp(w.appearance.data(), reference.appearance.data(), w.appearance.size() * sizeof(AppearanceBlock)),
        0);
#endif
    for (std::size_t i = 0; i < w.slots.size(); ++i) {
      ASSERT_EQ(seen[i].valid, expected[i].valid);
      EXPECT_NEAR(seen[i].x_l, expected[i].x_l, 1e-3);
      EXPECT_NEAR(seen[i].covariance[0], expected[i].covariance[0], 1e-3F * expected[i].covariance[0]);
      const Edge x = state_of(load(w.geometry[i / 16], i % 16)), y = state_of(load(reference.geometry[i / 16], i % 16));
      const Vector6d s = y.P.diagonal().cwiseSqrt().cwiseInverse();
      EXPECT_LT((s.asDiagonal() * (x.P - y.P) * s.asDiagonal()).norm(), 5e-3);
      EXPECT_LT(s.head<3>().cwiseProduct(x.p - y.p).norm(), 5e-3);
      const AppearanceState a = load(w.appearance[i / 16], i % 16), b = load(reference.appearance[i / 16], i % 16);
      EXPECT_NEAR(a.mean.phase, b.mean.phase, 1e-5);
      EXPECT_NEAR(a.mean.left[0], b.mean.left[0], 1e-6);
      EXPECT_NEAR(a.covariance[0], b.covariance[0], 1e-5F * b.covariance[0]);
    }
  }
  if (compared == 0) GTEST_SKIP() << "this build or this processor has the baseline only";
}

}  // namespace
}  // namespace accrete
