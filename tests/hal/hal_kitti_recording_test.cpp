// KITTI odometry folders; no YAML is needed.
#include <gtest/gtest.h>

#include "opened.h"
#include "outcome_matchers.h"
#include "tiny_recording.h"

namespace accrete::hal {
namespace {

using test::TempFolder;

const std::string kCalib =
    "P0: 10 0 1 0 0 10 1 0 0 0 1 0\nP1: 10 0 1 -5 0 10 1 0 0 0 1 0\n"
    "P2: 10 0 1 0.6 0 10 1 0 0 0 1 0\nP3: 10 0 1 -4.4 0 10 1 0 0 0 1 0\n";

// Drives forward by 1 m a frame.
std::string poses(int n) {
  std::string text;
  for (int i = 0; i < n; ++i) text += (i > 0 ? "\n" : "") + std::string("1 0 0 0 0 1 0 0 0 0 1 ") + std::to_string(i);
  return text;
}

void write_pair(const TempFolder& folder, const std::string& root, int left, int first, int n) {
  for (int i = first; i < first + n; ++i) {
    std::string name = std::to_string(i);
    name = "/" + std::string(6 - name.size(), '0') + name + ".pgm";
    folder.write(root + "image_" + std::to_string(left) + name, pgm(4, 3, static_cast<char>('a' + i)));
    folder.write(root + "image_" + std::to_string(left + 1) + name, pgm(4, 3));
  }
}

TEST(KittiRecording, GreyAtTenHertzAndForward) {
  const TempFolder folder;
  write_pair(folder, "", 0, 0, 3);
  folder.write("calib.txt", kCalib);
  folder.write("poses.txt", poses(3));
  Opened r(folder.path());
  ASSERT_TRUE(succeeds(r.outcome));
  EXPECT_EQ(r.info.kind, RecordingKind::kKittiGrey);
  EXPECT_TRUE(says(r.info.guesses, {"times.txt", "10 Hz"}));
  EXPECT_EQ(r.info.mode, MotionMode::kCameraMoves);
  EXPECT_NE(r.info.poses_convention.find("T_world_cam0"), std::string::npos);
  EXPECT_NEAR(r.source->rig().baseline_m(), 0.5, 1e-15);
  EXPECT_EQ(r.source->rig().left.width_px, 4);
  Motion m;
  ASSERT_TRUE(succeeds(r.motion->at({200'000'000}, m)));
  EXPECT_EQ(m.T_l_m.translation, (Vec3{0, 0, -2}));  // the start lies behind
}

TEST(KittiRecording, ColourPosesAreMovedFromCameraZeroToTwo) {
  const TempFolder folder;
  write_pair(folder, "", 2, 0, 2);
  folder.write("calib.txt", kCalib);
  folder.write("poses.txt", "0 0 1 0 0 1 0 0 -1 0 0 0\n0 0 1 0 0 1 0 0 -1 0 0 0\n");  // looks along the world's x
  folder.write("times.txt", "0.000000e+00\n1.036224e-01\n");
  Opened r(folder.path());
  ASSERT_TRUE(succeeds(r.outcome));
  EXPECT_EQ(r.info.kind, RecordingKind::kKittiColour);
  EXPECT_EQ(r.info.last.ns, 103622400);
  Motion m;
  ASSERT_TRUE(succeeds(r.motion->at({0}, m)));
  // T_c2_c0 moves by +0.06 m along x: camera 2 is at x = -0.06 of camera 0, which is the world's z = 0.06.
  EXPECT_LT(norm(m.T_l_m * Vec3{0, 0, 0.06}), 1e-15);
}

TEST(KittiRecording, BothPairsAreAGuess) {
  const TempFolder folder;
  write_pair(folder, "", 0, 0, 2);
  write_pair(folder, "", 2, 0, 2);
  folder.write("calib.txt", kCalib);
  folder.write("poses.txt", poses(2));
  Opened r(folder.path());
  ASSERT_TRUE(succeeds(r.outcome));
  EXPECT_EQ(r.info.kind, RecordingKind::kKittiColour);
  EXPECT_TRUE(says(r.info.guesses, {"several", "colour", "--kind"}));
  RecordingOptions options;
  options.kind = RecordingKind::kKittiGrey;
  EXPECT_EQ(Opened(folder.path(), options).info.kind, RecordingKind::kKittiGrey);
  options.kind = RecordingKind::kEuroc;
  EXPECT_TRUE(fails(Opened(folder.path(), options).outcome, Status::kNotFound, {"EuRoC", "is no recording"}));
}

TEST(KittiRecording, APieceOfASequenceFindsItsLinesByNumber) {
  const TempFolder folder;
  write_pair(folder, "sequences/07/", 0, 4, 3);
  folder.write("sequences/07/calib.txt", kCalib);
  std::string times;
  for (int i = 0; i < 20; ++i) times += std::to_string(i) + ".5\n";
  folder.write("sequences/07/times.txt", times);
  folder.write("poses/07.txt", poses(20));
  Opened r(folder / "sequences/07/");
  ASSERT_TRUE(succeeds(r.outcome));
  EXPECT_EQ(r.info.first.ns, 4'500'000'000);
  Motion m;
  ASSERT_TRUE(succeeds(r.motion->at({6'500'000'000}, m)));
  EXPECT_EQ(m.T_l_m.translation[2], -6);
}

TEST(KittiRecording, SaysWhatIsMissing) {
  const TempFolder folder;
  write_pair(folder, "", 0, 0, 2);
  EXPECT_TRUE(fails(Opened(folder.path()).outcome, Status::kNotFound, {"no calib.txt", "--calibration"}));
  folder.write("calib.txt", kCalib);
  EXPECT_TRUE(fails(Opened(folder.path()).outcome, Status::kNotFound, {"poses.txt", "not there", "--poses"}));
  folder.write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1");
  EXPECT_TRUE(fails(Opened(folder.path()).outcome, Status::kDataLoss, {"poses.txt, line 2", "truncated"}));
}

}  // namespace
}  // namespace accrete::hal
