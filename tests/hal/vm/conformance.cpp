// One suite over all back-ends that show the same stereo recording: identical pixels, true pairs, nothing left behind.
// A further back-end is a further line in the list at the end.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "accrete/hal/recording.h"
#include "image/image_file.h"
#include "live.h"
#include "paced_source.h"
#include "resources.h"

namespace accrete::vm {
namespace {

std::filesystem::path recording() { return std::getenv("ACCRETE_RECORDING"); }

std::vector<hal::ImageBuffer> images(const char* eye) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(recording() / eye)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<hal::ImageBuffer> all(files.size());
  hal::ImageReader reader;
  for (std::size_t i = 0; i < files.size(); ++i) {
    hal::ImageHeader header;
    EXPECT_TRUE(reader.open(files[i], header).ok() && reader.decode(all[i]).ok()) << files[i];
  }
  return all;
}

struct Backend {
  const char* name;
  std::function<std::unique_ptr<hal::StereoSource>(std::size_t frames)> open;
  // What value v of a channel becomes on the way.
  std::function<int(int)> value = [](int v) { return v; };
};

std::unique_ptr<hal::StereoSource> replay(std::size_t /*frames*/) {
  std::unique_ptr<hal::StereoSource> source;
  std::unique_ptr<hal::MotionSource> motion;
  hal::RecordingInfo info;
  const hal::Outcome outcome = hal::open_recording(recording(), {}, source, motion, info);
  EXPECT_TRUE(outcome.ok()) << outcome.message;
  return source;
}

Backend live(const char* name, Library library, const char* format) {
  return {name, [library, format](std::size_t frames) -> std::unique_ptr<hal::StereoSource> {
            hal::LiveOptions options;
            options.left = "Software camera 0";
            options.right = "Software camera 1";
            options.format = format;
            options.warm_up_frames = 0;
            options.pair_tolerance_ns = kPacedTolerance_ns;
            std::vector<Timestamp> times(frames);
            for (std::size_t i = 0; i < frames; ++i) times[i] = {static_cast<std::int64_t>(i) * 100 * kMillisecond};
            auto source = std::make_unique<PacedSource>(opened(options, library), times);
            EXPECT_TRUE(source->configure().ok());
            return source;
          }};
}

// The bytes that differ from what the picture should have become.
std::size_t differences(const ImageView& image, const hal::ImageBuffer& picture, const std::function<int(int)>& value) {
  EXPECT_EQ(image.width_px, picture.width_px);
  EXPECT_EQ(image.height_px, picture.height_px);
  if (image.width_px != picture.width_px || image.height_px != picture.height_px) return 1;
  const int in = channels(picture.format), out = channels(image.format);
  std::size_t n = 0;
  for (int y = 0; y < image.height_px; ++y)
    for (int x = 0; x < image.width_px; ++x)
      for (int c = 0; c < out; ++c) {
        const int from = in == 1 ? 0 : image.format == PixelFormat::kBgr8 ? 2 - c : c;
        const std::size_t i = (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width_px) + x) * in + from;
        n += image.row(y)[x * out + c] != value(picture.bytes[i]) ? 1 : 0;
      }
  return n;
}

class Conformance : public LeavesNothing, public testing::WithParamInterface<Backend> {};

TEST_P(Conformance, DeliversEveryPictureOfTheRecordingUnchanged) {
  const std::vector<hal::ImageBuffer> left = images("left"), right = images("right");
  ASSERT_FALSE(left.empty());
  const std::unique_ptr<hal::StereoSource> source = GetParam().open(left.size());
  ASSERT_NE(source, nullptr);
  ASSERT_TRUE(source->start().ok());
  StereoFrame frame;
  std::int64_t last_ns = -1;
  for (std::size_t i = 0; i < left.size(); ++i) {
    const hal::Outcome outcome = source->acquire(kLimit_ns, frame);
    ASSERT_TRUE(outcome.ok()) << outcome.message;
    const int number = static_cast<int>(i);
    EXPECT_EQ(read_number(frame.left), (FrameNumber{number, false}));
    EXPECT_EQ(read_number(frame.right), (FrameNumber{number, true}));
    EXPECT_EQ(frame.sequence, i);
    EXPECT_GT(frame.t_left.ns, last_ns);
    last_ns = frame.t_left.ns;
    EXPECT_EQ(differences(frame.left, left[i], GetParam().value), 0U) << "left, picture " << i;
    EXPECT_EQ(differences(frame.right, right[i], GetParam().value), 0U) << "right, picture " << i;
    source->release();
  }
  EXPECT_EQ(source->acquire(0, frame).status, Status::kEndOfStream);
  source->stop();
}

// What is lent stays as it is, whatever arrives meanwhile; and a source can be stopped with a frame out, and started
// again.
TEST_P(Conformance, AFrameThatIsLentDoesNotChange) {
  const std::vector<hal::ImageBuffer> left = images("left");
  const std::unique_ptr<hal::StereoSource> source = GetParam().open(left.size());
  ASSERT_NE(source, nullptr);
  StereoFrame frame;
  for (int turn = 0; turn < 2; ++turn) {
    ASSERT_TRUE(source->start().ok());
    ASSERT_TRUE(source->acquire(kLimit_ns, frame).ok());
    if (std::string(GetParam().name) != "replay") order("show 2");
    std::this_thread::sleep_for(std::chrono::milliseconds(1400));  // more frames than there are buffers
    EXPECT_EQ(differences(frame.left, left[0], GetParam().value), 0U);
    source->stop();
  }
}

// uvcvideo says limited range, so that luma 16 .. 235 becomes 0 .. 255 (docs/reference/cameras.md).
Backend yuyv(Backend backend) {
  backend.value = [](int v) { return std::clamp(((v - 16) * 255 * 2 + 219) / (2 * 219), 0, 255); };
  return backend;
}

INSTANTIATE_TEST_SUITE_P(Backends, Conformance,
                         testing::Values(Backend{"replay", replay}, live("v4l2_GREY", Library::kV4l2, "GREY"),
                                         yuyv(live("v4l2_YUYV", Library::kV4l2, "YUYV")),
                                         live("v4l2_BGR3", Library::kV4l2, "BGR3"),
                                         live("v4l2_MJPG", Library::kV4l2, "MJPG"),
                                         live("libcamera_R8", Library::kLibcamera, "R8"),
                                         yuyv(live("libcamera_YUYV", Library::kLibcamera, "YUYV")),
                                         live("libcamera_RGB888", Library::kLibcamera, "RGB888"),
                                         live("libcamera_MJPEG", Library::kLibcamera, "MJPEG")),
                         [](const testing::TestParamInfo<Backend>& i) { return std::string(i.param.name); });

}  // namespace
}  // namespace accrete::vm
