// The poses of plain folders: which file, which convention, and what when they do not fit.
#include <gtest/gtest.h>

#include "opened.h"
#include "outcome_matchers.h"
#include "tiny_recording.h"

namespace accrete::hal {
namespace {

using test::TempFolder;

class PlainPoses : public testing::Test {
 protected:
  void SetUp() override {
    if (!ACCRETE_HAS_YAML) GTEST_SKIP() << "this build leaves YAML out";
    write_plain(folder_);
  }
  TempFolder folder_;
};

TEST_F(PlainPoses, MissingPosesAreRefusedUnlessNobodyNeedsThem) {
  std::filesystem::remove(folder_ / "object_poses.txt");
  Opened r(folder_.path());
  EXPECT_TRUE(fails(r.outcome, Status::kNotFound, {"no poses", "object_poses.txt", "poses_camera.txt", "--poses"}));
  EXPECT_EQ(r.source, nullptr);
  RecordingOptions options;
  options.require_poses = false;
  Opened info(folder_.path(), options);
  ASSERT_TRUE(succeeds(info.outcome));
  EXPECT_NE(info.source, nullptr);
  EXPECT_EQ(info.motion, nullptr);
  EXPECT_EQ(info.info.mode, std::nullopt);
  EXPECT_TRUE(info.info.poses_source.empty());
  EXPECT_TRUE(says(info.info.warnings, {"no poses"}));
}

TEST_F(PlainPoses, PartialCoverageIsCountedAndSaid) {
  folder_.write("object_poses.txt", "0 0 0 1 0 0 0 1\n0.033333 0 0 1 0 0 0 1\n");
  Opened r(folder_.path());
  ASSERT_TRUE(succeeds(r.outcome));
  EXPECT_EQ(r.info.frames_with_pose, 2U);
  EXPECT_TRUE(says(r.info.warnings, {"object_poses.txt", "1 frame of 3 without a pose", "covers 0 s to 0.033333 s"}));
  Motion m;
  EXPECT_TRUE(fails(r.motion->at({66666667}, m), Status::kNotFound, {"0.066666667 s", "object_poses.txt"}));
}

TEST_F(PlainPoses, NoCoverageIsRefused) {
  folder_.write("object_poses.txt", "1403636579.7 0 0 1 0 0 0 1\n");
  EXPECT_TRUE(fails(Opened(folder_.path()).outcome, Status::kNotFound,
                    {"object_poses.txt", "3 frames of 3 without a pose", "clock", "times.txt"}));
}

TEST_F(PlainPoses, BrokenPosesAreRefusedWithTheLine) {
  folder_.write("object_poses.txt", "0 0 0 1 0 0 0 1\n0.03 nan 0 1 0 0 0 1\n");
  EXPECT_TRUE(fails(Opened(folder_.path()).outcome, Status::kInvalidArgument, {"object_poses.txt, line 2", "'nan'"}));
}

TEST_F(PlainPoses, TwoFilesAreAGuessThatModeDecides) {
  folder_.write("poses_camera.txt", "0 5 0 0 0 0 0 1\n0.033333 5 0 0 0 0 0 1\n0.066667 5 0 0 0 0 0 1\n");
  Opened object(folder_.path());
  ASSERT_TRUE(succeeds(object.outcome));
  EXPECT_EQ(object.info.mode, MotionMode::kObjectMoves);
  EXPECT_TRUE(says(object.info.guesses, {"poses_camera.txt", "--motion camera"}));
  RecordingOptions options;
  options.mode = MotionMode::kCameraMoves;
  Opened camera(folder_.path(), options);
  ASSERT_TRUE(succeeds(camera.outcome));
  EXPECT_EQ(camera.info.mode, MotionMode::kCameraMoves);
  EXPECT_NE(camera.info.poses_convention.find("T_world_left"), std::string::npos);
  Motion m;
  ASSERT_TRUE(succeeds(camera.motion->at({0}, m)));
  EXPECT_EQ(m.error, PoseError::kIncremental);
  EXPECT_NEAR(m.T_l_m.translation[0], -5, 1e-15);  // the world's origin, seen from the camera
  std::filesystem::remove(folder_ / "poses_camera.txt");
  EXPECT_TRUE(fails(Opened(folder_.path(), options).outcome, Status::kNotFound, {"poses_camera.txt", "T_world_left"}));
}

// An object turned by 90 degrees about z, at (1, 2, 3).
const std::string kTurned = "1 2 3 0 0 0.70710678118654752 0.70710678118654752\n";
const std::string kThree = "0 " + kTurned + "0.033333 " + kTurned + "0.066667 " + kTurned;

Vec3 origin_of(MotionSource& source) {
  Motion m;
  EXPECT_TRUE(source.at({0}, m).ok());
  return m.T_l_m.translation;
}

TEST_F(PlainPoses, Conventions) {
  RecordingOptions options;
  options.poses = folder_.write("object_poses_other.txt", kThree);
  Opened left(folder_.path(), options);
  ASSERT_TRUE(succeeds(left.outcome));
  EXPECT_TRUE(says(left.info.guesses, {"object_poses_other.txt", "motion of the object", "--motion"}));
  EXPECT_LT(norm(origin_of(*left.motion) - Vec3{1, 2, 3}), 1e-12);

  options.pose_convention.inverse = true;  // T_object_left: the camera is at (1, 2, 3), x along the object's y
  Opened inverse(folder_.path(), options);
  ASSERT_TRUE(succeeds(inverse.outcome));
  EXPECT_LT(norm(origin_of(*inverse.motion) - Vec3{-2, 1, -3}), 1e-12);
  EXPECT_NE(inverse.info.poses_convention.find("T_object_left"), std::string::npos);

  options.pose_convention = {false, PoseConvention::Frame::kRight};  // T_right_object; the right camera is at x = 0.1
  Opened right(folder_.path(), options);
  ASSERT_TRUE(succeeds(right.outcome));
  EXPECT_LT(norm(origin_of(*right.motion) - Vec3{1.1, 2, 3}), 1e-12);
  EXPECT_NE(right.info.poses_convention.find("T_right_object"), std::string::npos);

  options.mode = MotionMode::kCameraMoves;  // T_world_right: the right camera at (1, 2, 3), its x along the world's y
  Opened camera(folder_.path(), options);
  ASSERT_TRUE(succeeds(camera.outcome));
  // So the left one is at (1, 1.9, 3), and the world's origin, seen from there, at (-1.9, 1, -3).
  EXPECT_LT(norm(origin_of(*camera.motion) - Vec3{-1.9, 1, -3}), 1e-12);
}

TEST_F(PlainPoses, SigmasMakeACovariance) {
  RecordingOptions options;
  Motion m;
  Opened none(folder_.path());
  ASSERT_TRUE(succeeds(none.outcome));
  ASSERT_TRUE(none.motion->at({0}, m).ok());
  EXPECT_TRUE(m.covariance_is_default);
  options.pose_sigma_m = 3e-4;
  options.pose_sigma_rad = 1e-3;
  options.pose_error = PoseError::kIncremental;
  Opened given(folder_.path(), options);
  ASSERT_TRUE(succeeds(given.outcome));
  ASSERT_TRUE(given.motion->at({0}, m).ok());
  EXPECT_FALSE(m.covariance_is_default);
  EXPECT_EQ(m.covariance, diagonal_pose_covariance(3e-4, 1e-3));
  EXPECT_EQ(m.error, PoseError::kIncremental);
}

TEST_F(PlainPoses, AMatrixListGoesByFrames) {
  RecordingOptions options;
  options.mode = MotionMode::kObjectMoves;
  options.poses = folder_.write("k.txt", "1 0 0 0 0 1 0 0 0 0 1 1\n1 0 0 0 0 1 0 0 0 0 1 2\n1 0 0 0 0 1 0 0 0 0 1 3");
  Opened r(folder_.path(), options);
  ASSERT_TRUE(succeeds(r.outcome));
  Motion m;
  ASSERT_TRUE(r.motion->at({66666667}, m).ok());
  EXPECT_EQ(m.T_l_m.translation[2], 3);
  options.poses = folder_.write("k.txt", "1 0 0 0 0 1 0 0 0 0 1 1\n");
  Opened shorter(folder_.path(), options);
  ASSERT_TRUE(succeeds(shorter.outcome));
  EXPECT_EQ(shorter.info.frames_with_pose, 1U);
  EXPECT_TRUE(says(shorter.info.warnings, {"k.txt", "1 line for 3 frames"}));
  folder_.write("left/x.pgm", pgm(4, 3));
  folder_.write("right/x.pgm", pgm(4, 3));
  options.poses = folder_.write("k.txt",
                                "1 0 0 0 0 1 0 0 0 0 1 1\n1 0 0 0 0 1 0 0 0 0 1 2\n1 0 0 0 0 1 0 0 0 0 1 1\n"
                                "1 0 0 0 0 1 0 0 0 0 1 2\n1 0 0 0 0 1 0 0 0 0 1 1\n");
  EXPECT_TRUE(fails(Opened(folder_.path(), options).outcome, Status::kInvalidArgument,
                    {"k.txt", "5 lines", "4 frames", "TUM"}));
}

TEST_F(PlainPoses, PosesOfABodyNeedToKnowIt) {
  RecordingOptions options;
  options.poses = folder_.write("gt.csv", "0,1,2,3,1,0,0,0\n33333333,1,2,3,1,0,0,0\n66666667,1,2,3,1,0,0,0\n");
  EXPECT_TRUE(fails(Opened(folder_.path(), options).outcome, Status::kInvalidArgument,
                    {"gt.csv", "body", "T_BS", "--pose-frame"}));
  options.pose_convention.frame = PoseConvention::Frame::kLeft;
  EXPECT_TRUE(succeeds(Opened(folder_.path(), options).outcome));
}

}  // namespace
}  // namespace accrete::hal
