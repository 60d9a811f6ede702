// What a step or a configuration cannot use is refused with its status and changes nothing; what is too much is
// counted.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "accrete/contract.h"
#include "core/poster.h"

namespace accrete {
namespace {

using namespace test;

using Small = Accumulator<PosterLimits>;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(AccumulatorRefuses, a_step_before_it_is_configured) {
  Poster poster;
  const auto a = std::make_unique<Small>();
  EXPECT_EQ(a->step(poster.render(0), Poster::motion(0)).status, Status::kUnavailable);
  EXPECT_EQ(a->model().size(), 0U);
  EXPECT_EQ(a->model().slots(), PosterLimits::kMaxPrimitives3d);
  a->reset();
  EXPECT_EQ(a->step(poster.render(0), Poster::motion(0)).status, Status::kUnavailable);
}

// An accumulator in the middle of its work.
struct Running {
  Poster poster;
  std::unique_ptr<Small> a = std::make_unique<Small>();
  static constexpr int kFrames = 8;

  Running() {
    EXPECT_EQ(a->configure(poster.rig.rig), Status::kOk);
    for (int k = 0; k < kFrames; ++k) EXPECT_EQ(a->step(poster.render(k), Poster::motion(k)).status, Status::kOk);
    EXPECT_GT(a->model().size(), 20U);
  }
  void expect_refused(const StereoFrame& frame, const Motion& motion, Status status, const char* what) {
    const auto before = all_slots(a->model());
    const std::size_t seen = a->left_primitives().size();
    const StepReport r = a->step(frame, motion);
    EXPECT_EQ(r.status, status) << what;
    EXPECT_TRUE(same(all_slots(a->model()), before)) << what;
    EXPECT_EQ(a->left_primitives().size(), seen) << what;
    EXPECT_EQ(r.born, 0U) << what;
  }
};

TEST(AccumulatorRefuses, frames_that_do_not_fit_and_goes_on_as_if_they_had_not_been) {
  Running run, undisturbed;
  const int next = Running::kFrames;
  const StereoFrame good = run.poster.render(next);
  const Motion motion = Poster::motion(next);
  const auto with = [&](auto change) {
    StereoFrame f = good;
    change(f);
    return f;
  };
  const Picture small = paint_grey(160, 120, [](double x, double) { return x; });
  const Picture tall = paint_grey(320, 241, [](double x, double) { return x * 0.5; });
  const Status bad = Status::kInvalidArgument;
  run.expect_refused(with([&](StereoFrame& f) { f.left = small.view(); }), motion, bad, "left of another size");
  run.expect_refused(with([&](StereoFrame& f) { f.right = small.view(); }), motion, bad, "right of another size");
  run.expect_refused(with([&](StereoFrame& f) { f.left = f.right = tall.view(); }), motion, bad, "beyond the limits");
  run.expect_refused(with([](StereoFrame& f) { f.left = {}; }), motion, bad, "no left image");
  run.expect_refused(with([](StereoFrame& f) { f.right.data = nullptr; }), motion, bad, "no right pixels");
  run.expect_refused(with([](StereoFrame& f) { f.left.stride_bytes = 319; }), motion, bad, "stride too small");
  run.expect_refused(with([](StereoFrame& f) { f.left.width_px = -320; }), motion, bad, "negative width");
  run.expect_refused(with([](StereoFrame& f) { f.t_left = Poster::time_of(2); }), motion, bad, "time backwards");
  run.expect_refused(with([](StereoFrame& f) { f.t_left = Poster::time_of(Running::kFrames - 1); }), motion, bad,
                     "the same time again");
  const auto moved = [&](auto change) {
    Motion m = motion;
    change(m);
    return m;
  };
  const double inf = std::numeric_limits<double>::infinity();
  run.expect_refused(good, moved([](Motion& m) { m.T_l_m.translation[1] = kNaN; }), bad, "NaN in the position");
  run.expect_refused(good, moved([&](Motion& m) { m.T_l_m.translation[2] = inf; }), bad, "infinitely far");
  run.expect_refused(good, moved([](Motion& m) { m.T_l_m.rotation.w = kNaN; }), bad, "NaN in the rotation");
  run.expect_refused(good, moved([](Motion& m) { m.T_l_m.rotation = {0, 0, 0, 2}; }), bad, "a rotation that is none");
  run.expect_refused(good, moved([](Motion& m) { m.T_l_m.rotation = {0, 0, 0, 0}; }), bad, "a rotation of nothing");
  run.expect_refused(good, moved([](Motion& m) { m.covariance[0] = -1; }), bad, "a negative variance");
  run.expect_refused(good, moved([](Motion& m) { m.covariance[7] = kNaN; }), bad, "NaN in the covariance");
  run.expect_refused(good, moved([](Motion& m) { m.covariance[1] = 1; }), bad, "a covariance that is not symmetric");

  // The good frame still goes in, with the result of one that was never disturbed.
  const StepReport r = run.a->step(good, motion);
  EXPECT_EQ(r.status, Status::kOk);
  EXPECT_EQ(r.frame, static_cast<std::uint32_t>(next));
  (void)undisturbed.a->step(undisturbed.poster.render(next), motion);
  EXPECT_TRUE(same(all_slots(run.a->model()), all_slots(undisturbed.a->model())));
}

TEST(AccumulatorRefuses, configurations_that_cannot_work_and_keeps_the_old_one) {
  Running run, undisturbed;
  const auto before = all_slots(run.a->model());
  const auto refused = [&](auto change, Status status, const char* what) {
    StereoRig rig = run.poster.rig.rig;
    Params params;
    change(rig, params);
    EXPECT_EQ(run.a->configure(rig, params), status) << what;
    EXPECT_TRUE(same(all_slots(run.a->model()), before)) << what;
  };
  const Status bad = Status::kInvalidArgument;
  refused([](StereoRig& r, Params&) { r.left.fx_px = kNaN; }, bad, "NaN in the calibration");
  refused([](StereoRig& r, Params&) { r.right.fy_px = 0; }, bad, "no focal length");
  refused([](StereoRig& r, Params&) { r.T_r_l.translation = {0, 0, 0}; }, bad, "no baseline");
  refused([](StereoRig& r, Params&) { r.T_r_l.translation[0] = 0.12; }, bad, "eyes swapped");
  refused([](StereoRig& r, Params&) { r.T_r_l.rotation = {0, 0, 0, 3}; }, bad, "a rotation that is none");
  refused([](StereoRig&, Params& p) { p.existence.decide = -1; }, bad, "a threshold below zero");
  refused([](StereoRig&, Params& p) { p.stereo.min_depth_m = 2, p.stereo.max_depth_m = 1; }, bad, "an empty range");
  refused([](StereoRig&, Params& p) { p.extract.noise_sigma = static_cast<float>(kNaN); }, bad, "NaN in a parameter");
  refused([](StereoRig&, Params& p) { p.excluded_count = 99; }, bad, "more boxes than there are");
  const Status large = Status::kCapacityExceeded;
  refused([](StereoRig& r, Params&) { r.left.width_px = 321; }, large, "an image wider than the limits");
  refused([](StereoRig& r, Params&) { r.right.height_px = 241; }, large, "an image taller than the limits");

  const int next = Running::kFrames;
  EXPECT_EQ(run.a->step(run.poster.render(next), Poster::motion(next)).status, Status::kOk);
  (void)undisturbed.a->step(undisturbed.poster.render(next), Poster::motion(next));
  EXPECT_TRUE(same(all_slots(run.a->model()), all_slots(undisturbed.a->model())));
}

TEST(AccumulatorRefuses, nothing_of_black_images_but_they_move_nothing_either) {
  Running run;
  const auto before = all_slots(run.a->model());
  run.poster.black = true;
  const StepReport r = run.a->step(run.poster.render(Running::kFrames), Poster::motion(Running::kFrames));
  EXPECT_EQ(r.status, Status::kOk);
  EXPECT_EQ(r.left.primitives + r.right.primitives, 0U);
  EXPECT_EQ(r.stereo_matches, 0U);
  EXPECT_EQ(r.born + r.updated + r.matched_stereo + r.matched_mono, 0U);
  const auto after = all_slots(run.a->model());
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (after[i].state == State::kFree) continue;
    EXPECT_EQ(after[i].geometry.position, before[i].geometry.position);
    EXPECT_EQ(after[i].appearance.mean.left, before[i].appearance.mean.left);
    EXPECT_EQ(after[i].observations, before[i].observations);
  }
  // A lens cap for one frame costs none of the accepted ones.
  EXPECT_EQ(r.deleted_existence + r.deleted_background + r.confirmed + r.preserved + r.tentative,
            static_cast<std::uint32_t>(
                std::count_if(before.begin(), before.end(), [](const auto& p) { return p.state != State::kFree; })));
  for (std::size_t i = 0; i < before.size(); ++i)
    if (before[i].state == State::kConfirmed) {
      EXPECT_NE(after[i].state, State::kFree);
    }
}

TEST(AccumulatorRefuses, saturated_images_and_poses_behind_the_cameras_do_no_harm) {
  Running run;
  const Picture white = paint(320, 240, PixelFormat::kRgb8, [](double, double) { return Rgb{255, 255, 255}; });
  EXPECT_EQ(run.a->step(Poster::frame_of(white, white, 20), Poster::motion(20)).left.primitives, 0U);
  Motion behind = Poster::motion(21);
  behind.T_l_m.translation[2] = -5;
  const StepReport r = run.a->step(run.poster.render(21), behind);
  EXPECT_EQ(r.status, Status::kOk);
  EXPECT_GT(r.predicted_behind, 0U);
  EXPECT_EQ(r.matched_stereo + r.matched_mono, 0U);
  // At the centre of the map, and absurdly far.
  for (const double z : {0.0, 1e30}) {
    Motion m = Poster::motion(22);
    m.T_l_m.translation = {0, 0, z};
    StereoFrame f = run.poster.render(22);
    f.t_left.ns += z > 0 ? 1 : 0;
    EXPECT_EQ(run.a->step(f, m).status, Status::kOk);
  }
  for (const Primitive3d& p : all_slots(run.a->model()))
    for (const float v : p.geometry.covariance) EXPECT_TRUE(std::isfinite(v));
}

struct TinyLimits {
  static constexpr std::size_t kMaxImageWidth = 320, kMaxImageHeight = 240;
  static constexpr std::size_t kMaxPrimitives2d = 128, kMaxPrimitives3d = 16, kMaxStereoMatches = 128;
};

TEST(AccumulatorRefuses, more_edges_than_capacity_are_bounded_and_counted) {
  Poster poster;
  const auto a = std::make_unique<Accumulator<TinyLimits>>();
  const auto full = std::make_unique<Small>();
  ASSERT_EQ(a->configure(poster.rig.rig), Status::kOk);
  ASSERT_EQ(full->configure(poster.rig.rig), Status::kOk);
  std::uint32_t refused = 0, evicted = 0;
  for (int k = 0; k < 12; ++k) {
    const StereoFrame f = poster.render(k);
    const StepReport r = a->step(f, Poster::motion(k));
    (void)full->step(f, Poster::motion(k));
    ASSERT_EQ(r.status, Status::kOk);
    EXPECT_EQ(r.left.primitives, 128U);
    EXPECT_GT(r.left.refused_capacity, 0U);
    EXPECT_LE(a->stereo_matches().size(), 128U);
    EXPECT_LE(r.tentative + r.confirmed + r.preserved, 16U);
    // The best are kept: the weakest of them is among the strongest of all.
    std::vector<float> all;
    for (const Primitive2d& p : full->left_primitives()) all.push_back(p.amplitude);
    std::sort(all.rbegin(), all.rend());
    for (const Primitive2d& p : a->left_primitives()) EXPECT_GE(p.amplitude, all[127]);
    refused += r.birth_refused_capacity + r.stereo_refused_capacity;
    evicted += r.evicted;
  }
  EXPECT_GT(refused + evicted, 0U);
}

int violations = 0;
TEST(AccumulatorRefuses, no_capacity_that_its_memory_would_not_hold) {
  const ContractHandler before = set_contract_handler([](const ContractViolation&) { ++violations; });
  Dice dice(1);
  for (int k = 0; k < 40; ++k) {
    Capacities c;  // whatever CheckedLimits lets through
    c.image_width = 32 + dice.below(k % 3 == 0 ? 8161 : 400);
    c.image_height = 32 + dice.below(300);
    c.primitives2d = 16 + dice.below(k % 4 == 0 ? 65520 : 300);
    c.primitives3d = 16 * (1 + dice.below(k % 5 == 0 ? 1000 : 20));
    c.stereo_matches = c.primitives2d + dice.below(100);
    std::vector<std::byte> memory(storage_bytes(c) + 64);
    void* begin = memory.data();
    std::size_t space = memory.size();
    ASSERT_NE(std::align(64, storage_bytes(c), begin, space), nullptr);
    construct_pipeline({static_cast<std::byte*>(begin), storage_bytes(c)}, c);
    EXPECT_EQ(violations, 0) << k;
  }
  set_contract_handler(before);
}

}  // namespace
}  // namespace accrete
