// Live cameras on the command line, without one: flags, refusals, what `devices` prints, a source that stalls.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <fstream>

#include "cli/child.h"
#include "cli/devices/devices_command.h"
#include "cli/json_schema.h"
#include "cli/live/camera_flags.h"
#include "cli/live/live_cameras.h"
#include "cli/run/accumulate.h"
#include "cli/run/summary.h"
#include "cli/text/json_text.h"
#include "support/temp_folder.h"

namespace accrete::cli {
namespace {

using nlohmann::json;

TEST(live_flags, name_one_camera_or_two) {
  const CameraFlags flags;
  const hal::LiveOptions two = flags.options("v4l2:/dev/video0,pci-0000:00:14.0-usb-0:1:1.0-video-index0");
  EXPECT_EQ(two.left, "/dev/video0");
  EXPECT_EQ(two.right, "pci-0000:00:14.0-usb-0:1:1.0-video-index0");
  EXPECT_TRUE(two.lock_exposure);
  for (const char* bad : {"v4l2:", "v4l2:,", "v4l2:a,", "v4l2:,b", "v4l2:a"})
    EXPECT_THROW((void)flags.options(bad), Failure) << bad;
  EXPECT_EQ(parse_size("--size", "1280x720").height_px, 720);
  for (const char* bad : {"", "640", "640x", "x480", "640x480x3", "-640x480", "0x0", "640 x480", "9999999x1"})
    EXPECT_THROW((void)parse_size("--size", bad), Failure) << bad;
}

TEST(live_flags, take_controls_of_libcamera_by_name) {
  CLI::App app;
  CameraFlags flags;
  flags.add(app);
  app.parse("--control ExposureTime=8000 --control ColourGains=1.8,1.5");
  const hal::LibcameraOptions o = flags.options("libcamera:0,1");
  ASSERT_EQ(o.controls.size(), 2U);
  EXPECT_EQ(o.controls[1].name, "ColourGains");
  EXPECT_EQ(o.controls[1].value, "1.8,1.5");
  EXPECT_THROW((void)flags.options("v4l2:0,1"), Failure);
}

TEST(live_program, says_what_is_missing) {
  const test::TempFolder folder;
  const auto refused = [&](const std::vector<std::string>& arguments, int status, const std::string& piece) {
    const Ended ended = run_program(folder.path(), arguments);
    EXPECT_EQ(ended.status, status) << ended.err;
    EXPECT_NE(ended.err.find(piece), std::string::npos) << ended.err;
  };
  refused({"run", "v4l2:"}, 2, "accrete devices");
  refused({"run", "v4l2:left"}, 2, "--layout sbs");
  refused({"run", "v4l2:left,right"}, 2, "--calibration");
  refused({"run", "v4l2:left,right", "--layout", "wide"}, 2, "--layout");
  refused({"run", "v4l2:left,right", "--size", "wide"}, 2, "640x480");
  refused({"run", "v4l2:left,right", "--calibration", "nowhere.yml"}, 4, "nowhere.yml");
  refused({"evaluate", "v4l2:left,right"}, 2, "no truth");
  refused({"run", "libcamera:left,right"}, 2, "--calibration");
  refused({"run", "libcamera:left"}, 2, "libcamera:left,RIGHT");
  refused({"run", "libcamera:left,right", "--control", "ExposureTime"}, 2, "ExposureTime=8000");
  refused({"run", "v4l2:left,right", "--control", "ExposureTime=8000"}, 2, "v4l2-ctl");
}

TEST(live_program, lists_devices_as_json) {
  const test::TempFolder folder;
  const Ended ended = run_program(folder.path(), {"devices", "--json"});
  EXPECT_EQ(ended.status, 0);
  EXPECT_TRUE(json::parse(ended.out)["devices"].is_array());
  EXPECT_EQ(run_program(folder.path(), {"devices"}).status, 0);
}

TEST(devices, are_shown_by_the_name_to_use) {
  hal::V4l2Device wide;
  wide.node = "/dev/video4";
  wide.id = "usb-stereo";
  wide.card = "Stereo";
  wide.likely_layout = hal::StereoLayout::kSideBySide;
  wide.formats = {{"MJPG", "", true, {{2560, 720, 2560, 720, {30, 15}}}},
                  {"H264", "", false, {{2560, 720, 2560, 720, {}}}}};
  hal::V4l2Device busy;
  busy.node = "/dev/video6";
  busy.problem = "Permission denied";
  hal::LibcameraCamera pi{"/base/soc/i2c0mux/i2c@1/imx296@1a",
                          "imx296",
                          {{"R8", true, {"1456x1088", "728x544"}}},
                          {"ExposureTime [29..15534385]"},
                          {}};
  const std::string text = devices_text({{wide, busy}, {pi}});
  EXPECT_NE(text.find("v4l2:usb-stereo --layout sbs"), std::string::npos) << text;
  EXPECT_NE(text.find("MJPG   2560x720 at 30 Hz\n"), std::string::npos) << text;
  EXPECT_NE(text.find("(not understood)"), std::string::npos) << text;
  EXPECT_NE(text.find("/dev/video6  cannot be asked: Permission denied"), std::string::npos) << text;
  const json list = json::parse(devices_json({{wide, busy}, {pi}}))["devices"];
  EXPECT_EQ(list[0]["formats"][0]["sizes"][0]["rates_hz"][1], 15);
  EXPECT_EQ(list[1]["problem"], "Permission denied");
  EXPECT_NE(text.find("use    libcamera:/base/soc/i2c0mux/i2c@1/imx296@1a,"), std::string::npos) << text;
  EXPECT_NE(text.find("R8     1456x1088, 728x544\n"), std::string::npos) << text;
  EXPECT_EQ(list[2]["kind"], "libcamera");
  EXPECT_EQ(list[2]["controls"][0], "ExposureTime [29..15534385]");
  EXPECT_NE(devices_text({}).find("no camera"), std::string::npos);
}

hal::LiveStatistics some_statistics() {
  hal::LiveStatistics s;
  s.state = hal::LiveState::kLost;
  s.left.node = "/dev/video0";
  s.right.node = "/dev/video2";
  s.left.dropped = 3;
  s.right.arrived = 17;
  s.right.rate_hz = 30;
  s.right.locked = {"gain 64"};
  s.delivered = 10;
  s.skew_min_ns = -2'000'000;
  s.skew_max_ns = 4'500'000;
  s.skew_mean_ns = 1.5e6;
  s.loss = "/dev/video2: gone";
  s.reconnects = 1;
  return s;
}

TEST(live_cameras, say_what_happened) {
  const hal::LiveStatistics s = some_statistics();
  std::string all;
  for (const std::string& sentence : sentences(s)) all += sentence + "\n";
  for (const char* piece :
       {"left camera: 0 images, 3 lost", "right camera: fixed: gain 64", "1.50 ms", "1 time it came back"})
    EXPECT_NE(all.find(piece), std::string::npos) << all;
}

TEST(live_cameras, count_what_happened) {
  const auto cameras = statistics_json(some_statistics());
  EXPECT_EQ(cameras["state"], "lost");
  EXPECT_EQ(cameras["left"]["dropped"], 3);
  EXPECT_EQ(cameras["left"]["rate_hz"], nullptr);
  EXPECT_EQ(cameras["left"]["clock"], "unknown");
  EXPECT_EQ(cameras["right"]["arrived"], 17);
  EXPECT_EQ(cameras["right"]["rate_hz"], 30);
  EXPECT_EQ(cameras["right"]["locked"][0], "gain 64");
  EXPECT_EQ(cameras["delivered"], 10);
  EXPECT_EQ(cameras["reconnects"], 1);
  EXPECT_DOUBLE_EQ(cameras["skew_ms"]["min"], -2.0);
  EXPECT_DOUBLE_EQ(cameras["skew_ms"]["mean"], 1.5);
  EXPECT_DOUBLE_EQ(cameras["skew_ms"]["max"], 4.5);
  EXPECT_EQ(cameras["loss"], "/dev/video2: gone");
  hal::LiveStatistics one = some_statistics();  // one device for both eyes, and nothing lost
  one.right = {};
  one.loss.clear();
  EXPECT_FALSE(statistics_json(one).contains("right"));
  EXPECT_EQ(statistics_json(one)["skew_ms"], nullptr);
  EXPECT_EQ(statistics_json(one)["loss"], nullptr);
}

// The synthetic scene as a camera that stalls now and then, is gone for a while, and is lost in the end.
class Stuttering final : public hal::StereoSource {
 public:
  explicit Stuttering(std::unique_ptr<hal::StereoSource> scene) : scene_(std::move(scene)) {}
  bool gone = false;

 private:
  hal::Outcome do_configure() override {
    rig_ = scene_->rig();
    return {};
  }
  hal::Outcome do_start() override { return scene_->start(); }
  hal::Outcome do_acquire(std::int64_t timeout_ns, StereoFrame& frame) override {
    EXPECT_LE(timeout_ns, 1'000'000'000);  // Ctrl-C is heard
    ++calls_;
    gone = calls_ > 10 && calls_ < 100;  // 18 s
    if (gone || calls_ % 3 != 0) return {Status::kTimeout, "nothing came"};
    hal::Outcome o = scene_->acquire(0, frame);
    if (o.status == Status::kEndOfStream) return {Status::kNotFound, "the camera is lost"};
    return o;
  }
  void do_release() override { scene_->release(); }
  void do_stop() override { scene_->stop(); }

  std::unique_ptr<hal::StereoSource> scene_;
  int calls_ = 0;
};

TEST(live_run, goes_on_after_a_stall_and_ends_with_a_loss) {
  RunOptions options;
  options.quiet = true;
  options.scene.frames = 6;
  Input input = open_input(options);
  auto camera = std::make_unique<Stuttering>(std::move(input.source));
  ASSERT_TRUE(camera->configure().ok());
  const Stuttering& its = *camera;
  input.source = std::move(camera);
  input.cameras = LiveCameras{{}, [&its] { return its.gone; }, some_statistics};
  const auto engine = make_engine(input.source->rig(), options.params, options.capacity);
  Progress progress(stderr, 0, true);
  const RunRecord run = accumulate(input, *engine, options, progress);
  EXPECT_EQ(run.count(FrameFate::kUsed), 6U);
  const auto result = json::parse(summary({{}, options, input, *engine, run, {}, 0, ExitStatus::kNothing, 0}).dump());
  EXPECT_EQ(result["cameras"]["right"]["arrived"], 17);
  std::ifstream schema(std::filesystem::path(ACCRETE_SOURCE_FOLDER) / "docs/reference/summary.schema.json");
  for (const std::string& problem : JsonSchema(json::parse(schema)).problems(result)) ADD_FAILURE() << problem;
  ASSERT_GE(run.warnings.size(), 2U);
  EXPECT_EQ(run.warnings[0], "nothing came");  // once
  EXPECT_EQ(run.warnings[1], "stopped at frame 6: the camera is lost");
}

}  // namespace
}  // namespace accrete::cli
