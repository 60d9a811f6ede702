// Numbers about 2^-126, the smallest normal one, and below: results are the same bits whether the processor flushes
// subnormal numbers to zero or computes with them (x86, AArch64 and ARM flush differently; some ARM units always do).
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <vector>

#include "base/elementary.h"
#include "determinism/flush.h"
#include "determinism/replay.h"
#include "determinism/size.h"
#include "kernels/kernels.h"
#include "numeric/dice.h"

namespace accrete {
namespace {

using namespace determinism;
using namespace oracle;

// 2^-149 is the smallest number of all; 2^-100 and 2^-70 have products that are subnormal.
constexpr float kTiny[] = {0x1p-126F, -0x1p-126F, 0x1.8p-127F, 0x1p-127F, -0x1p-130F, 0x1p-140F,
                           0x1p-149F, -0x1p-149F, 0x1p-125F,   0x1p-100F, -0x1p-70F,  0x1p-64F};
float tiny(std::size_t i) { return kTiny[i % std::size(kTiny)]; }

class Flushing {
 public:
  explicit Flushing(bool on) : on_(on) {
    if (on) available_ = flush_subnormals();
  }
  ~Flushing() {
    if (on_) flush_subnormals(false);
  }
  Flushing(const Flushing&) = delete;
  Flushing& operator=(const Flushing&) = delete;
  [[nodiscard]] bool available() const { return available_; }

 private:
  bool on_, available_ = true;
};

struct alignas(64) Line {
  std::byte bytes[64];
};

void disturb(int step, std::span<Primitive2d> eye) {
  for (std::size_t i = 0; i < eye.size(); ++i) {
    const std::size_t k = i + static_cast<std::size_t>(step);
    Primitive2d& p = eye[i];
    if (k % 3 == 0) p.appearance.left[k % 2] = tiny(k);
    if (k % 5 == 0) p.appearance.right = {tiny(k), tiny(k + 1), tiny(k + 2)};
    if (k % 7 == 0) p.appearance.phase = tiny(k);
    if (k % 11 == 0) p.flow_px = tiny(k);
    if (k % 13 == 0) p.theta = std::fabs(tiny(k));
    if (k % 29 == 0) p.x_px = std::fabs(tiny(k));  // the border of the image
  }
}

std::uint64_t replayed(bool flush, bool disturbed, InstructionSet set) {
  constexpr Capacities kRoom = Accumulator<ShortForm>::kCapacities;
  std::vector<Line> memory(storage_bytes(kRoom) / sizeof(Line));
  Pipeline* pipeline = construct_pipeline({memory.front().bytes, memory.size() * sizeof(Line)}, kRoom, set);
  std::vector<accrete::determinism::Edge> edges(ShortForm::kEdges);
  std::vector<Primitive2d> left(kRoom.primitives2d), right(kRoom.primitives2d);
  const Flushing flushing(flush);
  const Outcome out = run(*pipeline, {edges, left, right, ShortForm::kSteps, nullptr, disturbed ? disturb : nullptr});
  EXPECT_GT(out.totals.confirmed, 10U);
  return out.state;
}

TEST(Subnormal, a_replay_of_tiny_measurements) {
  if (!Flushing(true).available()) GTEST_SKIP() << "this processor has no such mode";
  for (const InstructionSet set : {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    if (!is_available(set)) continue;
    EXPECT_EQ(replayed(true, false, set), replayed(false, false, set)) << name(set);
    EXPECT_EQ(replayed(true, true, set), replayed(false, true, set)) << name(set);
    EXPECT_NE(replayed(true, true, set), replayed(true, false, set)) << "the disturbance must arrive";
  }
}

// The mode is really on: otherwise the tests above compare equal things.
TEST(Subnormal, the_processor_flushes) {
  const Flushing flushing(true);
  if (!flushing.available()) GTEST_SKIP() << "this processor has no such mode";
  volatile float smallest = 0x1p-126F;
  EXPECT_EQ(smallest * 0.5F, 0);
}

TEST(Subnormal, elementary_functions) {
  if (!Flushing(true).available()) GTEST_SKIP() << "this processor has no such mode";
  const auto all = [](bool flush) {
    const Flushing flushing(flush);
    std::vector<float> out;
    for (const float x : kTiny)
      for (const float y : {1.0F, -3.0F, 0x1p-126F, -0x1p-131F, 0x1p-120F, 1e30F}) {
        volatile float a = x, b = y;
        for (const float v : {sin_of<float>(a), cos_of<float>(a), exp_of<float>(a), log_of<float>(a),
                              atan2_of<float>(a, b), atan2_of<float>(b, a), normal_cdf_of<float>(a)})
          out.push_back(v == 0 ? 0 : v);  // zeros have no sign
      }
    for (float x = -20; x < 0; x += 0.01F) out.push_back(normal_cdf_of(x));
    for (float x = -110; x < -80; x += 0.01F) out.push_back(exp_of(x));
    return out;
  };
  const std::vector<float> flushed = all(true), ieee = all(false);
  ASSERT_EQ(flushed.size(), ieee.size());
  for (std::size_t i = 0; i < ieee.size(); ++i) {
    ASSERT_EQ(std::bit_cast<std::uint32_t>(flushed[i]), std::bit_cast<std::uint32_t>(ieee[i])) << i;
    ASSERT_TRUE(ieee[i] == 0 || !(std::fabs(ieee[i]) < 0x1p-126F)) << i << " is subnormal: " << ieee[i];
  }
}

// States with covariances, positions and colours that small, through every function on lanes.
struct States {
  std::vector<GeometryBlock> geometry;
  std::vector<AppearanceBlock> appearance;
};

States stepped(bool flush, const Kernels& k) {
  constexpr std::size_t kCount = 192;
  Dice dice(3);
  const Pose pose;
  const Optics optics;
  States s{std::vector<GeometryBlock>(kCount / 16), std::vector<AppearanceBlock>(kCount / 16)};
  std::vector<LineElement> left, right;
  std::vector<std::uint32_t> slots;
  std::vector<Appearance> looks;
  for (std::size_t i = 0; i < kCount; ++i) {
    const oracle::Edge x = dice.edge(3e-3, 0.2, 0.8);
    Geometry g = record_of(x);
    for (std::size_t a = 0; a < 6; ++a)
      for (std::size_t b = a + 1; b < 6; ++b) g.covariance[packed_index(6, a, b)] = tiny(i + 7 * a + b);
    if (i % 4 == 1) g.position[0] = tiny(i);
    store(g, s.geometry[i / 16], i % 16);
    AppearanceState a;
    for (std::size_t r = 0; r < 7; ++r)
      for (std::size_t c = r; c < 7; ++c) a.covariance[packed_index(7, r, c)] = r == c ? 0.01F : tiny(i + 3 * r + c);
    a.mean = {tiny(i), {tiny(i + 1), 0.5F, tiny(i + 2)}, {0.5F, tiny(i + 3), tiny(i + 4)}};
    store(a, s.appearance[i / 16], i % 16);
    left.push_back(dice.observe(x, pose, optics, 0, 0.3, 0.035, 2));
    right.push_back(dice.observe(x, pose, optics, optics.baseline, 0.3, 0.035, 2));
    slots.push_back(static_cast<std::uint32_t>(i));
    looks.push_back({tiny(i + 5), {tiny(i), tiny(i + 6), 0.2F}, {0.9F, tiny(i + 8), tiny(i)}});
  }
  const Flushing flushing(flush);
  std::vector<UpdateOutcome> out(kCount);
  const std::vector<Eye> eyes(kCount, Eye::kRight);
  const std::vector<float> sigma(kCount, 0.1F), q(kCount, 0x1p-126F);
  PoseCovariance increment{};
  for (std::size_t i = 0; i < 6; ++i) increment[7 * i] = i % 2 == 0 ? 1e-8 : 1e-40;
  for (int round = 0; round < 20; ++round) {
    k.add_incremental_motion_noise(s.geometry, {}, increment);
    k.update_stereo(s.geometry, slots, left, right, pose.aligned(), optics.aligned(), out, {});
    k.update_mono(s.geometry, slots, right, eyes, pose.aligned(), optics.aligned(), out, {});
    k.update_roll(s.geometry, slots, pose.aligned(), optics.aligned(), 0.87F, out);
    k.update_appearance(s.appearance, slots, looks, sigma, sigma, sigma, q, q, out);
  }
  return s;
}

TEST(Subnormal, states_through_the_filter) {
  if (!Flushing(true).available()) GTEST_SKIP() << "this processor has no such mode";
  for (const InstructionSet set : {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    if (!is_available(set)) continue;
    const States a = stepped(false, kernels(set)), b = stepped(true, kernels(set));
    int different = 0;
    const auto compare = [&](const float* x, const float* y, std::size_t n, const char* what) {
      for (std::size_t i = 0; i < n; ++i)
        if (std::bit_cast<std::uint32_t>(x[i]) != std::bit_cast<std::uint32_t>(y[i]) && different++ < 10)
          ADD_FAILURE() << name(set) << ", " << what << " row " << i / 16 << ": " << x[i] << " or " << y[i];
    };
    for (std::size_t i = 0; i < a.geometry.size(); ++i) {
      compare(a.geometry[i].row[0], b.geometry[i].row[0], sizeof(GeometryBlock) / sizeof(float), "geometry");
      compare(a.appearance[i].row[0], b.appearance[i].row[0], sizeof(AppearanceBlock) / sizeof(float), "appearance");
    }
    EXPECT_EQ(different, 0) << name(set);
  }
}

}  // namespace
}  // namespace accrete
