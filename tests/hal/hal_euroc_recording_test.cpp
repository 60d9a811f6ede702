// EuRoC/ASL folders.
#include <gtest/gtest.h>

#include "opened.h"
#include "outcome_matchers.h"
#include "tiny_recording.h"

namespace accrete::hal {
namespace {

using test::TempFolder;

constexpr std::int64_t kStart = 1403636579763555584;
constexpr std::int64_t kPeriod = 50'000'000;

std::string sensor(double y_on_body) {
  return "sensor_type: camera\nT_BS:\n  cols: 4\n  rows: 4\n  data: [0, 0, 1, 0,\n    -1, 0, 0, " +
         std::to_string(y_on_body) +
         ",\n    0, -1, 0, 0,\n    0, 0, 0, 1]\nrate_hz: 20\nresolution: [4, 3]\ncamera_model: pinhole\n"
         "intrinsics: [10, 10, 1.5, 1]\ndistortion_model: radial-tangential\ndistortion_coefficients: [0.1, 0, 0, 0]\n";
}

class EurocRecording : public testing::Test {
 protected:
  void SetUp() override {
    if (!ACCRETE_HAS_YAML) GTEST_SKIP() << "this build leaves YAML out";
    // Body: x forward, y left, z up. cam0 5 cm to the left, cam1 5 cm to the right.
    folder_.write("mav0/cam0/sensor.yaml", sensor(0.05));
    folder_.write("mav0/cam1/sensor.yaml", sensor(-0.05));
    list("cam0", {0, 1, 2, 3});
    list("cam1", {0, 1, 2, 3});
    // 200 Hz, along the body's x at 1 m/s; not at the very stamps of the images, nor at their beginning.
    std::string rows =
        "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []\r\n";
    for (std::int64_t t = kPeriod - 2'500'000; t < 4 * kPeriod; t += 5'000'000)
      rows += std::to_string(kStart + t) + "," + std::to_string(static_cast<double>(t) * 1e-9) + ",0,0,1,0,0,0\r\n";
    truth_ = folder_.write("mav0/state_groundtruth_estimate0/data.csv", rows);
  }
  void list(const std::string& camera, const std::vector<int>& frames, std::int64_t skew = 0) const {
    std::string rows = "#timestamp [ns],filename\r\n";
    for (const int i : frames) {
      const std::string t = std::to_string(kStart + kPeriod * i + skew);
      rows += t + "," + t + ".pgm\r\n";
      folder_.write("mav0/" + camera + "/data/" + t + ".pgm", pgm(4, 3, static_cast<char>('a' + i)));
    }
    folder_.write("mav0/" + camera + "/data.csv", rows);
  }

  TempFolder folder_;
  std::filesystem::path truth_;
};

TEST_F(EurocRecording, OpensFromTheFolderAndItsParentWithPosesThatDoNotCoverTheStart) {
  for (const auto& path : {folder_.path(), folder_ / "mav0"}) {
    Opened r(path);
    ASSERT_TRUE(succeeds(r.outcome)) << path;
    EXPECT_EQ(r.info.kind, RecordingKind::kEuroc);
    EXPECT_EQ(r.info.frames, 4U);
    EXPECT_EQ(r.info.first.ns, kStart);
    EXPECT_NEAR(r.source->rig().baseline_m(), 0.1, 1e-12);
    EXPECT_EQ(r.info.frames_with_pose, 3U);
    EXPECT_TRUE(says(r.info.warnings, {"1 frame of 4 without a pose", "covers"}));
    EXPECT_NE(r.info.poses_convention.find("T_world_body"), std::string::npos);
    Motion m;
    EXPECT_EQ(r.motion->at({kStart}, m).status, Status::kNotFound);
    ASSERT_TRUE(succeeds(r.motion->at({kStart + 2 * kPeriod}, m)));
    EXPECT_EQ(m.mode, MotionMode::kCameraMoves);
    EXPECT_EQ(m.error, PoseError::kAbsolute);
    // T_R_B * T_BS: the camera is at (0.1, 0.05, 0) in the world and looks along its x.
    const Vec3 ahead = m.T_l_m * Vec3{1.1, 0.05, 0};
    EXPECT_LT(norm(ahead - Vec3{0, 0, 1}), 1e-6);
  }
}

TEST_F(EurocRecording, PairsByTimeNotByIndex) {
  list("cam0", {0, 1, 3});
  list("cam1", {1, 2, 3}, 300'000);
  Opened r(folder_.path());
  ASSERT_TRUE(succeeds(r.outcome));
  EXPECT_EQ(r.info.frames, 2U);
  EXPECT_EQ(r.info.left_only, 1U);
  EXPECT_EQ(r.info.right_only, 1U);
  const Played played(*r.source);
  EXPECT_EQ(played.times_ns, (std::vector<std::int64_t>{kStart + kPeriod, kStart + 3 * kPeriod}));
  EXPECT_EQ(played.first_pixels, (std::vector<int>{'b', 'd'}));
  list("cam1", {0, 1, 2, 3}, 10'000'000);  // 10 ms apart is no pair
  EXPECT_TRUE(fails(Opened(folder_.path()).outcome, Status::kNotFound, {"cam0", "cam1", "8 ms"}));
}

TEST_F(EurocRecording, MissingGroundTruthIsSaid) {
  std::filesystem::remove(truth_);
  EXPECT_TRUE(fails(Opened(folder_.path()).outcome, Status::kNotFound,
                    {"state_groundtruth_estimate0/data.csv", "mocap0", "--poses"}));
  RecordingOptions options;
  options.require_poses = false;
  EXPECT_TRUE(succeeds(Opened(folder_.path(), options).outcome));
  folder_.write("mav0/mocap0/data.csv", std::to_string(kStart) + ",0,0,0,1,0,0,0\n");
  Opened mocap(folder_.path());
  ASSERT_TRUE(succeeds(mocap.outcome));
  EXPECT_EQ(mocap.info.frames_with_pose, 1U);
}

TEST_F(EurocRecording, AnImageThatIsListedButNotThereIsLeftOut) {
  std::filesystem::remove(folder_ / ("mav0/cam1/data/" + std::to_string(kStart + kPeriod) + ".pgm"));
  Opened r(folder_.path());
  ASSERT_TRUE(succeeds(r.outcome));
  const Played played(*r.source);
  EXPECT_EQ(played.sequences, (std::vector<std::uint64_t>{0, 2, 3}));
  EXPECT_TRUE(says(played.losses, {"frame 1", "cam1/data/", "not there"}));
}

TEST_F(EurocRecording, RefusesListsWithTheLine) {
  const auto with_list = [&](const std::string& text) {
    folder_.write("mav0/cam0/data.csv", text);
    return Opened(folder_.path()).outcome;
  };
  EXPECT_TRUE(fails(with_list("1,a.pgm\n2,../../secret.pgm\n"), Status::kDataLoss,
                    {"cam0/data.csv, line 2", "leaves the folder"}));
  EXPECT_TRUE(
      fails(with_list("1,a.pgm\n1.5,b.pgm\n"), Status::kDataLoss, {"cam0/data.csv, line 2", "'1.5'", "nanoseconds"}));
  EXPECT_TRUE(fails(with_list("1,a.pgm\n1,b.pgm\n"), Status::kInvalidArgument, {"line 2", "same time as line 1"}));
  EXPECT_TRUE(fails(with_list("9223372036854775807,a.pgm\n"), Status::kDataLoss, {"line 1"}));
  EXPECT_TRUE(fails(with_list("#timestamp [ns],filename\n"), Status::kNotFound, {"cam0/data.csv", "no image"}));
  std::filesystem::remove(folder_ / "mav0/cam1/data.csv");
  list("cam0", {0});
  EXPECT_TRUE(fails(Opened(folder_.path()).outcome, Status::kNotFound, {"cam1/data.csv", "not there"}));
}

TEST_F(EurocRecording, MissingSensorFile) {
  std::filesystem::remove(folder_ / "mav0/cam1/sensor.yaml");
  EXPECT_TRUE(fails(Opened(folder_.path()).outcome, Status::kNotFound, {"cam1/sensor.yaml", "--calibration"}));
}

}  // namespace
}  // namespace accrete::hal
