// The V4L2 back-end against vivid, the kernel's test driver: formats, sizes, injected errors, wraps, a device that goes
// and comes back. Each fault ends in the state that docs/reference/cameras.md names, and leaves nothing behind.
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "live.h"
#include "resources.h"
#include "vivid.h"

namespace accrete::vm {
namespace {

constexpr int kRamp = 20;  // a pattern: grey from 0 at the left to 255 at the right

hal::LiveOptions two(const std::string& fourcc) {
  hal::LiveOptions options;
  options.left = kDevices[0];
  options.right = kDevices[1];
  options.width_px = 320;
  options.height_px = 180;
  options.rate_hz = 30;
  options.format = fourcc;
  options.warm_up_frames = 0;
  options.pair_tolerance_ns = 40 * kMillisecond;  // the two start when they like
  return options;
}

class VividFaults : public LeavesNothing {
 protected:
  void SetUp() override {
    for (const int device : {0, 1}) {
      set(device, Vivid::kPattern, kRamp);
      set(device, Vivid::kText, 2);
    }
  }
  void TearDown() override {
    source_.reset();
    for (const Vivid control :
         {Vivid::kDropPercent, Vivid::kSequenceWrap, Vivid::kTimestampWrap, Vivid::kTimestampSource})
      set(0, control, 0);
    LeavesNothing::TearDown();
  }
  [[nodiscard]] bool start() {
    source_ = opened(two("GREY"));
    const hal::Outcome started = source_ ? source_->start() : hal::Outcome{Status::kNotFound, "not opened"};
    EXPECT_TRUE(started.ok()) << started.message;
    return started.ok();
  }
  // Streams, stops, and leaves the buffers with the driver.
  void expect_whole() {
    EXPECT_TRUE(take(*source_, 3));
    EXPECT_EQ(resources().video_devices, 2);
    source_->stop();
    EXPECT_EQ(resources().video_maps, 0);
  }
  [[nodiscard]] hal::LiveStatistics now() const { return source_->statistics(); }

  std::unique_ptr<hal::LiveSource> source_;
};

TEST_F(VividFaults, AnInjectedErrorOfReqbufsIsOvercome) {
  set(0, Vivid::kReqbufsError, 1);
  ASSERT_TRUE(start());
  expect_whole();
}

TEST_F(VividFaults, AnInjectedErrorOfQbufIsOvercome) {
  set(0, Vivid::kQbufError, 1);
  ASSERT_TRUE(start());
  expect_whole();
}

TEST_F(VividFaults, AnInjectedErrorOfStreamonIsOvercome) {
  set(1, Vivid::kStreamonError, 1);
  ASSERT_TRUE(start());
  expect_whole();
}

TEST_F(VividFaults, AnErrorOfQbufWhileStreamingCostsOneFrameAtMost) {
  ASSERT_TRUE(start());
  ASSERT_TRUE(take(*source_, 2));
  set(0, Vivid::kQbufError, 1);
  EXPECT_TRUE(take(*source_, 5));
  EXPECT_EQ(now().state, hal::LiveState::kStreaming);
  EXPECT_EQ(now().reconnects, 0U);
}

TEST_F(VividFaults, ABufferThatIsFlaggedIsCountedAndLeftOut) {
  ASSERT_TRUE(start());
  ASSERT_TRUE(take(*source_, 2));
  set(0, Vivid::kBufferError, 1);
  ASSERT_TRUE(take(*source_, 8));
  EXPECT_EQ(now().left.damaged, 1U);
  EXPECT_GE(source_->counters().dropped, 1U);
}

TEST_F(VividFaults, DroppedBuffersAreCounted) {
  set(0, Vivid::kDropPercent, 60);
  ASSERT_TRUE(start());
  ASSERT_TRUE(take(*source_, 8));
  EXPECT_GE(now().left.dropped, 3U);
  EXPECT_GE(now().right.unpaired, 3U);
}

TEST_F(VividFaults, AStreamWithoutFramesIsATimeoutThatNamesTheCamera) {
  set(0, Vivid::kDropPercent, 100);
  ASSERT_TRUE(start());
  const hal::Outcome outcome = take_until(*source_, Status::kTimeout);
  EXPECT_NE(outcome.message.find("/dev/video0"), std::string::npos) << outcome.message;
  set(0, Vivid::kDropPercent, 0);
  EXPECT_TRUE(take(*source_, 3));
}

TEST_F(VividFaults, NumbersThatWrapAreNoLoss) {
  set(0, Vivid::kSequenceWrap, 1);
  ASSERT_TRUE(start());
  ASSERT_TRUE(take(*source_, 140, 3 * kLimit_ns));  // 128 before the wrap
  EXPECT_LT(now().left.dropped, 100U);              // a busy machine drops some, 2^32 are none of them
}

TEST_F(VividFaults, TimesAtTheEndOfTheirRangeAreNoCrash) {
  set(0, Vivid::kTimestampWrap, 1);
  ASSERT_TRUE(start());
  take_until(*source_, Status::kTimeout);  // nothing pairs with those
  EXPECT_NE(now().state, hal::LiveState::kLost);
  EXPECT_GT(now().left.unpaired + now().left.damaged, 0U);
}

TEST_F(VividFaults, TheSourceOfTheTimeIsReported) {
  ASSERT_TRUE(start());
  ASSERT_TRUE(take(*source_, 1));
  EXPECT_EQ(now().left.clock, hal::LiveClock::kEndOfFrame);
  source_.reset();
  set(0, Vivid::kTimestampSource, 1);
  ASSERT_TRUE(start());
  ASSERT_TRUE(take(*source_, 1));
  EXPECT_EQ(now().left.clock, hal::LiveClock::kStartOfExposure);
}

TEST_F(VividFaults, AFatalErrorOfTheStreamIsOvercomeByStartingAgain) {
  ASSERT_TRUE(start());
  ASSERT_TRUE(take(*source_, 2));
  set(0, Vivid::kFatalError, 1);
  ASSERT_TRUE(take(*source_, 8));
  EXPECT_EQ(now().reconnects, 1U);
  EXPECT_EQ(now().gaps, 1U);
  EXPECT_FALSE(now().loss.empty());
}

// vivid connects again when the last one who has the device open lets go: when the back-end has torn everything down.
TEST_F(VividFaults, ADeviceThatIsDisconnectedIsTakenUpAgain) {
  ASSERT_TRUE(start());
  ASSERT_TRUE(take(*source_, 2));
  set(0, Vivid::kDisconnect, 1);
  ASSERT_TRUE(take(*source_, 8));
  EXPECT_EQ(now().reconnects, 1U);
  EXPECT_EQ(now().gaps, 1U);
  EXPECT_NE(now().loss.find(kDevices[0]), std::string::npos) << now().loss;
}

TEST_F(VividFaults, ADeviceThatStaysAwayIsLookedForUntilItReturns) {
  ASSERT_TRUE(start());
  ASSERT_TRUE(take(*source_, 2));
  const int holder = open(kDevices[0], O_RDWR | O_CLOEXEC);
  set(0, Vivid::kDisconnect, 1);
  take_until(*source_, Status::kTimeout);
  take_until(*source_, Status::kTimeout);
  EXPECT_EQ(now().state, hal::LiveState::kReconnecting);
  EXPECT_EQ(resources().video_devices, 1);  // the holder
  EXPECT_EQ(resources().video_maps, 0);
  close(holder);
  ASSERT_TRUE(take(*source_, 3));
  EXPECT_EQ(now().reconnects, 1U);
  EXPECT_TRUE(now().gaps == 1U && !now().after_gap);
}

TEST_F(VividFaults, ASizeThatTheDriverSilentlyChangesIsRefused) {
  hal::LiveOptions options = two("GREY");
  options.width_px = 333;
  options.height_px = 222;
  const hal::Outcome outcome = hal::open_v4l2(options, source_);
  EXPECT_EQ(outcome.status, Status::kUnsupported);
  for (const char* said : {"333x222", "320x180", "640x360"})
    EXPECT_NE(outcome.message.find(said), std::string::npos) << outcome.message;
}

TEST_F(VividFaults, AFormatThatTheDriverHasNotIsRefused) {
  const hal::Outcome outcome = hal::open_v4l2(two("MJPG"), source_);
  EXPECT_EQ(outcome.status, Status::kUnsupported);
  EXPECT_NE(outcome.message.find("YUYV"), std::string::npos) << outcome.message;
}

TEST_F(VividFaults, ABusyDeviceIsSaidToBeBusy) {
  ASSERT_TRUE(start());
  std::unique_ptr<hal::LiveSource> second;
  hal::Outcome outcome = hal::open_v4l2(two("YUYV"), second);
  if (outcome.ok()) outcome = second->start();
  EXPECT_EQ(outcome.status, Status::kUnavailable) << outcome.message;
  second.reset();
  EXPECT_TRUE(take(*source_, 3));
}

TEST_F(VividFaults, AFrameThatIsHeldForLongDoesNotEndTheStream) {
  ASSERT_TRUE(start());
  StereoFrame frame;
  ASSERT_TRUE(acquire(*source_, kLimit_ns, frame).ok());
  usleep(1'000'000);  // every buffer of the driver is full by now
  source_->release();
  EXPECT_TRUE(take(*source_, 10));
  EXPECT_GT(now().left.dropped, 0U);
}

// The ramp is grey in every format: the same levels, up to the rounding of the driver's colours and ours.
class VividFormats : public VividFaults, public testing::WithParamInterface<const char*> {};

TEST_P(VividFormats, ShowTheRamp) {
  hal::LiveOptions options = two(GetParam());
  const char* multiplanar = std::getenv("ACCRETE_MULTIPLANAR");
  if (options.format[1] == 'M' && (multiplanar == nullptr || *multiplanar != '2'))
    GTEST_SKIP() << "planes with a memory of their own need vivid multiplanar=2";
  source_ = opened(options);
  ASSERT_NE(source_, nullptr);
  ASSERT_TRUE(source_->start().ok());
  StereoFrame frame;
  ASSERT_TRUE(acquire(*source_, kLimit_ns, frame).ok());
  int worst = 0;
  for (const ImageView& image : {frame.left, frame.right}) {
    ASSERT_EQ(image.width_px, 320);
    ASSERT_EQ(image.height_px, 180);
    for (const int y : {0, 90, 179})
      for (int x = 0; x < 320; ++x)
        for (int c = 0; c < channels(image.format); ++c) {
          const double ramp = 255.0 * x / 320;  // 0, 127 and 254 at x = 0, 160 and 319 were measured
          worst = std::max(worst, std::abs(image.row(y)[x * channels(image.format) + c] - static_cast<int>(ramp)));
        }
  }
  EXPECT_LE(worst, 4) << "grey levels";
  source_->release();
  expect_whole();
}

INSTANTIATE_TEST_SUITE_P(Formats, VividFormats,
                         testing::Values("GREY", "Y16", "Y12", "Y10", "YUYV", "UYVY", "NV12", "YU12", "RGB3", "BGR3",
                                         "NM12", "YM12"),
                         [](const testing::TestParamInfo<const char*>& i) { return std::string(i.param); });

}  // namespace
}  // namespace accrete::vm
