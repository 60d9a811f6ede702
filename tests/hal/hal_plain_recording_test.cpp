// Plain folders: left/ right/ stereo.yml object_poses.txt.
#include <gtest/gtest.h>

#include "opened.h"
#include "outcome_matchers.h"
#include "tiny_recording.h"

namespace accrete::hal {
namespace {

using test::TempFolder;

class Plain : public testing::Test {
 protected:
  void SetUp() override {
    if (!ACCRETE_HAS_YAML) GTEST_SKIP() << "this build leaves YAML out";
    write_plain(folder_);
  }
  TempFolder folder_;
};

TEST_F(Plain, OpensAndPlays) {
  Opened r(folder_.path());
  ASSERT_TRUE(succeeds(r.outcome));
  EXPECT_EQ(r.info.kind, RecordingKind::kPlainFolder);
  EXPECT_EQ(r.info.frames, 3U);
  EXPECT_EQ(r.info.width_px, 4);
  EXPECT_EQ(r.info.image_format, "PGM/PPM");
  EXPECT_EQ(r.info.poses, 3U);
  EXPECT_EQ(r.info.frames_with_pose, 3U);
  EXPECT_EQ(r.info.mode, MotionMode::kObjectMoves);
  EXPECT_NE(r.info.poses_convention.find("T_left_object"), std::string::npos);
  EXPECT_NE(r.info.calibration_convention.find("x_right = R x_left + T"), std::string::npos);
  EXPECT_TRUE(says(r.info.guesses, {"times.txt", "30 Hz", "--fps"}));
  EXPECT_TRUE(r.info.warnings.empty());
  EXPECT_EQ(r.source->state(), StereoSource::SourceState::kConfigured);
  EXPECT_EQ(r.source->size(), 3U);
  EXPECT_NEAR(r.source->rig().baseline_m(), 0.1, 1e-15);
  const Played played(*r.source);
  EXPECT_EQ(played.end, Status::kEndOfStream);
  EXPECT_EQ(played.sequences, (std::vector<std::uint64_t>{0, 1, 2}));
  EXPECT_EQ(played.times_ns, (std::vector<std::int64_t>{0, 33333333, 66666667}));
  EXPECT_EQ(played.first_pixels, (std::vector<int>{'a', 'b', 'c'}));
  Motion m;
  ASSERT_TRUE(succeeds(r.motion->at({66666667}, m)));
  EXPECT_NEAR(m.T_l_m.translation[0], 0.002, 1e-7);  // the stamps have six decimals
  // A second time from the beginning.
  r.source->stop();
  EXPECT_EQ(Played(*r.source).sequences.size(), 3U);
}

TEST_F(Plain, ReadsTimes) {
  folder_.write("times.txt", "\xef\xbb\xbf# seconds\r\n0.0 \r\n0.0333333\r\n0.0666666");
  Opened r(folder_.path());
  ASSERT_TRUE(succeeds(r.outcome));
  EXPECT_EQ(r.info.last.ns, 66666600);
  EXPECT_NE(r.info.times_source.find("times.txt"), std::string::npos);
  EXPECT_TRUE(r.info.guesses.empty());
  RecordingOptions options;
  options.rate_hz = 100;
  options.require_poses = false;
  Opened faster(folder_.path(), options);
  ASSERT_TRUE(succeeds(faster.outcome));
  EXPECT_EQ(faster.info.last.ns, 20'000'000);
}

TEST_F(Plain, RefusesTimesThatFitNoFrames) {
  folder_.write("times.txt", "0\n1\n");
  EXPECT_TRUE(
      fails(Opened(folder_.path()).outcome, Status::kInvalidArgument, {"times.txt", "2 lines", "3 frames", "--fps"}));
  folder_.write("times.txt", "0\n1\n1\n");
  EXPECT_TRUE(fails(Opened(folder_.path()).outcome, Status::kInvalidArgument, {"times.txt, line 3", "1.pgm", "order"}));
  folder_.write("times.txt", "0\nnan\n1\n");
  EXPECT_TRUE(fails(Opened(folder_.path()).outcome, Status::kInvalidArgument, {"times.txt, line 2", "'nan'"}));
}

TEST_F(Plain, UnequalListsAreCountedAndTimesStayWithTheirNames) {
  std::filesystem::remove(folder_ / "right/1.pgm");
  folder_.write("right/9.pgm", pgm(4, 3));
  folder_.write("right/10.pgm", pgm(4, 3));
  folder_.write("left/10.pgm", pgm(4, 3, 'z'));  // after 9, as people count
  folder_.write("left/.hidden.pgm", "no image");
  folder_.write("left/notes.txt", "no image");
  folder_.write("times.txt", "0\n1\n2\n9\n10\n");  // of all five names
  RecordingOptions options;
  options.require_poses = false;
  Opened r(folder_.path(), options);
  ASSERT_TRUE(succeeds(r.outcome));
  EXPECT_EQ(r.info.frames, 3U);
  EXPECT_EQ(r.info.left_only, 1U);
  EXPECT_EQ(r.info.right_only, 1U);
  EXPECT_EQ(r.source->counters().unpaired, 2U);
  EXPECT_TRUE(says(r.info.warnings, {"1 left image", "1 right image", "no partner"}));
  const Played played(*r.source);
  EXPECT_EQ(played.times_ns, (std::vector<std::int64_t>{0, 2'000'000'000, 10'000'000'000}));
  EXPECT_EQ(played.first_pixels, (std::vector<int>{'a', 'c', 'z'}));
}

TEST_F(Plain, DamagedFramesAreLeftOutAndTheRestIsPlayed) {
  folder_.write("left/1.pgm", "P5 4 3 255\nabc");
  Opened r(folder_.path());
  ASSERT_TRUE(succeeds(r.outcome));
  const Played played(*r.source);
  EXPECT_EQ(played.sequences, (std::vector<std::uint64_t>{0, 2}));
  EXPECT_EQ(played.end, Status::kEndOfStream);
  ASSERT_EQ(played.losses.size(), 1U);
  EXPECT_TRUE(says(played.losses, {"frame 1 is left out", "left/1.pgm", "3 of 12 bytes", "copy it again"}));
  EXPECT_EQ(r.source->counters().dropped, 1U);
  EXPECT_EQ(r.source->counters().delivered, 2U);
}

TEST_F(Plain, AFrameOfAnotherSizeAMissingOneAndNoImageAreLeftOut) {
  folder_.write("left/0.pgm", "no image at all");
  folder_.write("right/1.pgm", pgm(8, 3));
  Opened r(folder_.path());
  ASSERT_TRUE(succeeds(r.outcome));
  std::filesystem::remove(folder_ / "right/2.pgm");  // behind the source's back
  const Played played(*r.source);
  EXPECT_TRUE(played.sequences.empty());
  ASSERT_EQ(played.losses.size(), 3U);
  EXPECT_TRUE(says(played.losses, {"frame 0", "left/0.pgm", "is no PNG", "convert"}));
  EXPECT_TRUE(says(played.losses, {"frame 1", "right/1.pgm", "8x3", "4x3"}));
  EXPECT_TRUE(says(played.losses, {"frame 2", "right/2.pgm", "not there"}));
}

TEST_F(Plain, ImageSizeUnlikeTheCalibration) {
  for (const char* name : {"0", "1", "2"}) folder_.write("left/" + std::string(name) + ".pgm", pgm(8, 6));
  EXPECT_TRUE(fails(Opened(folder_.path()).outcome, Status::kInvalidArgument,
                    {"left/0.pgm", "8x6", "4x3", "use the calibration of these images"}));
}

TEST_F(Plain, NoReadableImageAtAll) {
  for (const char* name : {"0", "1", "2"}) folder_.write("left/" + std::string(name) + ".pgm", "P5 4");
  EXPECT_TRUE(fails(Opened(folder_.path()).outcome, Status::kDataLoss, {"left/0.pgm", "damaged"}));
}

TEST_F(Plain, SizeFromTheImages) {
  StereoYml yml;
  yml.head = "units: m\n";
  folder_.write("stereo.yml", yml.text());
  Opened r(folder_.path());
  ASSERT_TRUE(succeeds(r.outcome));
  EXPECT_EQ(r.source->rig().right.width_px, 4);
  EXPECT_TRUE(says(r.info.guesses, {"stereo.yml", "no image size"}));
}

TEST_F(Plain, BadCalibrationsAreRefusedWithTheirSentence) {
  StereoYml yml;
  yml.M1 = "nan, 0, 1, 0, 1, 1, 0, 0, 1";
  folder_.write("stereo.yml", yml.text());
  EXPECT_TRUE(fails(Opened(folder_.path()).outcome, Status::kInvalidArgument, {"stereo.yml", "M1", "finite"}));
  std::filesystem::remove(folder_ / "stereo.yml");
  Opened none(folder_.path());
  EXPECT_TRUE(fails(none.outcome, Status::kNotFound, {"no calibration", "stereo.yml", "--calibration"}));
  EXPECT_EQ(none.source, nullptr);
  EXPECT_EQ(none.info.frames, 3U);  // what was found so far
  folder_.write("rig.yaml", StereoYml{}.text());
  Opened other(folder_.path());
  ASSERT_TRUE(succeeds(other.outcome));
  EXPECT_TRUE(says(other.info.guesses, {"rig.yaml", "--calibration"}));
  RecordingOptions options;
  options.calibration =
      folder_.write("elsewhere/k.txt", "P0: 10 0 1 0 0 10 1 0 0 0 1 0\nP1: 10 0 1 -1 0 10 1 0 0 0 1 0\n");
  Opened kitti(folder_.path(), options);
  ASSERT_TRUE(succeeds(kitti.outcome));
  EXPECT_NE(kitti.info.calibration_source.find("k.txt"), std::string::npos);
}

TEST_F(Plain, FoldersThatAreNoRecording) {
  const TempFolder empty;
  EXPECT_TRUE(fails(Opened(empty.path()).outcome, Status::kNotFound, {"is no recording", "left/", "mav0", "image_0/"}));
  EXPECT_TRUE(fails(Opened(empty / "none").outcome, Status::kNotFound, {"none", "not there"}));
  EXPECT_TRUE(fails(Opened(folder_ / "stereo.yml").outcome, Status::kNotFound, {"stereo.yml", "is a file", "folder"}));
  std::filesystem::create_directories(empty / "left");
  EXPECT_TRUE(fails(Opened(empty.path()).outcome, Status::kNotFound, {"left", "right/", "missing"}));
  std::filesystem::create_directories(empty / "right");
  EXPECT_TRUE(fails(Opened(empty.path()).outcome, Status::kNotFound, {"left", "no image", "complete"}));
  empty.write("left/a.pgm", pgm(4, 3));
  empty.write("right/b.pgm", pgm(4, 3));
  EXPECT_TRUE(fails(Opened(empty.path()).outcome, Status::kNotFound, {"no name in common", "a.pgm", "b.pgm"}));
  empty.write("left/a.ppm", "x");
  EXPECT_TRUE(fails(Opened(empty.path()).outcome, Status::kInvalidArgument, {"left/a.pgm", "a.ppm", "one name"}));
}

TEST_F(Plain, OptionsOutOfRange) {
  RecordingOptions options;
  options.rate_hz = 0;
  EXPECT_TRUE(fails(Opened(folder_.path(), options).outcome, Status::kInvalidArgument, {"--fps", "0"}));
  options.rate_hz.reset();
  options.pose_sigma_m = -1;
  EXPECT_TRUE(fails(Opened(folder_.path(), options).outcome, Status::kInvalidArgument, {"--pose-sigma", "-1"}));
  options.pose_sigma_m = 1e-3;  // and an exact rotation: a singular covariance
  EXPECT_TRUE(fails(Opened(folder_.path(), options).outcome, Status::kInvalidArgument, {"--pose-sigma", "both"}));
  options.pose_sigma_m.reset();
  options.max_pose_gap_ns = -1;
  EXPECT_TRUE(fails(Opened(folder_.path(), options).outcome, Status::kInvalidArgument, {"--max-pose-gap"}));
}

}  // namespace
}  // namespace accrete::hal
