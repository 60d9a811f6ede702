// For any finite input the covariance stays symmetric and positive definite, nothing is NaN, and what cannot be done is
// said and changes nothing: every public function of the filter, on every instruction set that this machine has.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstring>

#include "kernels/kernels.h"
#include "numeric/wild.h"
#include "stereo/reconstruct.h"
#include "store/fuse.h"

namespace accrete {
namespace {

using namespace oracle;

constexpr std::size_t kN = 37;  // blocks and lanes that are not full

std::vector<const Kernels*> all_kernels() {
  std::vector<const Kernels*> all;
  for (const InstructionSet set : {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512})
    if (is_available(set)) all.push_back(&kernels(set));
  return all;
}

// Worlds that are tried for every seed that rapidcheck gives: 2000 in all.
constexpr std::uint32_t kWorlds = 20;

template <class T>
bool same_bits(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

struct World {
  std::vector<GeometryBlock> geometry = std::vector<GeometryBlock>(3);
  std::vector<AppearanceBlock> appearance = std::vector<AppearanceBlock>(3);
  std::vector<std::uint32_t> slots;
  std::vector<LineElement> left, right;
  std::vector<Eye> eyes;
  Pose pose;

  explicit World(Wild& wild) {
    for (std::uint32_t i = 0; i < 48; ++i) {  // no lane is left uninitialised, as in the store
      put(wild.any_geometry(), i);
      store(wild.any_appearance(), appearance[i / 16], i % 16);
    }
    if (wild.one_in(3)) {
      pose.R = wild.rotation();
      pose.t = wild.log_uniform(1e-3, 1e6) * wild.normal3();
    }
    for (std::uint32_t i = 0; i < kN; ++i) {
      slots.push_back((i * 11) % 48);
      left.push_back(wild.any_view(geometry_at(slots[i]), pose, 0));
      right.push_back(wild.any_view(geometry_at(slots[i]), pose, 0.12));
      eyes.push_back(wild.one_in(2) ? Eye::kLeft : Eye::kRight);
    }
  }
  void put(const Geometry& g, std::uint32_t slot) { store(g, geometry[slot / 16], slot % 16); }
  [[nodiscard]] Geometry geometry_at(std::uint32_t slot) const { return load(geometry[slot / 16], slot % 16); }
  [[nodiscard]] AppearanceState appearance_at(std::uint32_t slot) const {
    return load(appearance[slot / 16], slot % 16);
  }
};

const AlignedOptics kOptics = Optics{}.aligned();

// Runs `update` on a copy of the world for every instruction set, and checks what it did to the poses.
template <class Update>
void check_update(const World& start, Update update) {
  for (const Kernels* k : all_kernels()) {
    World w = start;
    std::vector<UpdateOutcome> out(kN);
    update(*k, w, out);
    for (std::uint32_t slot = 0; slot < 48; ++slot) {
      const auto i = static_cast<std::size_t>(std::find(w.slots.begin(), w.slots.end(), slot) - w.slots.begin());
      const bool updated = i < kN && out[i] == UpdateOutcome::kUpdated;
      if (updated) {
        RC_ASSERT(is_state(w.geometry_at(slot)));
      } else {
        RC_ASSERT(same_bits(w.geometry_at(slot), start.geometry_at(slot)));
      }
      if (i < kN) RC_TAG(static_cast<int>(out[i]));
    }
  }
}

RC_GTEST_PROP(RobustArithmetic, update_stereo, (std::uint32_t seed)) {
  for (std::uint32_t world = 0; world < kWorlds; ++world) {
    Wild wild(20 * seed + world);
    check_update(World(wild), [](const Kernels& k, World& w, std::span<UpdateOutcome> out) {
      k.update_stereo(w.geometry, w.slots, w.left, w.right, w.pose.aligned(), kOptics, out, {});
    });
  }
}

RC_GTEST_PROP(RobustArithmetic, update_stereo_with_a_cap_on_the_slide, (std::uint32_t seed)) {
  for (std::uint32_t world = 0; world < kWorlds; ++world) {
    Wild wild(20 * seed + world);
    std::vector<float> cap(kN);
    for (float& c : cap) c = static_cast<float>(wild.log_uniform(1e-12, 1e6));
    check_update(World(wild), [&](const Kernels& k, World& w, std::span<UpdateOutcome> out) {
      k.update_stereo(w.geometry, w.slots, w.left, w.right, w.pose.aligned(), kOptics, out, cap);
    });
  }
}

RC_GTEST_PROP(RobustArithmetic, update_mono, (std::uint32_t seed)) {
  for (std::uint32_t world = 0; world < kWorlds; ++world) {
    Wild wild(20 * seed + world);
    check_update(World(wild), [](const Kernels& k, World& w, std::span<UpdateOutcome> out) {
      k.update_mono(w.geometry, w.slots, w.left, w.eyes, w.pose.aligned(), kOptics, out, {});
    });
  }
}

RC_GTEST_PROP(RobustArithmetic, update_roll, (std::uint32_t seed)) {
  for (std::uint32_t world = 0; world < kWorlds; ++world) {
    Wild wild(20 * seed + world);
    const auto sigma = static_cast<float>(wild.log_uniform(1e-6, 1e3));
    check_update(World(wild), [&](const Kernels& k, World& w, std::span<UpdateOutcome> out) {
      k.update_roll(w.geometry, w.slots, w.pose.aligned(), kOptics, sigma, out);
    });
  }
}

// What the store never holds, if something else is broken: refused, and left as it is.
RC_GTEST_PROP(RobustArithmetic, states_that_are_none_are_left_alone, (std::uint32_t seed)) {
  for (std::uint32_t world = 0; world < kWorlds; ++world) {
    Wild wild(20 * seed + world);
    World start(wild);
    std::vector<bool> broken(48, false);
    for (std::uint32_t slot = 0; slot < 48; slot += 1 + wild.index(5)) {
      Geometry g = start.geometry_at(slot);
      const std::size_t i = wild.index(6);
      float& variance = g.covariance[packed_index(6, i, i)];
      constexpr float kBad[] = {-1.0F, 0.0F, std::numeric_limits<float>::quiet_NaN(),
                                std::numeric_limits<float>::infinity()};
      variance = kBad[wild.index(4)];
      start.put(g, slot);
      broken[slot] = true;
    }
    for (const Kernels* k : all_kernels()) {
      World w = start;
      std::vector<UpdateOutcome> out(kN);
      k->update_stereo(w.geometry, w.slots, w.left, w.right, w.pose.aligned(), kOptics, out, {});
      for (std::size_t i = 0; i < kN; ++i)
        if (broken[w.slots[i]]) {
          RC_ASSERT(out[i] != UpdateOutcome::kUpdated);
          RC_ASSERT(same_bits(w.geometry_at(w.slots[i]), start.geometry_at(w.slots[i])));
        }
    }
  }
}

RC_GTEST_PROP(RobustArithmetic, update_appearance, (std::uint32_t seed)) {
  for (std::uint32_t world = 0; world < kWorlds; ++world) {
    Wild wild(20 * seed + world);
    const World start(wild);
    std::vector<Appearance> looks(kN);
    std::vector<float> value[5];
    for (std::size_t i = 0; i < kN; ++i) {
      looks[i] = wild.any_look();
      for (auto& v : value) v.push_back(static_cast<float>(std::sqrt(wild.log_uniform(1e-12, 1e6))));
    }
    for (const Kernels* k : all_kernels()) {
      World w = start;
      std::vector<UpdateOutcome> out(kN);
      k->update_appearance(w.appearance, w.slots, looks, value[0], value[1], value[2], value[3], value[4], out);
      for (std::size_t i = 0; i < kN; ++i) {
        if (out[i] == UpdateOutcome::kUpdated) {
          RC_ASSERT(is_state(w.appearance_at(w.slots[i])));
        } else {
          RC_ASSERT(same_bits(w.appearance_at(w.slots[i]), start.appearance_at(w.slots[i])));
        }
      }
    }
  }
}

RC_GTEST_PROP(RobustArithmetic, predict_observations, (std::uint32_t seed)) {
  for (std::uint32_t world = 0; world < kWorlds; ++world) {
    Wild wild(20 * seed + world);
    const World w(wild);
    for (const Kernels* k : all_kernels()) {
      std::vector<PredictedObservation> seen(kN);
      k->predict_observations(w.geometry, w.slots, w.pose.aligned(), kOptics, seen);
      for (const PredictedObservation& p : seen) {
        for (const float v : {p.x_l, p.y_l, p.c_l, p.s_l, p.x_r, p.y_r, p.c_r, p.s_r, p.depth_m})
          RC_ASSERT(std::isfinite(v));
        MatrixXd C(4, 4);
        for (std::size_t i = 0; i < 4; ++i)
          for (std::size_t j = 0; j < 4; ++j)
            C(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
                p.covariance[packed_index(4, std::min(i, j), std::max(i, j))];
        RC_ASSERT(C.allFinite());
        if (!p.valid) continue;
        RC_ASSERT(smallest_scaled_eigenvalue(C) > 0);
        RC_ASSERT(std::fabs(std::hypot(p.c_l, p.s_l) - 1) < 1e-4);
        RC_ASSERT(std::fabs(std::hypot(p.c_r, p.s_r) - 1) < 1e-4);
      }
    }
  }
}

RC_GTEST_PROP(RobustArithmetic, motion_noise, (std::uint32_t seed)) {
  for (std::uint32_t world = 0; world < kWorlds; ++world) {
    Wild wild(20 * seed + world);
    const World start(wild);
    const MatrixXd Q = wild.any_covariance(6);
    PoseCovariance increment;
    for (std::size_t i = 0; i < 36; ++i)
      increment[i] = Q(static_cast<Eigen::Index>(i / 6), static_cast<Eigen::Index>(i % 6));
    Transform<Map, Left> T;
    T.translation = {wild.log_uniform(1e-3, 1e9), wild.uniform(-1, 1), 0};
    for (const Kernels* k : all_kernels()) {
      World w = start;
      k->add_incremental_motion_noise(w.geometry, T, increment);
      for (std::uint32_t slot = 0; slot < 48; ++slot) {
        const Geometry g = w.geometry_at(slot), before = start.geometry_at(slot);
        RC_ASSERT(is_state(g));
        RC_ASSERT(g.position == before.position && g.quaternion == before.quaternion);
        for (std::size_t i = 0; i < 6; ++i)
          RC_ASSERT(g.covariance[packed_index(6, i, i)] >= before.covariance[packed_index(6, i, i)]);
      }
    }
  }
}

RC_GTEST_PROP(RobustArithmetic, reconstruct_and_transform, (std::uint32_t seed)) {
  for (std::uint32_t world = 0; world < kWorlds; ++world) {
    Wild wild(20 * seed + world);
    for (int i = 0; i < 50; ++i) {
      const Geometry untouched = wild.any_geometry();
      LineElement l = wild.any_element(), r = wild.any_element();
      if (wild.one_in(2)) {  // a pair that belongs together
        l = wild.any_view(untouched, {}, 0);
        r = wild.any_view(untouched, {}, 0.12);
      }
      Geometry g = untouched;
      const auto slide = static_cast<float>(wild.log_uniform(1e-6, 1e3)),
                 roll = static_cast<float>(wild.uniform(0.1, 3));
      const ReconstructOutcome outcome = reconstruct(l, r, kOptics, slide, roll, g);
      if (outcome == ReconstructOutcome::kOk) {
        RC_ASSERT(is_state(g));
        RC_ASSERT(g.position[2] > 0);
      } else {
        RC_ASSERT(same_bits(g, untouched));
      }
      Pose to;
      to.R = wild.rotation();
      to.t = wild.log_uniform(1e-3, 1e38) * wild.normal3();
      const AlignedPose T = to.aligned();
      const Geometry before = g;
      if (transform(g, T.R, T.t)) {
        RC_ASSERT(is_state(g));
      } else {
        RC_ASSERT(same_bits(g, before));
      }
    }
  }
}

RC_GTEST_PROP(RobustArithmetic, fusion_and_its_distances, (std::uint32_t seed)) {
  for (std::uint32_t world = 0; world < kWorlds; ++world) {
    Wild wild(20 * seed + world);
    for (int i = 0; i < 50; ++i) {
      const Geometry a = wild.any_geometry();
      Geometry b = wild.any_geometry();
      if (wild.one_in(2)) b.quaternion = a.quaternion;
      if (wild.one_in(2)) b.position = a.position;
      const AppearanceState s = wild.any_appearance(), t = wild.any_appearance();
      Geometry g = a;
      AppearanceState look = s;
      RC_ASSERT(merge_distance2(a, b) >= 0);
      RC_ASSERT(appearance_distance2(s, t, opposite(a, b)) >= 0);
      if (fuse_by_covariance_intersection(g, look, b, t)) {
        RC_ASSERT(is_state(g));
        RC_ASSERT(is_state(look));
      } else {
        RC_ASSERT(same_bits(g, a));
        RC_ASSERT(same_bits(look, s));
      }
    }
  }
}

}  // namespace
}  // namespace accrete
