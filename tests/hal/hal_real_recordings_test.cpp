// The real recordings: opened, played to the end, and their conventions checked against what is known of them.
#include <gtest/gtest.h>

#include "opened.h"
#include "outcome_matchers.h"
#include "support/data_folder.h"

namespace accrete::hal {
namespace {

class RealRecording : public testing::Test {
 protected:
  void SetUp() override {
    if (!ACCRETE_HAS_PNG || !ACCRETE_HAS_JPEG || !ACCRETE_HAS_YAML)
      GTEST_SKIP() << "this build leaves PNG, JPEG or YAML out";
  }
};

// Everything is there, every frame decodes and has a pose.
void expect_whole(const std::filesystem::path& path, std::size_t frames, int width, int height, PixelFormat format) {
  Opened r(path);
  ASSERT_TRUE(succeeds(r.outcome));
  EXPECT_EQ(r.info.frames, frames);
  EXPECT_EQ(r.info.frames_with_pose, frames);
  EXPECT_TRUE(r.info.warnings.empty());
  EXPECT_EQ(r.source->rig().left.width_px, width);
  EXPECT_EQ(r.source->rig().right.height_px, height);
  EXPECT_EQ(validate(r.source->rig()), Status::kOk);
  ASSERT_TRUE(succeeds(r.source->start()));
  StereoFrame frame;
  std::size_t n = 0;
  for (; r.source->acquire(0, frame).ok(); ++n, r.source->release()) {
    EXPECT_EQ(frame.left.format, format);
    EXPECT_EQ(frame.right.width_px, width);
    Motion motion;
    ASSERT_TRUE(succeeds(r.motion->at(frame.t_left, motion)));
    EXPECT_EQ(validate(motion), Status::kOk);
  }
  EXPECT_EQ(n, frames);
  EXPECT_EQ(r.source->counters().dropped, 0U);
}

TEST_F(RealRecording, Chessboard) {
  ACCRETE_RECORDING_OR_SKIP(path, "chessboard");
  expect_whole(path, 13, 640, 480, PixelFormat::kGrey8);
  const Opened r(path);
  ASSERT_TRUE(succeeds(r.outcome));
  const StereoRig& rig = r.source->rig();
  EXPECT_NEAR(rig.baseline_m(), 0.08318, 1e-5);
  EXPECT_EQ(rig.left.distortion, Distortion::kBrownConrady);
  EXPECT_NEAR(rig.left.coefficients[4], 0.11908, 1e-5);
  EXPECT_EQ(r.info.mode, MotionMode::kObjectMoves);
  // The board's corners (9 x 6, 25 mm) project into both images in every frame.
  for (std::uint64_t i = 0; i < r.info.frames; ++i) {
    Motion m;
    ASSERT_TRUE(r.motion->at({static_cast<std::int64_t>(i) * 1'000'000'000}, m).ok());
    for (const Vec3 corner : {Vec3{0, 0, 0}, Vec3{0.2, 0, 0}, Vec3{0, 0.125, 0}, Vec3{0.2, 0.125, 0}}) {
      const Vec3 l = m.T_l_m * corner, right = rig.T_r_l * l;
      ASSERT_GT(l[2], 0.1);
      const auto pl = project(rig.left, {l[0] / l[2], l[1] / l[2]});
      const auto pr = project(rig.right, {right[0] / right[2], right[1] / right[2]});
      ASSERT_TRUE(pl.ok() && pr.ok());
      EXPECT_GT(pl.value().x, 0);
      EXPECT_LT(pl.value().x, 640);
      EXPECT_GT(pr.value().y, 0);
      EXPECT_LT(pr.value().y, 480);
    }
  }
}

TEST_F(RealRecording, Boxturn) {
  ACCRETE_RECORDING_OR_SKIP(path, "boxturn");
  expect_whole(path, 60, 640, 480, PixelFormat::kRgb8);
  const Opened r(path);
  ASSERT_TRUE(succeeds(r.outcome));
  EXPECT_NEAR(r.source->rig().baseline_m(), 0.12, 1e-12);
  EXPECT_EQ(r.source->rig().left.distortion, Distortion::kNone);
  EXPECT_TRUE(says(r.info.guesses, {"stereo.yml", "no unit"}));
  // 6 degrees a frame about a fixed point 0.6 m ahead.
  Motion a, b;
  ASSERT_TRUE(r.motion->at({0}, a).ok());
  ASSERT_TRUE(r.motion->at({33333000}, b).ok());
  EXPECT_NEAR(rotation_angle(conjugate(a.T_l_m.rotation) * b.T_l_m.rotation), 6 * 3.14159265358979 / 180, 1e-6);
  EXPECT_EQ(a.T_l_m.translation, b.T_l_m.translation);
  EXPECT_EQ(a.T_l_m.translation[2], 0.6);
  RecordingOptions options;
  options.poses = path / "object_poses_noisy.txt";
  const Opened noisy(path, options);
  ASSERT_TRUE(succeeds(noisy.outcome));
  EXPECT_EQ(noisy.info.mode, MotionMode::kObjectMoves);
}

TEST_F(RealRecording, TempleRing) {
  ACCRETE_RECORDING_OR_SKIP(path, "temple_ring");
  expect_whole(path, 42, 640, 640, PixelFormat::kRgb8);
  const Opened r(path);
  ASSERT_TRUE(succeeds(r.outcome));
  EXPECT_NEAR(r.source->rig().baseline_m(), 0.07516, 1e-5);
  EXPECT_EQ(r.source->rig().left.distortion, Distortion::kNone);
  EXPECT_EQ(r.source->rig().left.fx_px, 1523);
}

TEST_F(RealRecording, KittiGrey) {
  ACCRETE_RECORDING_OR_SKIP(path, "kitti_grey");
  expect_whole(path, 51, 1226, 370, PixelFormat::kGrey8);
  const Opened r(path);
  ASSERT_TRUE(succeeds(r.outcome));
  EXPECT_EQ(r.info.kind, RecordingKind::kKittiGrey);
  EXPECT_NEAR(r.source->rig().baseline_m(), 0.5372, 1e-4);
  EXPECT_EQ(r.info.mode, MotionMode::kCameraMoves);
  EXPECT_TRUE(says(r.info.guesses, {"times.txt", "10 Hz"}));
  // The car drives forward: what the camera was at first lies ever further behind it, 59.9 m in the end.
  double z = 1;
  for (std::int64_t i = 0; i < 51; ++i) {
    Motion m;
    ASSERT_TRUE(r.motion->at({i * 100'000'000}, m).ok());
    EXPECT_LT(m.T_l_m.translation[2], z) << i;
    z = m.T_l_m.translation[2];
  }
  EXPECT_NEAR(z, -59.9, 0.3);
}

}  // namespace
}  // namespace accrete::hal
