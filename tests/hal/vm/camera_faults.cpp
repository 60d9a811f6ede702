// Faults of two USB cameras: each ends in the state that docs/reference/cameras.md names, every pair is a true one, and
// nothing is left behind. The cameras are software, the driver above them is not.
#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "live.h"
#include "orders.h"
#include "resources.h"

namespace accrete::vm {
namespace {

class CameraFaults : public LeavesNothing, public testing::WithParamInterface<Library> {
 protected:
  void SetUp() override {
    order("run");
    hal::LiveOptions options;
    options.left = "Software camera 0";
    options.right = "Software camera 1";
    options.format = "GREY";
    options.warm_up_frames = 3;
    options.pair_tolerance_ns = 20 * kMillisecond;  // of 200 ms, of which the cameras use the first 25
    options.reconnect_timeout_ns = reconnect_ms_ * kMillisecond;
    source_ = opened(options, GetParam());
    ASSERT_NE(source_, nullptr);
    ASSERT_TRUE(source_->start().ok());
    ASSERT_TRUE(pairs(2));
  }
  void TearDown() override {
    source_.reset();
    for (const char* fault : {"drop", "cut", "flag", "still", "late"})
      for (const char* camera : {" 0 0", " 1 0"}) order(std::string(fault) + camera);
    LeavesNothing::TearDown();
  }

  // `count` pairs, each of one moment; false where they do not come.
  bool pairs(int count) {
    StereoFrame frame;
    for (int misses = 0; count > 0 && misses < 40;) {
      const hal::Outcome outcome = acquire(*source_, 500 * kMillisecond, frame);
      if (!outcome.ok() && outcome.status != Status::kTimeout) {
        ADD_FAILURE() << outcome.message;
        return false;
      }
      if (!outcome.ok()) {
        ++misses;
        continue;
      }
      --count;
      const auto left = read_number(frame.left), right = read_number(frame.right);
      EXPECT_TRUE(left && right && left->number == right->number && !left->right && right->right)
          << (left ? left->number : -1) << " " << (right ? right->number : -1) << ", "
          << (frame.t_right.ns - frame.t_left.ns) << " ns apart";
      EXPECT_TRUE(last_sequence_ < 0 || static_cast<std::int64_t>(frame.sequence) > last_sequence_);
      last_sequence_ = static_cast<std::int64_t>(frame.sequence);
      source_->release();
    }
    EXPECT_EQ(count, 0) << "pairs do not come";
    return count == 0;
  }

  [[nodiscard]] hal::LiveStatistics now() const { return source_->statistics(); }

  std::int64_t reconnect_ms_ = 60'000;
  std::unique_ptr<hal::LiveSource> source_;
  std::int64_t last_sequence_ = -1;
};

std::int32_t gain(int camera, std::optional<std::int32_t> value = {}) {
  const std::string c = std::to_string(camera);
  const std::string node = "/dev/v4l/by-id/usb-accrete_Software_camera_" + c + "_SN000" + c + "-video-index0";
  const int fd = open(node.c_str(), O_RDWR | O_CLOEXEC);
  v4l2_control control{V4L2_CID_GAIN, value.value_or(0)};
  EXPECT_EQ(ioctl(fd, value ? VIDIOC_S_CTRL : VIDIOC_G_CTRL, &control), 0);
  close(fd);
  return control.value;
}

TEST_P(CameraFaults, NoneAndTheExposureOfTheLeftCameraHoldsForBoth) {
  if (GetParam() != Library::kV4l2) GTEST_SKIP() << "libcamera knows few controls of USB cameras";
  source_->stop();
  gain(0, 33);
  gain(1, 77);
  ASSERT_TRUE(source_->start().ok());
  last_sequence_ = -1;
  ASSERT_TRUE(pairs(2));
  EXPECT_EQ(now().state, hal::LiveState::kStreaming);
  EXPECT_EQ(now().left.locked,
            (std::vector<std::string>{"exposure_time_absolute 157", "gain 33", "white_balance_temperature 4600"}));
  EXPECT_EQ(now().right.locked, now().left.locked);
  EXPECT_EQ(gain(1), 33);
  EXPECT_TRUE(now().right.notices.empty());
  EXPECT_EQ(now().left.id, "/dev/v4l/by-id/usb-accrete_Software_camera_0_SN0000-video-index0");
  EXPECT_EQ(now().left.clock, hal::LiveClock::kStartOfExposure);
}

// uvcvideo numbers what arrives: a frame that was never sent is missing in no number, its partner is left alone.
TEST_P(CameraFaults, DroppedFramesLeaveTheirPartnersAlone) {
  const auto before = now();
  order("drop 1 3");
  ASSERT_TRUE(pairs(6));
  EXPECT_GE(now().left.unpaired, before.left.unpaired + 3);
}

// uvcvideo keeps what is cut off or flagged for itself.
TEST_P(CameraFaults, CutFramesAreLost) {
  const auto before = now();
  order("cut 0 2");
  ASSERT_TRUE(pairs(6));
  EXPECT_GE(now().right.unpaired, before.right.unpaired + 2);
  EXPECT_GE(now().left.dropped + now().left.damaged, before.left.dropped + before.left.damaged + 2);
}

TEST_P(CameraFaults, FlaggedFramesAreLost) {
  const auto before = now();
  order("flag 0 2");
  ASSERT_TRUE(pairs(6));
  EXPECT_GE(now().right.unpaired, before.right.unpaired + 2);
  EXPECT_GE(now().left.dropped + now().left.damaged, before.left.dropped + before.left.damaged + 2);
}

TEST_P(CameraFaults, AStillCameraIsATimeoutThatNamesIt) {
  order("still 1 2500");
  const hal::Outcome outcome = take_until(*source_, Status::kTimeout);
  EXPECT_NE(outcome.message.find("Software camera 1"), std::string::npos) << outcome.message;
  EXPECT_TRUE(pairs(3));
}

TEST_P(CameraFaults, CamerasThatRunApartArePairedNoMore) {
  order("late 1 100");
  take_until(*source_, Status::kTimeout);
  const hal::Outcome outcome = take_until(*source_, Status::kTimeout);
  EXPECT_NE(outcome.message.find("no pair"), std::string::npos) << outcome.message;
  order("late 1 0");
  EXPECT_TRUE(pairs(3));
}

TEST_P(CameraFaults, ACameraThatIsPulledOutAndComesBackIsTakenUpAgain) {
  order("unplug 1");
  for (int i = 0; i < 50 && now().state != hal::LiveState::kReconnecting; ++i) take_until(*source_, Status::kTimeout);
  EXPECT_EQ(now().state, hal::LiveState::kReconnecting);
  EXPECT_NE(now().loss.find("Software camera 1"), std::string::npos) << now().loss;
  EXPECT_EQ(resources().video_devices, 0);
  EXPECT_EQ(resources().video_maps, 0);
  const std::int64_t last = last_sequence_;
  order("plug 1");
  ASSERT_TRUE(pairs(1));
  EXPECT_EQ(now().reconnects, 1U);
  EXPECT_TRUE(now().after_gap);
  EXPECT_EQ(now().gaps, 1U);
  EXPECT_GT(last_sequence_, last + 1);
  EXPECT_EQ(now().right.locked, now().left.locked);  // the exposure of before
  EXPECT_TRUE(pairs(3));
  EXPECT_FALSE(now().after_gap);
}

class ShortPatience : public CameraFaults {
 protected:
  ShortPatience() { reconnect_ms_ = 1500; }
};

TEST_P(ShortPatience, ACameraThatStaysAwayIsLostUntilTheNextStart) {
  order("unplug 0");
  const hal::Outcome outcome = take_until(*source_, Status::kNotFound);
  EXPECT_NE(outcome.message.find("plug it in again"), std::string::npos) << outcome.message;
  EXPECT_EQ(now().state, hal::LiveState::kLost);
  EXPECT_EQ(resources().video_devices, 0);
  source_->stop();
  EXPECT_FALSE(source_->start().ok());
  EXPECT_EQ(resources().video_devices, 0);
  order("plug 0");
  hal::Outcome started;
  for (int i = 0; i < 50 && !(started = source_->start()).ok(); ++i)  // until udev has made its links
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  ASSERT_TRUE(started.ok()) << started.message;
  last_sequence_ = -1;
  EXPECT_TRUE(pairs(3));
}

const auto kLibraries = testing::Values(Library::kV4l2, Library::kLibcamera);
const auto kName = [](const testing::TestParamInfo<Library>& i) {
  return std::string(i.param == Library::kV4l2 ? "v4l2" : "libcamera");
};
INSTANTIATE_TEST_SUITE_P(By, CameraFaults, kLibraries, kName);
INSTANTIATE_TEST_SUITE_P(By, ShortPatience, kLibraries, kName);

}  // namespace
}  // namespace accrete::vm
