// What the source makes of two cameras of libcamera: names, formats, controls, pairs, losses.
#include <gtest/gtest.h>

#include <chrono>
#include <functional>

#include "fake_cameras.h"
#include "libcamera/source.h"
#include "libcamera/value_text.h"
#include "outcome_matchers.h"

namespace accrete::hal::libcam {
namespace {

constexpr std::int64_t kMs = 1'000'000;

std::int64_t now() { return std::chrono::steady_clock::now().time_since_epoch().count(); }

struct Rig {
  std::vector<FakeCamera> cameras{{"/left", "imx296"}, {"/right", "imx296"}, {"/other", "ov9281"}};
  int running = 0;  // camera managers
  LibcameraOptions options;
  std::unique_ptr<Source> source;

  Rig() {
    options.left = "/left";
    options.right = "/right";
    options.warm_up_frames = 0;
    options.lock_exposure = false;
    options.pair_tolerance_ns = 5 * kMs;
  }
  Outcome open() {
    source = std::make_unique<Source>(std::make_unique<FakeCameras>(cameras, running), options);
    return source->configure();
  }
  void start() {
    ASSERT_TRUE(open().ok());
    ASSERT_TRUE(source->start().ok());
  }
  // A pair of images; `t_ms` of the left, the right comes `skew_ms` later.
  void deliver(std::int64_t t_ms, std::int64_t skew_ms = 1) {
    cameras[0].deliver(t_ms * kMs);
    cameras[1].deliver((t_ms + skew_ms) * kMs);
  }
  bool next(StereoFrame& frame) {
    const Outcome o = source->acquire(100 * kMs, frame);
    if (o.ok()) source->release();
    return o.ok();
  }
  std::string told(std::size_t camera) const {
    std::string text;
    for (const LibcameraControl& c : cameras[camera].told) text += c.name + "=" + c.value + " ";
    return text;
  }
};

TEST(LibcameraNames, AreIdsModelsAndNumbers) {
  const std::vector<LibcameraCamera> all = {{"/a", "x", {}, {}, {}}, {"/b", "x", {}, {}, {}}, {"/c", "y", {}, {}, {}}};
  LibcameraCamera found;
  EXPECT_TRUE(find_camera(all, "/b", found).ok() && found.id == "/b");
  EXPECT_TRUE(find_camera(all, "y", found).ok() && found.id == "/c");
  EXPECT_TRUE(find_camera(all, "1", found).ok() && found.id == "/b");
  EXPECT_TRUE(fails(find_camera(all, "x", found), Status::kInvalidArgument, {"/a, /b, /c"}));
  EXPECT_TRUE(fails(find_camera(all, "3", found), Status::kNotFound, {"/a, /b, /c"}));
  EXPECT_TRUE(fails(find_camera({}, "0", found), Status::kNotFound, {"connected"}));
}

TEST(LibcameraValues, AreTextAndBack) {
  EXPECT_EQ(parse_values<float>("1.8,-0.5"), (std::vector<float>{1.8F, -0.5F}));
  EXPECT_EQ(parse_values<std::int32_t>("8000"), std::vector<std::int32_t>{8000});
  for (const char* bad : {"", ",", "1,", ",1", "1;2", "1.5x", "x", " 1", "99999999999999999999"})
    EXPECT_TRUE(parse_values<std::int32_t>(bad).empty()) << bad;
  const std::vector<float> values = {0.1F, 3.0F, 1e-30F};
  EXPECT_EQ(parse_values<float>(values_text(std::span<const float>(values))), values);
}

TEST(LibcameraSource, RefusesWithASentence) {
  const auto refused = [](const std::function<void(Rig&)>& change, Status status, const char* piece) {
    Rig rig;
    change(rig);
    EXPECT_TRUE(fails(rig.open(), status, {piece}));
    rig.source.reset();
    for (const FakeCamera& camera : rig.cameras) EXPECT_EQ(camera.open, 0) << piece;
    EXPECT_EQ(rig.running, 0) << piece;
  };
  refused([](Rig& r) { r.options.right = "/left"; }, Status::kInvalidArgument, "one camera");
  refused([](Rig& r) { r.options.right = "/none"; }, Status::kNotFound, "/other");
  refused([](Rig& r) { r.options.format = "H264"; }, Status::kUnsupported, "YUYV");
  refused([](Rig& r) { r.options.layout = StereoLayout::kInterleaved, r.options.right = ""; }, Status::kUnsupported,
          "V4L2");
  refused([](Rig& r) { r.options.width_px = r.options.height_px = 100; }, Status::kUnsupported, "/left (imx296)");
  refused([](Rig& r) { r.options.controls = {{"Zoom", "1"}}; }, Status::kInvalidArgument, "no control 'Zoom'");
  refused([](Rig& r) { r.cameras[1].formats = {"SRGGB10"}; }, Status::kUnsupported, "no format");
}

TEST(LibcameraSource, ChoosesTheBestFormatThatBothHaveAndTakesV4l2Names) {
  Rig rig;
  ASSERT_TRUE(rig.open().ok());
  EXPECT_EQ(rig.source->statistics().left.format, "YUYV");
  rig.cameras[1].formats = {"R8"};
  ASSERT_TRUE(rig.open().ok());
  EXPECT_EQ(rig.source->statistics().left.format, "R8");
  rig.options.format = "GREY";
  ASSERT_TRUE(rig.open().ok());
  EXPECT_EQ(rig.source->statistics().right.format, "R8");
}

TEST(LibcameraSource, PairsByTimeAndGivesEveryBufferBack) {
  Rig rig;
  rig.start();
  StereoFrame frame;
  rig.deliver(100);
  ASSERT_TRUE(rig.next(frame));
  EXPECT_EQ(frame.sequence, 0U);
  EXPECT_EQ(frame.t_left.ns, 100 * kMs);
  EXPECT_EQ(frame.t_right.ns, 101 * kMs);
  rig.cameras[0].deliver(200 * kMs);  // its partner never comes
  rig.cameras[1].sequence++;
  rig.deliver(300);
  ASSERT_TRUE(rig.next(frame));
  EXPECT_EQ(frame.t_left.ns, 300 * kMs);
  EXPECT_EQ(frame.sequence, 2U);
  rig.cameras[0].deliver(400 * kMs, Letter::What::kDamaged);
  rig.cameras[1].deliver(401 * kMs);
  rig.deliver(500);
  ASSERT_TRUE(rig.next(frame));
  const LiveStatistics s = rig.source->statistics();
  EXPECT_EQ(s.left.unpaired, 1U);
  EXPECT_EQ(s.left.damaged, 1U);
  EXPECT_EQ(s.right.unpaired, 1U);
  EXPECT_EQ(s.right.dropped, 1U);
  EXPECT_EQ(s.left.clock, LiveClock::kStartOfExposure);
  EXPECT_EQ(rig.cameras[0].given_back.size(), 5U);
  EXPECT_EQ(rig.cameras[1].given_back.size(), 4U);
}

TEST(LibcameraSource, TheLeftCamerasExposureHoldsForBoth) {
  Rig rig;
  rig.options.warm_up_frames = 2;
  rig.options.lock_exposure = true;
  rig.options.rate_hz = 50;
  rig.cameras[1].reported["ExposureTime"] = "7000";
  rig.start();
  EXPECT_EQ(rig.told(0), "FrameDurationLimits=20000,20000 AeEnable=true ");
  EXPECT_EQ(rig.source->statistics().left.rate_hz, 50);
  StereoFrame frame;
  for (std::int64_t t = 0; t < 3; ++t) rig.deliver(1000 + 20 * t);
  ASSERT_TRUE(rig.next(frame));
  EXPECT_EQ(frame.t_left.ns, 1040 * kMs);
  const LiveStatistics s = rig.source->statistics();
  EXPECT_EQ(s.left.locked, (std::vector<std::string>{"AeEnable false", "ExposureTime 5000", "AnalogueGain 2"}));
  EXPECT_EQ(s.right.locked, s.left.locked);
  EXPECT_NE(rig.told(1).find("AeEnable=false ExposureTime=5000 AnalogueGain=2 "), std::string::npos) << rig.told(1);
  EXPECT_EQ(s.left.notices, std::vector<std::string>{"it cannot fix its white balance: the camera may change it"});
}

TEST(LibcameraSource, WhatTheUserSetsIsNotLocked) {
  Rig rig;
  rig.options.warm_up_frames = 1;
  rig.options.lock_exposure = true;
  rig.options.controls = {{"AeEnable", "false"}, {"ExposureTime", "8000"}};
  rig.start();
  StereoFrame frame;
  rig.deliver(0);
  rig.deliver(20);
  ASSERT_TRUE(rig.next(frame));
  EXPECT_EQ(rig.told(0), "AeEnable=false ExposureTime=8000 ");
  EXPECT_EQ(rig.told(1), rig.told(0));
}

TEST(LibcameraSource, ACameraThatReturnsIsTakenUpAgainByANewManager) {
  Rig rig;
  rig.start();
  StereoFrame frame;
  rig.deliver(100);
  ASSERT_TRUE(rig.next(frame));
  rig.cameras[1].pull_out();
  EXPECT_FALSE(rig.next(frame));
  EXPECT_EQ(rig.source->statistics().state, LiveState::kReconnecting);
  EXPECT_NE(rig.source->statistics().loss.find("/right"), std::string::npos);
  EXPECT_EQ(rig.cameras[0].open + rig.cameras[1].open, 0);
  EXPECT_EQ(rig.running, 0);  // one that lives on would crash when the camera returns (libcamera 0.0.3)
  rig.cameras[1].plugged = true;
  const std::int64_t limit = now() + 5000 * kMs;
  while (rig.source->statistics().state != LiveState::kStreaming && now() < limit) EXPECT_FALSE(rig.next(frame));
  rig.deliver(100'000);
  ASSERT_TRUE(rig.next(frame));
  EXPECT_EQ(rig.source->statistics().reconnects, 1U);
  EXPECT_EQ(rig.source->statistics().gaps, 1U);
  EXPECT_TRUE(rig.source->statistics().after_gap);
  EXPECT_GE(frame.sequence, 2U);
  rig.source->stop();
  rig.source.reset();
  EXPECT_EQ(rig.running, 0);
}

TEST(LibcameraSource, OneThatDoesNotReturnIsLost) {
  Rig rig;
  rig.options.reconnect_timeout_ns = 50 * kMs;
  rig.start();
  rig.cameras[0].pull_out();
  StereoFrame frame;
  Outcome last;
  for (const std::int64_t limit = now() + 5000 * kMs; now() < limit && last.status != Status::kNotFound;)
    last = rig.source->acquire(20 * kMs, frame);
  EXPECT_TRUE(fails(last, Status::kNotFound, {"/left"}));
  rig.cameras[0].plugged = true;
  rig.source->stop();
  EXPECT_TRUE(rig.source->start().ok());
}

TEST(LibcameraSource, AFailedStartLeavesNothingBehind) {
  Rig rig;
  rig.cameras[1].starts = false;
  ASSERT_TRUE(rig.open().ok());
  EXPECT_TRUE(fails(rig.source->start(), Status::kUnavailable, {"/right"}));
  EXPECT_EQ(rig.cameras[0].open + rig.cameras[1].open + rig.running, 0);
  rig.cameras[1].starts = true;
  EXPECT_TRUE(rig.source->start().ok());
}

TEST(LibcameraSource, SaysWhichCameraIsStill) {
  Rig rig;
  rig.start();
  rig.cameras[0].deliver(100 * kMs);
  StereoFrame frame;
  EXPECT_TRUE(fails(rig.source->acquire(30 * kMs, frame), Status::kTimeout, {"/right (imx296)"}));
}

}  // namespace
}  // namespace accrete::hal::libcam
