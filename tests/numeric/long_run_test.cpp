// A long run: prediction, motion noise and updates of the same thousand primitives over and over, most of them ordinary
// and some of them wild. Nothing may wear out in a million updates on every instruction set. It prints what was
// refused, by reason.
#include <gtest/gtest.h>

#include <cstdio>

#include "kernels/kernels.h"
#include "numeric/wild.h"

namespace accrete {
namespace {

using namespace oracle;

constexpr std::size_t kN = 1024, kWildOnes = 128;  // the first ones

struct Count {
  std::uint64_t done[3] = {};  // by outcome
  std::uint64_t behind_or_none = 0, predicted = 0;

  void add(std::span<const UpdateOutcome> outcomes, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) ++done[static_cast<std::size_t>(outcomes[i])];
  }
};

struct World {
  std::vector<GeometryBlock> geometry = std::vector<GeometryBlock>(kN / 16);
  std::vector<AppearanceBlock> appearance = std::vector<AppearanceBlock>(kN / 16);
  Count pose_wild, pose_ordinary, roll, look, prediction;
};

// What all instruction sets are given in one frame.
struct Frame {
  Pose pose;
  PoseCovariance increment{};
  std::vector<LineElement> left, right;
  std::vector<Eye> eyes;
  std::vector<Appearance> looks;
  std::vector<float> sigma, q;
};

void run(const Kernels& k, World& w, std::span<const std::uint32_t> slots, const Frame& f) {
  const AlignedPose pose = f.pose.aligned();
  const AlignedOptics optics = Optics{}.aligned();
  k.add_incremental_motion_noise(w.geometry, {}, f.increment);
  std::vector<PredictedObservation> seen(kN);
  k.predict_observations(w.geometry, slots, pose, optics, seen);
  for (const PredictedObservation& p : seen) ++(p.valid ? w.prediction.predicted : w.prediction.behind_or_none);
  std::vector<UpdateOutcome> out(kN);
  const std::vector<float> cap(kN, 1e-5F);
  if (f.eyes.empty())
    k.update_stereo(w.geometry, slots, f.left, f.right, pose, optics, out, cap);
  else
    k.update_mono(w.geometry, slots, f.left, f.eyes, pose, optics, out, cap);
  w.pose_wild.add(out, 0, kWildOnes);
  w.pose_ordinary.add(out, kWildOnes, kN);
  k.update_roll(w.geometry, slots, pose, optics, 0.87F, out);
  w.roll.add(out, kWildOnes, kN);
  k.update_appearance(w.appearance, slots, f.looks, f.sigma, f.sigma, f.sigma, f.q, f.q, out);
  w.look.add(out, kWildOnes, kN);
}

TEST(LongRun, nothing_wears_out) {
  constexpr int kFrames = 1000;
  Wild wild(7);
  std::vector<std::uint32_t> slots(kN);
  std::vector<Edge> truth(kN);
  World start;
  for (std::uint32_t i = 0; i < kN; ++i) {
    slots[i] = i;
    Edge x = wild.edge(3e-3, 0.2, 0.8);
    truth[i] = moved(x, MatrixXd(x.P.llt().matrixL()) * wild.normals(6));
    store(i < kWildOnes ? wild.any_geometry() : record_of(x), start.geometry[i / 16], i % 16);
    store(wild.any_appearance(), start.appearance[i / 16], i % 16);
  }
  std::vector<const Kernels*> sets;
  for (const InstructionSet set : {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512})
    if (is_available(set)) sets.push_back(&kernels(set));
  std::vector<World> worlds(sets.size(), start);

  for (int n = 0; n < kFrames; ++n) {
    Frame f;
    f.pose.R = exp_so3(0.35 * std::sin(0.05 * n) * Vector3d(0.2, 1, 0.1).normalized());
    f.pose.t = Vector3d(0, 0, 0.7) - f.pose.R * Vector3d(0, 0, 0.7);
    f.increment = diagonal_pose_covariance(1e-5, 1e-5);
    if (n % 50 == 9)  // now and then hardly anything is known any more
      f.increment = diagonal_pose_covariance(wild.log_uniform(1e-6, 1e-2), wild.log_uniform(1e-6, 1e-1));
    for (std::uint32_t i = 0; i < kN; ++i) {
      const bool odd = i < kWildOnes;
      f.left.push_back(odd ? wild.any_element() : wild.observe(truth[i], f.pose, {}, 0, 0.3, 0.035, 2));
      f.right.push_back(odd ? wild.any_element() : wild.observe(truth[i], f.pose, {}, 0.12, 0.3, 0.035, 2));
      f.looks.push_back(wild.any_look());
      f.sigma.push_back(static_cast<float>(odd ? std::sqrt(wild.log_uniform(1e-12, 1e6)) : 0.05));
      f.q.push_back(static_cast<float>(odd ? wild.log_uniform(1e-12, 1e6) : 1e-6));
    }
    if (n % 4 == 3) f.eyes.assign(kN, Eye::kLeft);
    for (std::size_t s = 0; s < sets.size(); ++s) {
      run(*sets[s], worlds[s], slots, f);
      if (n % 20 != 19) continue;
      for (std::uint32_t i = 0; i < kN; ++i) {
        ASSERT_TRUE(is_state(load(worlds[s].geometry[i / 16], i % 16))) << sets[s]->name << " " << i << " frame " << n;
        ASSERT_TRUE(is_state(load(worlds[s].appearance[i / 16], i % 16))) << sets[s]->name << " " << i;
      }
    }
  }

  for (std::size_t s = 0; s < sets.size(); ++s) {
    const World& w = worlds[s];
    std::printf("%-9s %8d updates:", sets[s]->name, kFrames * static_cast<int>(kN));
    for (const auto& [name, c] : {std::pair{"ordinary", &w.pose_ordinary}, std::pair{"wild", &w.pose_wild},
                                  std::pair{"roll", &w.roll}, std::pair{"appearance", &w.look}})
      std::printf("  %s %llu done, %llu no Gaussian, %llu behind;", name, static_cast<unsigned long long>(c->done[0]),
                  static_cast<unsigned long long>(c->done[1]), static_cast<unsigned long long>(c->done[2]));
    std::printf("  predicted %llu, not %llu\n", static_cast<unsigned long long>(w.prediction.predicted),
                static_cast<unsigned long long>(w.prediction.behind_or_none));
    const auto all = std::uint64_t{kFrames} * kN;
    EXPECT_EQ(w.pose_ordinary.done[0] + w.pose_ordinary.done[1] + w.pose_ordinary.done[2], all / kN * (kN - kWildOnes));
    EXPECT_EQ(w.pose_ordinary.done[1] + w.pose_ordinary.done[2], 0U);
    EXPECT_EQ(w.roll.done[1], 0U);
    EXPECT_EQ(w.look.done[1], 0U);
    double worst = 0;  // and what is ordinary still is where it ought to be
    for (std::uint32_t i = kWildOnes; i < kN; ++i)
      worst = std::max(worst, line_error(truth[i], state_of(load(w.geometry[i / 16], i % 16))).head<2>().norm());
    EXPECT_LT(worst, 0.01);
  }
}

}  // namespace
}  // namespace accrete
