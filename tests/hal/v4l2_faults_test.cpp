// Everything that goes wrong: every call with every errno, cameras that are unplugged, that stall, that lie. Nothing
// may crash, hang, leak, or be unable to start again.
#include "image/image_file.h"
#include "v4l2_rig.h"

namespace accrete::hal {
namespace {

constexpr int kErrors[] = {EINTR,  EAGAIN, EIO,    ENODEV,    ENXIO,  ENOMEM, EBUSY,  EINVAL,
                           EPROTO, EBADF,  ENOSPC, ETIMEDOUT, EACCES, ENOTTY, EFAULT, EPERM};

using MakeRig = void (*)(Rig&);

void two_devices(Rig& rig) {
  rig.options.lock_exposure = true;
  rig.options.warm_up_frames = 1;
  rig.left->controls = rig.right->controls = {{V4L2_CID_EXPOSURE_AUTO, {3, 0, 3, 0}},
                                              {V4L2_CID_EXPOSURE_ABSOLUTE, {157, 3, 2047, 0}},
                                              {V4L2_CID_GAIN, {64, 0, 255, 0}}};
}
void multiplanar(Rig& rig) {
  rig.options.right.clear();
  rig.options.layout = StereoLayout::kSideBySide;
  rig.left->multiplanar = true;
  rig.left->sizes = {{V4L2_PIX_FMT_NV12M, {{32, 16}}}};
}

// A session as a program has it: it goes on after a timeout, and stops at anything else.
int session(LiveSource& source) {
  int frames = 0;
  if (!source.start().ok()) return 0;
  for (int i = 0; i < 8; ++i) {
    StereoFrame frame;
    const Outcome o = source.acquire(200'000'000, frame);
    if (o.ok()) {
      ++frames;
      EXPECT_TRUE(frame.left.valid() && frame.right.valid());
      source.release();
    } else {
      EXPECT_FALSE(o.message.empty());
      if (o.status != Status::kTimeout) break;
    }
  }
  source.stop();
  return frames;
}

long calls_of_a_clean_session(MakeRig make) {
  Rig rig;
  make(rig);
  EXPECT_TRUE(succeeds(rig.open()));
  EXPECT_EQ(session(*rig.source), 8);
  rig.source.reset();
  EXPECT_TRUE(rig.kernel.clean());
  return rig.kernel.calls;
}

void sweep(MakeRig make, long fail_count, int& cases) {
  const long calls = calls_of_a_clean_session(make);
  for (const int error : kErrors)
    for (long call = 0; call < calls; ++call) {
      Rig rig;
      make(rig);
      rig.kernel.fail_at = call;
      rig.kernel.fail_errno = error;
      rig.kernel.fail_count = fail_count;
      const std::string what = "errno " + std::to_string(error) + " at call " + std::to_string(call);
      const std::int64_t begin = rig.kernel.now;
      const Outcome opened = rig.open();
      EXPECT_EQ(opened.ok(), rig.source != nullptr) << what;
      EXPECT_EQ(opened.ok(), opened.message.empty()) << what;
      const int frames = rig.source ? session(*rig.source) : 0;
      if (error == EINTR && fail_count == 1) {
        EXPECT_EQ(frames, 8) << what << " " << rig.kernel.failed;
      }
      EXPECT_LE(rig.kernel.now - begin, 8 * 200'000'000LL + kSecond) << what;  // no hang beyond the timeouts
      rig.kernel.fail_at = -1;
      // The same source works again, as soon as nothing fails any more.
      if (rig.source) {
        EXPECT_EQ(session(*rig.source), 8) << what << " " << rig.kernel.failed;
      }
      rig.source.reset();
      EXPECT_TRUE(rig.kernel.clean()) << what << " " << rig.kernel.failed;
      // And a new one.
      ASSERT_TRUE(succeeds(rig.open())) << what;
      EXPECT_EQ(session(*rig.source), 8) << what;
      rig.source.reset();
      EXPECT_TRUE(rig.kernel.clean()) << what;
      ++cases;
      if (testing::Test::HasFailure()) return;
    }
}

TEST(V4l2Faults, EveryCallWithEveryErrno) {
  int cases = 0;
  sweep(two_devices, 1, cases);
  sweep(multiplanar, 1, cases);
  EXPECT_GT(cases, 3000);
  RecordProperty("cases", cases);
}

TEST(V4l2Faults, EveryCallWithEveryErrnoAndAllThatFollow) {
  int cases = 0;
  sweep(two_devices, 1'000'000, cases);
  EXPECT_GT(cases, 2000);
}

TEST(V4l2Faults, UnpluggedAndPluggedInAgainUnderAnotherNumber) {
  Rig rig;
  two_devices(rig);
  ASSERT_TRUE(succeeds(rig.open_and_start()));
  StereoFrame frame;
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(succeeds(rig.acquire(frame)));
    rig.source->release();
  }
  EXPECT_EQ(frame.sequence, 4U);
  EXPECT_FALSE(rig.source->statistics().after_gap);
  rig.kernel.unplug("/dev/video2");
  EXPECT_TRUE(fails(rig.acquire(frame), Status::kTimeout, {"/dev/video2 (Right)", "gone", "by-path/port-2"}));
  EXPECT_EQ(rig.source->statistics().state, LiveState::kReconnecting);
  EXPECT_TRUE(rig.kernel.clean());  // the left one is closed, too
  EXPECT_EQ(rig.source->state(), StereoSource::SourceState::kStreaming);

  rig.kernel.events.emplace(rig.kernel.now + kSecond / 2, [&rig] {
    rig.right = rig.kernel.add("/dev/video7", 2);
    rig.right->card = "Right";
    rig.right->controls = rig.left->controls;
    rig.right->controls[V4L2_CID_GAIN].value = 1;
    rig.kernel.links["/dev/v4l/by-path/port-2"] = "/dev/video7";
  });
  ASSERT_TRUE(succeeds(rig.acquire(frame, 3 * kSecond)));
  EXPECT_TRUE(rig.source->statistics().after_gap);
  EXPECT_GT(frame.sequence, 20U);  // more than a second is missing
  EXPECT_EQ(image_number(*rig.right, frame.right), image_number(*rig.left, frame.left));
  EXPECT_EQ(rig.right->controls[V4L2_CID_GAIN].value, 64);  // locked as before
  const LiveStatistics s = rig.source->statistics();
  EXPECT_EQ(s.right.node, "/dev/video7");
  EXPECT_EQ(s.reconnects, 1U);
  EXPECT_EQ(s.gaps, 1U);
  EXPECT_EQ(s.state, LiveState::kStreaming);
  rig.source->release();
  ASSERT_TRUE(succeeds(rig.acquire(frame)));
  EXPECT_FALSE(rig.source->statistics().after_gap);
}

TEST(V4l2Faults, ACameraThatDoesNotComeBackIsLost) {
  Rig rig;
  rig.options.reconnect_timeout_ns = 2 * kSecond;
  ASSERT_TRUE(succeeds(rig.open_and_start()));
  StereoFrame frame;
  ASSERT_TRUE(succeeds(rig.acquire(frame)));
  rig.source->release();
  rig.kernel.unplug("/dev/video0");
  EXPECT_TRUE(fails(rig.acquire(frame), Status::kTimeout, {"gone"}));
  EXPECT_TRUE(fails(rig.acquire(frame, 5 * kSecond), Status::kNotFound, {"lost", "within 2 s"}));
  EXPECT_EQ(rig.source->statistics().state, LiveState::kLost);
  EXPECT_TRUE(rig.kernel.clean());
  // Its owner plugs it in and starts again.
  rig.source->stop();
  EXPECT_TRUE(fails(rig.source->start(), Status::kNotFound, {"by-id/usb-left"}));
  rig.left = rig.kernel.add("/dev/video0", 1);
  rig.left->card = "Left";
  rig.kernel.links["/dev/v4l/by-id/usb-left"] = "/dev/video0";
  ASSERT_TRUE(succeeds(rig.source->start()));
  ASSERT_TRUE(succeeds(rig.acquire(frame)));
  EXPECT_EQ(frame.sequence, 0U);

  Rig never;
  never.options.reconnect_timeout_ns = 0;
  ASSERT_TRUE(succeeds(never.open_and_start()));
  never.kernel.unplug("/dev/video0");
  EXPECT_TRUE(fails(never.acquire(frame), Status::kNotFound, {"lost"}));
}

TEST(V4l2Faults, AnotherCameraAtTheSameNodeIsNotTaken) {
  Rig rig;
  rig.kernel.links.clear();
  ASSERT_TRUE(succeeds(rig.open_and_start()));
  rig.kernel.unplug("/dev/video2");
  rig.kernel.add("/dev/video2", 5)->card = "Stranger";
  StereoFrame frame;
  EXPECT_TRUE(fails(rig.acquire(frame), Status::kTimeout, {"another camera now", "Stranger"}));
}

// Cameras of one model share a link in by-id: what it leads to once one of them is gone is the other one.
TEST(V4l2Faults, TwinsAreToldApartByTheirPorts) {
  Rig rig;
  rig.left->card = rig.right->card = "Twin";
  rig.kernel.links = {{"/dev/v4l/by-id/usb-twin", "/dev/video2"},
                      {"/dev/v4l/by-path/port-1", "/dev/video0"},
                      {"/dev/v4l/by-path/port-2", "/dev/video2"}};
  ASSERT_TRUE(succeeds(rig.open_and_start()));
  EXPECT_EQ(rig.source->statistics().right.id, "/dev/v4l/by-path/port-2");
}

TEST(V4l2Faults, AFatalStreamingErrorIsARestart) {
  Rig rig;
  ASSERT_TRUE(succeeds(rig.open_and_start()));
  StereoFrame frame;
  ASSERT_TRUE(succeeds(rig.acquire(frame)));
  rig.source->release();
  rig.left->broken = true;
  ASSERT_TRUE(succeeds(rig.acquire(frame)));
  EXPECT_TRUE(rig.source->statistics().after_gap);
  EXPECT_NE(rig.source->statistics().loss.find("/dev/video0"), std::string::npos);
  EXPECT_GE(frame.sequence, 2U);
}

TEST(V4l2Faults, AStallIsATimeoutWithAdvice) {
  Rig rig;
  ASSERT_TRUE(succeeds(rig.open()));
  rig.right->first_after_ns = 3600 * kSecond;
  ASSERT_TRUE(succeeds(rig.source->start()));
  StereoFrame frame;
  const std::int64_t begin = rig.kernel.now;
  EXPECT_TRUE(fails(rig.acquire(frame), Status::kTimeout, {"no image from /dev/video2 (Right)", "bandwidth"}));
  EXPECT_EQ(rig.kernel.now - begin, kSecond);
  EXPECT_TRUE(fails(rig.acquire(frame, 0), Status::kTimeout, {"/dev/video"}));
}

TEST(V4l2Faults, ImagesThatAreTooFarApartAreATimeoutWithFigures) {
  Rig rig;
  rig.right->first_after_ns = rig.left->first_after_ns + 15'000'000;
  ASSERT_TRUE(succeeds(rig.open_and_start()));
  StereoFrame frame;
  EXPECT_TRUE(fails(rig.acquire(frame), Status::kTimeout, {"no pair", "15 ms apart", "8 ms are tolerated"}));
  EXPECT_GT(rig.source->counters().unpaired, 20U);
  rig.source->stop();
  rig.options.pair_tolerance_ns = 16'000'000;
  ASSERT_TRUE(succeeds(rig.open_and_start()));
  EXPECT_TRUE(succeeds(rig.acquire(frame)));
}

TEST(V4l2Faults, AClockThatIsSetBackIsFollowedInTheEnd) {
  Rig rig;
  ASSERT_TRUE(succeeds(rig.open_and_start()));
  StereoFrame frame;
  ASSERT_TRUE(succeeds(rig.acquire(frame)));
  rig.source->release();
  rig.left->clock_offset_ns = rig.right->clock_offset_ns = -500 * kSecond;
  ASSERT_TRUE(succeeds(rig.acquire(frame)));
  EXPECT_LT(frame.t_left.ns, 0);
  EXPECT_EQ(rig.source->statistics().left.damaged, 7U);
}

TEST(V4l2Faults, UndecodableImagesAreCountedAndLeftOut) {
  Rig rig;
  if (!supported(ImageFormat::kJpeg)) GTEST_SKIP() << "a build without JPEG";
  for (const auto& camera : {rig.left, rig.right}) camera->sizes = {{V4L2_PIX_FMT_MJPEG, {{32, 16}}}};
  rig.right->payload = [](std::uint32_t) { return std::vector<std::uint8_t>{0xFF, 0xD8, 0, 1, 2, 3}; };
  ASSERT_TRUE(succeeds(rig.open_and_start()));
  StereoFrame frame;
  EXPECT_TRUE(fails(rig.acquire(frame), Status::kTimeout, {"no image", "damaged"}));
  EXPECT_GT(rig.source->statistics().left.damaged, 20U);  // the pattern is no JPEG either; the left one is tried first
  EXPECT_EQ(rig.source->statistics().delivered, 0U);
}

}  // namespace
}  // namespace accrete::hal
