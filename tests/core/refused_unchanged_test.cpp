// Bad input is refused with a status, and then not one byte of all the memory has changed: store, bookkeeping, images
// of the previous frame, scratch.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "accrete/contract.h"
#include "core/poster.h"

namespace accrete {
namespace {

using namespace test;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(), kInfinity = std::numeric_limits<double>::infinity();
constexpr Capacities kRoom = Accumulator<PosterLimits>::kCapacities;

// An accumulator whose memory can be looked at.
class Bare {
 public:
  explicit Bare(const Capacities& capacities)
      : memory_(storage_bytes(kRoom) / sizeof(Line)), pipeline_(construct_pipeline(bytes(), capacities)) {}
  Pipeline& operator*() { return *pipeline_; }
  [[nodiscard]] std::vector<std::byte> state() {
    const auto b = bytes();
    return {b.begin(), b.end()};
  }

 private:
  struct alignas(64) Line {
    std::byte b[64];
  };
  std::span<std::byte> bytes() { return {memory_.front().b, memory_.size() * sizeof(Line)}; }
  std::vector<Line> memory_;
  Pipeline* pipeline_;
};

struct Working {
  Poster poster;
  Bare a{kRoom};
  StereoFrame next;  // would be good
  static constexpr int kFrames = 6;

  Working() {
    EXPECT_EQ(configure(*a, poster.rig.rig, {}), Status::kOk);
    for (int k = 0; k < kFrames; ++k) EXPECT_EQ(step(*a, poster.render(k), Poster::motion(k)).status, Status::kOk);
    EXPECT_GT(model(*a).size(), 20U);
    next = poster.render(kFrames);
  }
  // What a step refuses: a change to a frame and a motion that would be good.
  template <class Change>
  void refuses(const char* what, Change change) {
    StereoFrame frame = next;
    Motion motion = Poster::motion(kFrames);
    change(frame, motion);
    const auto before = a.state();
    const StepReport r = step(*a, frame, motion);
    EXPECT_EQ(r.status, Status::kInvalidArgument) << what;
    const auto after = a.state();
    EXPECT_EQ(std::memcmp(before.data(), after.data(), before.size()), 0) << what;
  }
};

using Frame = StereoFrame;

TEST(RefusedUnchanged, a_covariance_of_the_motion_that_is_none) {
  Working w;
  const auto covariance = [&](const char* what, auto change) {
    for (const PoseError error : {PoseError::kAbsolute, PoseError::kIncremental})
      w.refuses(what, [&](Frame&, Motion& m) {
        m.error = error;
        m.covariance = diagonal_pose_covariance(1e-3, 1e-3);
        change(m.covariance);
      });
  };
  covariance("singular: one error is exactly zero", [](PoseCovariance& c) { c[14] = 0; });
  covariance("singular: the rotation is exact", [](PoseCovariance& c) { c[21] = c[28] = c[35] = 0; });
  covariance("singular: one error is another one", [](PoseCovariance& c) { c[1] = c[6] = 1e-6; });
  covariance("singular: of rank one", [](PoseCovariance& c) { c.fill(1e-6); });
  covariance("indefinite: a negative variance", [](PoseCovariance& c) { c[28] = -1e-12; });
  covariance("indefinite: a correlation above one", [](PoseCovariance& c) { c[1] = c[6] = 1.0001e-6; });
  covariance("indefinite: three errors against each other", [](PoseCovariance& c) {
    for (const std::size_t i : {0U, 1U, 2U})
      for (const std::size_t j : {0U, 1U, 2U})
        if (i != j) c[6 * i + j] = -0.6e-6;
  });
  covariance("not symmetric", [](PoseCovariance& c) { c[2] = 1e-7; });
  covariance("NaN", [](PoseCovariance& c) { c[3] = kNaN; });
  covariance("infinite", [](PoseCovariance& c) { c[35] = kInfinity; });
}

TEST(RefusedUnchanged, time_that_runs_backwards) {
  Working w;
  const Timestamp last = Poster::time_of(Working::kFrames - 1), early = Poster::time_of(0);
  w.refuses("the left image again", [&](Frame& f, Motion&) { f.t_left = last; });
  w.refuses("an earlier left image", [&](Frame& f, Motion&) { f.t_left = early; });
  w.refuses("the smallest time there is",
            [](Frame& f, Motion&) { f.t_left.ns = std::numeric_limits<std::int64_t>::min(); });
  w.refuses("an earlier right image", [&](Frame& f, Motion&) { f.t_right = early; });
  w.refuses("an earlier motion", [&](Frame&, Motion& m) { m.t = early; });
}

TEST(RefusedUnchanged, poses_and_images_that_are_none) {
  Working w;
  w.refuses("NaN in the position", [](Frame&, Motion& m) { m.T_l_m.translation[0] = kNaN; });
  w.refuses("infinitely far", [](Frame&, Motion& m) { m.T_l_m.translation[2] = kInfinity; });
  w.refuses("a rotation that is none", [](Frame&, Motion& m) { m.T_l_m.rotation = {0, 0, 0, 1.01}; });
  w.refuses("no left image", [](Frame& f, Motion&) { f.left = {}; });
  w.refuses("a right image of another size", [](Frame& f, Motion&) { f.right.height_px -= 1; });
}

TEST(RefusedUnchanged, rigs_and_parameters_that_cannot_work) {
  Working w;
  const auto refuses = [&](const char* what, auto change) {
    StereoRig rig = w.poster.rig.rig;
    Params params;
    change(rig, params);
    const auto before = w.a.state();
    EXPECT_NE(configure(*w.a, rig, params), Status::kOk) << what;
    const auto after = w.a.state();
    EXPECT_EQ(std::memcmp(before.data(), after.data(), before.size()), 0) << what;
  };
  refuses("NaN in the calibration", [](StereoRig& r, Params&) { r.left.fx_px = kNaN; });
  refuses("no baseline", [](StereoRig& r, Params&) { r.T_r_l.translation = {}; });
  refuses("an image wider than the memory", [](StereoRig& r, Params&) { r.left.width_px = 1000; });
  refuses("a negative bias", [](StereoRig&, Params& p) { p.filter.bias_px = -1; });
}

// At compile time limits.h says so (must_not_compile); whoever brings his own memory hears it from configure.
TEST(RefusedUnchanged, a_store_with_zero_capacity) {
  Poster poster;
  const auto refuses = [&](const char* what, auto change) {
    Capacities c = kRoom;
    change(c);
    EXPECT_EQ(validate(c), Status::kInvalidArgument) << what;
    Bare a(c);
    const auto before = a.state();
    EXPECT_EQ(configure(*a, poster.rig.rig, {}), Status::kInvalidArgument) << what;
    EXPECT_EQ(step(*a, poster.render(0), Poster::motion(0)).status, Status::kUnavailable) << what;
    const auto after = a.state();
    EXPECT_EQ(std::memcmp(before.data(), after.data(), before.size()), 0) << what;
    EXPECT_EQ(model(*a).slots(), 0U) << what;
    reset(*a);
    EXPECT_EQ(model(*a).size(), 0U) << what;
  };
  EXPECT_EQ(validate(kRoom), Status::kOk);
  refuses("no primitive fits", [](Capacities& c) { c.primitives3d = 0; });
  refuses("a block that is not whole", [](Capacities& c) { c.primitives3d = 24; });
  refuses("nothing", [](Capacities& c) { c = {}; });
  refuses("no 2D-primitive", [](Capacities& c) { c.primitives2d = 0; });
  refuses("more than 16 bits count", [](Capacities& c) { c.primitives2d = c.stereo_matches = 65536; });
  refuses("no match", [](Capacities& c) { c.stereo_matches = 0; });
  refuses("an image without columns", [](Capacities& c) { c.image_width = 0; });
}

// What is no mistake, however absurd, is used: the model stays made of finite Gaussians, and goes on.
TEST(RefusedUnchanged, any_finite_motion_is_used_and_does_no_harm) {
  Working w;
  int n = Working::kFrames;
  const auto use = [&](auto change) {
    Motion m = Poster::motion(n);
    change(m);
    const StereoFrame f = w.poster.render(n++);
    EXPECT_EQ(step(*w.a, f, m).status, Status::kOk);
    for (const Primitive3d& p : all_slots(model(*w.a))) {
      bool finite = true;
      for (const float v : p.geometry.covariance) finite = finite && std::isfinite(v);
      for (const float v : p.geometry.position) finite = finite && std::isfinite(v);
      for (const float v : p.appearance.covariance) finite = finite && std::isfinite(v);
      ASSERT_TRUE(finite);
      for (const std::size_t i : {0U, 1U, 2U, 3U, 4U, 5U})
        ASSERT_TRUE(p.state == State::kFree || p.geometry.covariance[packed_index(6, i, i)] > 0);
    }
  };
  for (const double far : {1e3, 1e9, 1e30, 1e300, -1e300})
    use([&](Motion& m) { m.T_l_m.translation = {far, 0, std::fabs(far)}; });
  for (const PoseError error : {PoseError::kAbsolute, PoseError::kIncremental})
    for (const double sigma : {1e-6, 1.0, 1e3, 1e100})
      use([&](Motion& m) {
        m.error = error;
        m.covariance = diagonal_pose_covariance(sigma, sigma);
      });
  const StereoFrame f = w.poster.render(n);
  EXPECT_EQ(step(*w.a, f, Poster::motion(n)).status, Status::kOk);
}

}  // namespace
}  // namespace accrete
