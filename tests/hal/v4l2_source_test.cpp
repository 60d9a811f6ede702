// Live stereo on a fake kernel: what is negotiated, what arrives, what is counted.
#include <fstream>
#if ACCRETE_HAS_JPEG
#include <turbojpeg.h>
#endif

#include "support/temp_folder.h"
#include "v4l2_rig.h"

namespace accrete::hal {
namespace {

using v4l2::Kernel;

TEST(LiveSource, DeliversTruePairsWithTheirTimes) {
  Rig rig;
  ASSERT_TRUE(succeeds(rig.open_and_start()));
  for (int i = 0; i < 20; ++i) {
    StereoFrame frame;
    ASSERT_TRUE(succeeds(rig.acquire(frame)));
    EXPECT_EQ(frame.left.format, PixelFormat::kGrey8);
    EXPECT_EQ(frame.left.width_px, 32);
    EXPECT_EQ(frame.left.stride_bytes, 40);  // in the driver's own buffer
    EXPECT_EQ(image_number(*rig.left, frame.left), i);
    EXPECT_EQ(image_number(*rig.right, frame.right), i);
    EXPECT_EQ(frame.sequence, static_cast<std::uint64_t>(i));
    EXPECT_EQ(frame.t_left.ns, rig.left->due_ns(static_cast<std::uint64_t>(i)));
    EXPECT_EQ(frame.t_right - frame.t_left, 4'000'000);
    rig.source->release();
  }
  const LiveStatistics s = rig.source->statistics();
  EXPECT_EQ(s.state, LiveState::kStreaming);
  EXPECT_EQ(s.delivered, 20U);
  EXPECT_EQ(s.skew_min_ns, 4'000'000);
  EXPECT_EQ(s.skew_max_ns, 4'000'000);
  EXPECT_DOUBLE_EQ(s.skew_mean_ns, 4e6);
  EXPECT_EQ(s.pair_tolerance_ns, 8'000'000);
  EXPECT_EQ(s.left.clock, LiveClock::kStartOfExposure);
  EXPECT_EQ(s.left.id, "/dev/v4l/by-id/usb-left");
  EXPECT_EQ(s.right.id, "/dev/v4l/by-path/port-2");
  EXPECT_EQ(s.left.format, "GREY");
  EXPECT_EQ(s.left.dropped + s.right.dropped + s.left.unpaired + s.right.unpaired, 0U);
  rig.source->stop();
  EXPECT_EQ(rig.source->statistics().state, LiveState::kStopped);
  rig.source.reset();
  EXPECT_TRUE(rig.kernel.clean());
}

TEST(LiveSource, StartsAgainAfterAStop) {
  Rig rig;
  ASSERT_TRUE(succeeds(rig.open()));
  for (int round = 0; round < 3; ++round) {
    ASSERT_TRUE(succeeds(rig.source->start()));
    StereoFrame frame;
    ASSERT_TRUE(succeeds(rig.acquire(frame)));
    EXPECT_EQ(frame.sequence, 0U);
    rig.source->stop();  // while it is lent
    EXPECT_EQ(rig.kernel.mappings.size(), 0U);
  }
}

TEST(LiveSource, FindsADeviceByAnyOfItsNames) {
  for (const char* name : {"/dev/video0", "video0", "0", "/dev/v4l/by-id/usb-left", "usb-left", "Left", "usb-1"}) {
    Rig rig;
    rig.options.left = name;
    EXPECT_TRUE(succeeds(rig.open())) << name;
  }
  Rig rig;
  rig.options.left = "nowhere";
  EXPECT_TRUE(fails(rig.open(), Status::kNotFound, {"'nowhere'", "/dev/video0", "accrete devices"}));
  rig.options.left = "/dev/video1";
  EXPECT_TRUE(fails(rig.open(), Status::kUnsupported, {"/dev/video1", "does not stream video"}));
  rig.options.left = "/dev/video2";
  EXPECT_TRUE(fails(rig.open(), Status::kInvalidArgument, {"one camera", "by-path"}));
  rig.right->card = rig.left->card;
  rig.options.left = "Left";
  EXPECT_TRUE(fails(rig.open(), Status::kInvalidArgument, {"several cameras", "/dev/video0", "/dev/video2"}));
  EXPECT_TRUE(rig.kernel.clean());
  rig.kernel.nodes.clear();
  EXPECT_TRUE(fails(rig.open(), Status::kNotFound, {"there is no /dev/video*"}));
}

TEST(LiveSource, RefusesOptionsThatCannotBe) {
  const auto refused = [](auto&& change, Status status, std::initializer_list<std::string_view> pieces) {
    Rig rig;
    change(rig.options);
    const auto result = fails(rig.open(), status, pieces);
    EXPECT_EQ(rig.source, nullptr);
    return result;
  };
  const Status invalid = Status::kInvalidArgument;
  EXPECT_TRUE(refused([](LiveOptions& o) { o.right.clear(); }, invalid, {"one camera is named", "layout"}));
  EXPECT_TRUE(refused([](LiveOptions& o) { o.layout = StereoLayout::kSideBySide; }, invalid, {"sbs", "one device"}));
  EXPECT_TRUE(refused([](LiveOptions& o) { o.buffers = 2; }, invalid, {"3 to 32"}));
  EXPECT_TRUE(refused([](LiveOptions& o) { o.width_px = 32; }, invalid, {"32x0"}));
  EXPECT_TRUE(refused([](LiveOptions& o) { o.rate_hz = -1; }, invalid, {"-1"}));
  EXPECT_TRUE(refused([](LiveOptions& o) { o.format = "H264"; }, Status::kUnsupported, {"'H264'", "YUYV"}));
  EXPECT_TRUE(refused([](LiveOptions& o) { o.format = "Y8I"; }, invalid, {"Y8I", "y8i"}));
  EXPECT_TRUE(refused([](LiveOptions& o) { o.calibration = "/nowhere.yml"; }, Status::kNotFound, {"nowhere.yml"}));
}

TEST(LiveSource, ASizeOrAFormatThatTheDriverReplacesIsRefusedWithThoseItHas) {
  Rig rig;
  for (const auto& camera : {rig.left, rig.right})
    camera->sizes = {{V4L2_PIX_FMT_GREY, {{32, 16}, {64, 32}}}, {V4L2_PIX_FMT_YUYV, {{32, 16}}}};
  rig.options.width_px = 33;
  rig.options.height_px = 16;
  rig.options.format = "GREY";
  EXPECT_TRUE(fails(rig.open(), Status::kUnsupported, {"32x16 GREY instead of 33x16 GREY", "32x16, 64x32"}));
  rig.options.width_px = 64;
  rig.options.height_px = 32;
  EXPECT_TRUE(succeeds(rig.open()));
  rig.options.format = "MJPG";
  EXPECT_TRUE(fails(rig.open(), Status::kUnsupported, {"instead of 64x32 MJPG", "its formats are", "GREY", "YUYV"}));
  rig.options.format.clear();  // colour does not have that size: grey it is
  ASSERT_TRUE(succeeds(rig.open()));
  EXPECT_EQ(rig.source->statistics().right.format, "GREY");
  rig.options.width_px = rig.options.height_px = 0;
  ASSERT_TRUE(succeeds(rig.open()));
  EXPECT_EQ(rig.source->statistics().right.format, "YUYV");
  EXPECT_EQ(rig.source->statistics().left.width_px, 32);
}

TEST(LiveSource, ARateThatTheDriverReplacesIsTakenAndSaid) {
  Rig rig;
  rig.left->rate_hz = rig.right->rate_hz = 10;
  rig.options.rate_hz = 30;
  ASSERT_TRUE(succeeds(rig.open()));
  EXPECT_EQ(rig.source->statistics().left.rate_hz, 10);
  EXPECT_TRUE(says(rig.source->statistics().left.notices, {"10 Hz instead of 30:"}));
}

TEST(LiveSource, ABusyDeviceAndInterlacedImagesAreRefused) {
  Rig rig;
  rig.right->owner = 7;
  EXPECT_TRUE(fails(rig.open(), Status::kUnavailable, {"/dev/video2 (Right)", "another program"}));
  rig.right->owner = -1;
  rig.right->field = V4L2_FIELD_INTERLACED;
  EXPECT_TRUE(fails(rig.open(), Status::kUnsupported, {"interlaced"}));
}

TEST(LiveSource, TheCalibrationIsThatOfOneEye) {
  const test::TempFolder folder;
  std::ofstream(folder / "stereo.yml") << "%YAML:1.0\n---\nimage_width: 16\nimage_height: 16\nunits: m\n"
                                          "M1: !!opencv-matrix {rows: 3, cols: 3, dt: d, data: [20,0,8,0,20,8,0,0,1]}\n"
                                          "D1: !!opencv-matrix {rows: 1, cols: 4, dt: d, data: [0,0,0,0]}\n"
                                          "M2: !!opencv-matrix {rows: 3, cols: 3, dt: d, data: [20,0,8,0,20,8,0,0,1]}\n"
                                          "D2: !!opencv-matrix {rows: 1, cols: 4, dt: d, data: [0,0,0,0]}\n"
                                          "R: !!opencv-matrix {rows: 3, cols: 3, dt: d, data: [1,0,0,0,1,0,0,0,1]}\n"
                                          "T: !!opencv-matrix {rows: 3, cols: 1, dt: d, data: [-0.1,0,0]}\n";
  Rig rig;
  rig.options.right.clear();
  rig.options.layout = StereoLayout::kSideBySide;
  rig.options.calibration = folder / "stereo.yml";
  Outcome o = rig.open();
  if (o.status == Status::kUnsupported && o.message.find("this build") != std::string::npos)
    GTEST_SKIP() << "a build without YAML";
  ASSERT_TRUE(succeeds(o));
  EXPECT_EQ(rig.source->rig().left.width_px, 16);
  EXPECT_NEAR(rig.source->rig().baseline_m(), 0.1, 1e-12);
  rig.options.width_px = 32;
  rig.options.height_px = 16;
  EXPECT_TRUE(fails(rig.open(), Status::kInvalidArgument, {"32x16", "16x16", "one eye"}));
}

TEST(LiveSource, OneDeviceDeliversBothEyes) {
  for (const StereoLayout layout :
       {StereoLayout::kSideBySide, StereoLayout::kSideBySideSwapped, StereoLayout::kTopBottom}) {
    Rig rig;
    rig.options.right.clear();
    rig.options.layout = layout;
    ASSERT_TRUE(succeeds(rig.open_and_start()));
    StereoFrame frame;
    ASSERT_TRUE(succeeds(rig.acquire(frame)));
    const bool high = layout == StereoLayout::kTopBottom;
    EXPECT_EQ(frame.left.width_px, high ? 32 : 16);
    EXPECT_EQ(frame.left.height_px, high ? 8 : 16);
    const std::size_t second = high ? 8 * rig.left->stride() : 16;
    const bool swapped = layout == StereoLayout::kSideBySideSwapped;
    EXPECT_EQ(image_number(*rig.left, frame.left, swapped ? second : 0), 0);
    EXPECT_EQ(image_number(*rig.left, frame.right, swapped ? 0 : second), 0);
    EXPECT_EQ(frame.t_left, frame.t_right);
  }
}

TEST(LiveSource, InterleavedEyes) {
  Rig rig;
  rig.left->sizes = {{V4L2_PIX_FMT_GREY, {{32, 16}}}, {V4L2_PIX_FMT_Y8I, {{32, 16}}}};
  rig.options.right.clear();
  rig.options.layout = StereoLayout::kInterleaved;
  ASSERT_TRUE(succeeds(rig.open_and_start()));
  StereoFrame frame;
  ASSERT_TRUE(succeeds(rig.acquire(frame)));
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 32; ++x) {
      const std::size_t at = static_cast<std::size_t>(y) * rig.left->stride() + 2 * static_cast<std::size_t>(x);
      ASSERT_EQ(frame.left.row(y)[x], rig.left->pattern(0, 0, at));
      ASSERT_EQ(frame.right.row(y)[x], rig.left->pattern(0, 0, at + 1));
    }
  Rig other;
  other.options.right.clear();
  other.options.layout = StereoLayout::kInterleaved;
  EXPECT_EQ(other.open().status, Status::kUnsupported);
}

TEST(LiveSource, MultiplanarBuffers) {
  Rig rig;
  for (const auto& camera : {rig.left, rig.right}) {
    camera->multiplanar = true;
    camera->quantization = V4L2_QUANTIZATION_FULL_RANGE;
    camera->sizes = {{V4L2_PIX_FMT_NV12M, {{32, 16}}}};
  }
  ASSERT_TRUE(succeeds(rig.open_and_start()));
  EXPECT_EQ(rig.kernel.mappings.size(), 16U);  // 2 cameras, 4 buffers, 2 planes
  StereoFrame frame;
  ASSERT_TRUE(succeeds(rig.acquire(frame)));
  EXPECT_EQ(frame.right.format, PixelFormat::kRgb8);
  const auto stride = static_cast<std::size_t>(rig.right->stride());
  const double y = rig.right->pattern(0, 0, 5 * stride + 10), cr = rig.right->pattern(0, 1, 2 * stride + 11);
  EXPECT_EQ(frame.right.row(5)[30], std::lround(std::clamp(y + 1.402 * (cr - 128), 0.0, 255.0)));  // red of (10, 5)
  rig.source.reset();
  EXPECT_TRUE(rig.kernel.clean());
}

TEST(LiveSource, LossesAreCountedAndSeenInTheSequence) {
  Rig rig;
  rig.left->faults = {{3, FrameFault::kDropped}, {8, FrameFault::kNotSent}};
  rig.right->faults = {{5, FrameFault::kFlagged}, {6, FrameFault::kShort}, {12, FrameFault::kSameTime}};
  ASSERT_TRUE(succeeds(rig.open_and_start()));
  std::vector<int> seen;
  StereoFrame frame;
  while (seen.empty() || seen.back() < 19) {
    ASSERT_TRUE(succeeds(rig.acquire(frame)));
    const int left = image_number(*rig.left, frame.left);
    EXPECT_EQ(image_number(*rig.right, frame.right), left);
    seen.push_back(left);
    rig.source->release();
  }
  EXPECT_EQ(seen, (std::vector<int>{0, 1, 2, 4, 7, 9, 10, 11, 13, 14, 15, 16, 17, 18, 19}));
  EXPECT_EQ(frame.sequence, 18U);  // by the driver's numbers, which do not know of image 8
  const LiveStatistics s = rig.source->statistics();
  EXPECT_EQ(s.left.dropped, 1U);
  EXPECT_EQ(s.right.damaged, 3U);
  EXPECT_EQ(s.left.unpaired, 3U);
  EXPECT_EQ(s.right.unpaired, 2U);
  EXPECT_EQ(rig.source->counters().dropped, 4U);
  EXPECT_EQ(rig.source->counters().unpaired, 5U);
}

TEST(LiveSource, NumbersAndTimesMayWrap) {
  Rig rig;
  rig.left->first_sequence = 0xFFFFFFFB;
  if (sizeof(time_t) == 8)  // of 32 bits, a driver's clock has no time so late
    for (const auto& camera : {rig.left, rig.right}) camera->clock_offset_ns = INT64_MAX - 1'300'000'000;
  ASSERT_TRUE(succeeds(rig.open_and_start()));
  for (int i = 0; i < 20; ++i) {
    StereoFrame frame;
    ASSERT_TRUE(succeeds(rig.acquire(frame)));
    EXPECT_EQ(frame.sequence, static_cast<std::uint64_t>(i));
    EXPECT_EQ(image_number(*rig.right, frame.right), image_number(*rig.left, frame.left));
    rig.source->release();
  }
  EXPECT_EQ(rig.source->statistics().left.dropped, 0U);
}

TEST(LiveSource, WithoutTimesTheArrivalCounts) {
  Rig rig;
  for (const auto& camera : {rig.left, rig.right}) camera->clock = V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN;
  rig.right->first_after_ns = rig.left->first_after_ns + 2'000'000;
  ASSERT_TRUE(succeeds(rig.open_and_start()));
  StereoFrame frame;
  ASSERT_TRUE(succeeds(rig.acquire(frame)));
  EXPECT_EQ(frame.t_left.ns, rig.left->due_ns(0));
  EXPECT_EQ(rig.source->statistics().left.clock, LiveClock::kArrival);
}

TEST(LiveSource, AReaderThatIsTooSlowLosesImagesAndNothingElse) {
  Rig rig;
  ASSERT_TRUE(succeeds(rig.open_and_start()));
  int last = -1;
  for (int i = 0; i < 10; ++i) {
    StereoFrame frame;
    ASSERT_TRUE(succeeds(rig.acquire(frame)));
    const int left = image_number(*rig.left, frame.left);
    EXPECT_GT(left, last);
    EXPECT_EQ(image_number(*rig.right, frame.right), left);
    last = left;
    rig.kernel.now += 300'000'000;  // nine periods
    rig.kernel.poll(nullptr, 0, 0);
    EXPECT_EQ(image_number(*rig.left, frame.left), left) << "a lent image was overwritten";
    rig.source->release();
  }
  EXPECT_GT(rig.source->statistics().left.dropped, 40U);
}

#if ACCRETE_HAS_JPEG

std::vector<std::uint8_t> grey_jpeg(std::uint8_t level) {
  const std::vector<std::uint8_t> pixels(32 * 16, level);
  tjhandle tj = tjInitCompress();
  unsigned char* out = nullptr;
  unsigned long n = 0;
  tjCompress2(tj, pixels.data(), 32, 0, 16, TJPF_GRAY, &out, &n, TJSAMP_GRAY, 95, 0);
  std::vector<std::uint8_t> file(out, out + n);
  tjFree(out);
  tjDestroy(tj);
  return file;
}

TEST(LiveSource, MotionJpegIsDecodedAndDivided) {
  Rig rig;
  rig.options.right.clear();
  rig.options.layout = StereoLayout::kSideBySide;
  rig.left->sizes = {{V4L2_PIX_FMT_MJPEG, {{32, 16}}}};
  rig.left->padding = 64;  // as uvcvideo: a buffer large enough for any image
  rig.left->payload = [](std::uint32_t number) { return grey_jpeg(static_cast<std::uint8_t>(40 + 8 * number)); };
  rig.left->faults = {{1, FrameFault::kShort}};
  ASSERT_TRUE(succeeds(rig.open_and_start()));
  for (const int number : {0, 2, 3}) {  // half a JPEG is none
    StereoFrame frame;
    ASSERT_TRUE(succeeds(rig.acquire(frame)));
    EXPECT_EQ(frame.sequence, static_cast<std::uint64_t>(number));
    EXPECT_EQ(frame.right.width_px, 16);
    EXPECT_NEAR(frame.right.row(15)[15], 40 + 8 * number, 1);
    rig.source->release();
  }
  EXPECT_EQ(rig.source->statistics().left.damaged, 1U);
  EXPECT_EQ(rig.source->statistics().left.arrived, 3U);
}

#endif

std::map<std::uint32_t, FakeControl> uvc_controls() {
  return {{V4L2_CID_EXPOSURE_AUTO, {3, 0, 3, 0}},
          {V4L2_CID_EXPOSURE_ABSOLUTE, {157, 3, 2047, V4L2_CTRL_FLAG_INACTIVE}},
          {V4L2_CID_EXPOSURE_AUTO_PRIORITY, {1, 0, 1, 0}},
          {V4L2_CID_GAIN, {64, 0, 255, 0}},
          {V4L2_CID_AUTO_WHITE_BALANCE, {0, 0, 1, 0}},
          {V4L2_CID_WHITE_BALANCE_TEMPERATURE, {4600, 2000, 6500, 0}}};
}

TEST(LiveSource, ExposureIsLockedAfterTheWarmUpAndCopiedToTheRight) {
  Rig rig;
  rig.options.lock_exposure = true;
  rig.options.warm_up_frames = 5;
  rig.left->controls = rig.right->controls = uvc_controls();
  rig.right->controls[V4L2_CID_EXPOSURE_ABSOLUTE] = {300, 3, 100, 0};  // another range
  rig.right->controls.erase(V4L2_CID_GAIN);
  ASSERT_TRUE(succeeds(rig.open_and_start()));
  EXPECT_EQ(rig.source->statistics().state, LiveState::kWarmingUp);
  EXPECT_EQ(rig.left->controls[V4L2_CID_AUTO_WHITE_BALANCE].value, 1);
  StereoFrame frame;
  ASSERT_TRUE(succeeds(rig.acquire(frame)));
  EXPECT_EQ(image_number(*rig.left, frame.left), 5);
  EXPECT_EQ(frame.sequence, 0U);
  const LiveStatistics s = rig.source->statistics();
  EXPECT_EQ(s.warm_up, 5U);
  for (const auto& camera : {rig.left, rig.right}) {
    EXPECT_EQ(camera->controls[V4L2_CID_EXPOSURE_AUTO].value, V4L2_EXPOSURE_MANUAL);
    EXPECT_EQ(camera->controls[V4L2_CID_EXPOSURE_AUTO_PRIORITY].value, 0);
    EXPECT_EQ(camera->controls[V4L2_CID_AUTO_WHITE_BALANCE].value, 0);
  }
  EXPECT_TRUE(says(s.left.locked, {"exposure_time_absolute 157"}));
  EXPECT_TRUE(says(s.left.locked, {"gain 64"}));
  EXPECT_TRUE(says(s.right.locked, {"white_balance_temperature 4600"}));
  EXPECT_TRUE(says(s.right.notices, {"exposure_time_absolute is 100 instead of 157"}));
  EXPECT_TRUE(says(s.right.notices, {"no control gain"}));

  Rig plain;
  plain.options.lock_exposure = true;
  plain.options.warm_up_frames = 1;
  ASSERT_TRUE(succeeds(plain.open_and_start()));
  EXPECT_TRUE(succeeds(plain.acquire(frame)));
  EXPECT_TRUE(says(plain.source->statistics().left.notices, {"exposure time"}));
}

TEST(LiveSource, ListsDevicesButNotTheirMetadata) {
  Rig rig;
  rig.left->sizes = {{V4L2_PIX_FMT_GREY, {{2560, 720}, {1280, 480}}}, {v4l2_fourcc('H', '2', '6', '4'), {{2560, 720}}}};
  const std::vector<V4l2Device> devices = v4l2::list(rig.kernel);
  ASSERT_EQ(devices.size(), 2U);
  EXPECT_EQ(devices[0].node, "/dev/video0");
  EXPECT_EQ(devices[0].id, "usb-left");
  EXPECT_EQ(devices[0].card, "Left");
  ASSERT_EQ(devices[0].formats.size(), 2U);
  EXPECT_TRUE(devices[0].formats[0].understood != devices[0].formats[1].understood);
  const V4l2Format& grey = devices[0].formats[devices[0].formats[0].understood ? 0 : 1];
  EXPECT_EQ(grey.fourcc, "GREY");
  ASSERT_EQ(grey.sizes.size(), 2U);
  EXPECT_EQ(grey.sizes[0].rates_hz, std::vector<double>{30});
  EXPECT_EQ(devices[0].likely_layout, StereoLayout::kSideBySide);
  EXPECT_EQ(devices[1].id, "port-2");
  EXPECT_EQ(devices[1].likely_layout, StereoLayout::kTwoDevices);
  EXPECT_TRUE(rig.kernel.clean());
}

TEST(LiveSource, TheRealKernelAnswersWithoutACamera) {
  std::unique_ptr<LiveSource> source;
  LiveOptions options;
  options.left = "/dev/nowhere/left";
  options.right = "/dev/nowhere/right";
  EXPECT_TRUE(fails(open_v4l2(options, source), Status::kNotFound, {"/dev/nowhere/left"}));
  for (const V4l2Device& device : list_v4l2_devices()) EXPECT_FALSE(device.node.empty());
}

}  // namespace
}  // namespace accrete::hal
