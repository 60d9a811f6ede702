// The recorder: what it writes is what came in, on a slow disk, on a full one, and torn anywhere.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include "accrete/hal/synthetic.h"
#include "image/image_file.h"
#include "image/png_encoder.h"
#include "opened.h"
#include "outcome_matchers.h"
#include "record/make_recorder.h"
#include "support/temp_folder.h"
#include "text/file.h"

namespace accrete::hal {
namespace {

namespace fs = std::filesystem;
constexpr std::int64_t kPeriod = 33'000'000;

StereoRig rig() {
  StereoRig r;
  r.left.width_px = r.right.width_px = 8;
  r.left.height_px = r.right.height_px = 6;
  r.left.fx_px = r.left.fy_px = r.right.fx_px = r.right.fy_px = 10;
  r.left.cx_px = r.right.cx_px = 3.5;
  r.left.cy_px = r.right.cy_px = 2.5;
  r.right.distortion = Distortion::kBrownConrady;
  r.right.coefficients = {-0.1, 0.01, 0.001, -0.002, 0.003};
  r.T_r_l.rotation = normalized({0.01, 0.02, -0.005, 1}).value();
  r.T_r_l.translation = {-0.1, 0.001, 0.002};
  return r;
}

// Frame number i, with it in every pixel.
struct Frame {
  std::vector<std::uint8_t> left, right;
  StereoFrame frame;

  explicit Frame(int i, PixelFormat format = PixelFormat::kGrey8) {
    const auto n = static_cast<std::size_t>(8 * 6 * channels(format));
    for (std::size_t k = 0; k < n; ++k) {
      left.push_back(static_cast<std::uint8_t>(3 * k + static_cast<std::size_t>(i)));
      right.push_back(static_cast<std::uint8_t>(5 * k + static_cast<std::size_t>(i) + 1));
    }
    frame.left = {left.data(), 8, 6, 8 * channels(format), format};
    frame.right = {right.data(), 8, 6, 8 * channels(format), format};
    frame.t_left = {1'000'000'000 + i * kPeriod};
    frame.t_right = {1'000'000'100 + i * kPeriod};
  }
};

class LinearMotion final : public MotionSource {
 public:
  explicit LinearMotion(MotionMode mode) : mode_(mode) {}
  Outcome at(Timestamp t, Motion& motion) override {
    if (t.ns == missing_) return {Status::kNotFound, "none"};
    Transform<Left, Object> T;
    T.rotation = normalized({0.1, 0.2, 0.3, 1}).value();
    T.translation = {1e-9 * static_cast<double>(t.ns) / 3, 0.1, 1};
    motion = Motion::object(t, T);
    motion.mode = mode_;
    motion.error = mode_ == MotionMode::kCameraMoves ? PoseError::kIncremental : PoseError::kAbsolute;
    motion.covariance = diagonal_pose_covariance(1e-3, 1e-4);
    return {};
  }
  std::int64_t missing_ = -1;

 private:
  MotionMode mode_;
};

RecorderSettings patient() {
  RecorderSettings s;
  s.wait_when_full = true;
  s.sync_period_ns = 3'600'000'000'000;
  return s;
}

class Recorded : public testing::Test {
 protected:
  void SetUp() override {
    if (!ACCRETE_HAS_YAML || !ACCRETE_HAS_PNG) GTEST_SKIP() << "this build leaves YAML or PNG out";
  }
  // Frames 0 .. n-1 with poses.
  void record(int n, MotionMode mode = MotionMode::kObjectMoves) {
    LinearMotion motion(mode);
    std::unique_ptr<Recorder> recorder;
    ASSERT_TRUE(succeeds(make_recorder(folder_ / "r", rig(), &motion, patient(), recorder)));
    for (int i = 0; i < n; ++i) ASSERT_EQ(recorder->record(Frame(i).frame), Status::kOk);
    ASSERT_TRUE(succeeds(recorder->finish()));
  }
  test::TempFolder folder_;
};

TEST_F(Recorded, PixelsTimesCalibrationAndPosesComeBack) {
  for (const PixelFormat format : {PixelFormat::kGrey8, PixelFormat::kRgb8, PixelFormat::kBgr8})
    for (const MotionMode mode : {MotionMode::kObjectMoves, MotionMode::kCameraMoves}) {
      const fs::path path = folder_ / std::to_string(static_cast<int>(format) * 2 + static_cast<int>(mode));
      LinearMotion given(mode);
      std::unique_ptr<Recorder> recorder;
      ASSERT_TRUE(succeeds(make_recorder(path, rig(), &given, patient(), recorder)));
      for (int i = 0; i < 4; ++i) EXPECT_EQ(recorder->record(Frame(i, format).frame), Status::kOk);
      ASSERT_TRUE(succeeds(recorder->finish()));
      EXPECT_EQ(recorder->counters().written, 4U);

      Opened r(path);
      ASSERT_TRUE(succeeds(r.outcome));
      EXPECT_TRUE(r.info.warnings.empty()) << r.info.warnings.front();
      EXPECT_EQ(r.info.kind, RecordingKind::kEuroc);
      EXPECT_EQ(r.info.frames_with_pose, 4U);
      const StereoRig& back = r.source->rig();
      EXPECT_EQ(back.left.distortion, Distortion::kNone);
      EXPECT_EQ(back.right.coefficients, rig().right.coefficients);
      EXPECT_NEAR(norm(back.T_r_l.translation - rig().T_r_l.translation), 0, 1e-15);
      EXPECT_NEAR(back.T_r_l.rotation.y, rig().T_r_l.rotation.y, 1e-15);
      ASSERT_TRUE(r.source->start().ok());
      for (int i = 0; i < 4; ++i) {
        const Frame sent(i, format);
        StereoFrame frame;
        ASSERT_TRUE(succeeds(r.source->acquire(0, frame)));
        EXPECT_EQ(frame.t_left, sent.frame.t_left);
        EXPECT_EQ(frame.t_right, sent.frame.t_right);
        const int c = channels(format);
        for (int k = 0; k < 8 * 6 * c; ++k) {
          const int stored = format == PixelFormat::kBgr8 ? k - k % 3 + 2 - k % 3 : k;
          ASSERT_EQ(frame.right.data[k], sent.right[static_cast<std::size_t>(stored)]);
        }
        Motion was, is;
        ASSERT_TRUE(given.at(frame.t_left, was).ok() && succeeds(r.motion->at(frame.t_left, is)));
        EXPECT_EQ(is.mode, mode);
        EXPECT_EQ(is.error, was.error);
        EXPECT_FALSE(is.covariance_is_default);
        EXPECT_EQ(is.covariance, was.covariance);
        EXPECT_NEAR(norm(is.T_l_m.translation - was.T_l_m.translation), 0, 1e-14);
        r.source->release();
      }
    }
}

TEST_F(Recorded, AFrameWithoutAPoseIsNotLost) {
  LinearMotion motion(MotionMode::kObjectMoves);
  motion.missing_ = Frame(2).frame.t_left.ns;
  std::unique_ptr<Recorder> recorder;
  ASSERT_TRUE(succeeds(make_recorder(folder_ / "r", rig(), &motion, patient(), recorder)));
  for (int i = 0; i < 5; ++i) EXPECT_EQ(recorder->record(Frame(i).frame), Status::kOk);
  ASSERT_TRUE(succeeds(recorder->finish()));
  EXPECT_EQ(recorder->counters().without_pose, 1U);
  Opened r(folder_ / "r");
  ASSERT_TRUE(succeeds(r.outcome));
  EXPECT_EQ(r.info.frames, 5U);
  EXPECT_EQ(r.info.frames_with_pose, 4U);
}

TEST_F(Recorded, RefusesTimesThatDoNotIncreaseAndASecondRecording) {
  std::unique_ptr<Recorder> recorder;
  ASSERT_TRUE(succeeds(make_recorder(folder_ / "r", rig(), nullptr, patient(), recorder)));
  EXPECT_EQ(recorder->record(Frame(1).frame), Status::kOk);
  EXPECT_EQ(recorder->record(Frame(1).frame), Status::kInvalidArgument);
  EXPECT_EQ(recorder->record(Frame(0).frame), Status::kInvalidArgument);
  EXPECT_EQ(recorder->record({}), Status::kInvalidArgument);
  ASSERT_TRUE(succeeds(recorder->finish()));
  EXPECT_EQ(recorder->record(Frame(9).frame), Status::kUnavailable);
  EXPECT_EQ(recorder->counters().refused, 3U);
  EXPECT_TRUE(fails(make_recorder(folder_ / "r", rig(), nullptr, patient(), recorder), Status::kUnavailable,
                    {"there already", "another folder"}));
}

// Whatever piece of the last row of whatever list is missing, or zeros in its place.
TEST_F(Recorded, EveryTornEndReplaysToTheFrameBefore) {
  record(3);
  const fs::path mav = folder_ / "r/mav0";
  for (const char* list : {"cam0", "cam1", "object0"}) {
    const fs::path file = mav / list / "data.csv";
    std::string whole;
    ASSERT_TRUE(read_text(file, whole).ok());
    const std::size_t last = whole.rfind('\n', whole.size() - 2) + 1;
    for (std::size_t cut = last; cut < whole.size(); ++cut)
      for (const std::string& tail : {std::string(), std::string(30, '\0')}) {
        std::ofstream(file, std::ios::binary) << whole.substr(0, cut) << tail;
        Opened r(folder_ / "r");
        ASSERT_TRUE(succeeds(r.outcome)) << list << " cut at " << cut - last;
        // A row without its end is whole; so is one whose name is missing: then it is the time.
        const std::string row = whole.substr(last, cut - last);
        const bool complete = tail.empty() && (cut == whole.size() - 1 || row.size() == 10 || row.size() == 11);
        const std::size_t expected = complete || std::string(list) == "object0" ? 3U : 2U;
        EXPECT_EQ(r.info.frames, expected) << list << " cut at " << cut - last;
        const Played played(*r.source);
        EXPECT_TRUE(played.losses.empty());
        EXPECT_GE(r.info.frames_with_pose, 2U);
      }
    std::ofstream(file, std::ios::binary) << whole;
  }
}

// A disk in the way of the real one.
class OddDisk final : public Disk {
 public:
  Outcome make_folder(const fs::path& folder) override { return disk_->make_folder(folder); }
  Outcome write_whole(const fs::path& file, std::span<const std::uint8_t> bytes) override {
    std::this_thread::sleep_for(delay);
    return full() ? no_space(file) : disk_->write_whole(file, bytes);
  }
  Outcome append(const fs::path& file, std::string_view text) override {
    return full() ? no_space(file) : disk_->append(file, text);
  }
  Outcome sync(const fs::path& folder) override { return full() ? no_space(folder) : Outcome{}; }

  std::chrono::milliseconds delay{0};
  int operations_left = 1 << 30;

 private:
  bool full() { return operations_left-- <= 0; }
  static Outcome no_space(const fs::path& path) {
    return {Status::kUnavailable, path.string() + " cannot be written: No space left on device"};
  }
  std::unique_ptr<Disk> disk_ = make_disk();
};

TEST_F(Recorded, ASlowDiskDropsAndCountsAndHoldsNoMore) {
  auto disk = std::make_unique<OddDisk>();
  disk->delay = std::chrono::milliseconds(20);
  RecorderSettings settings;
  settings.buffer_bytes = std::size_t{4} * 2 * 8 * 6;  // four pairs
  std::unique_ptr<Recorder> recorder;
  ASSERT_TRUE(succeeds(make_recorder(std::move(disk), folder_ / "r", rig(), nullptr, settings, recorder)));
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 300; ++i) {
    const Status status = recorder->record(Frame(i).frame);
    EXPECT_TRUE(status == Status::kOk || status == Status::kCapacityExceeded);
    if (i % 10 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  // Capture never waits for the disk, which needs 40 ms a frame: 12 s in all.
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(6));
  ASSERT_TRUE(succeeds(recorder->finish()));
  const RecorderCounters c = recorder->counters();
  EXPECT_EQ(c.offered, 300U);
  EXPECT_GT(c.dropped, 50U);
  EXPECT_EQ(c.written + c.dropped, 300U);
  EXPECT_EQ(c.capacity, 4U);
  EXPECT_EQ(c.most_waiting, 4U);
  RecordingOptions no_poses;
  no_poses.ignore_poses = true;
  Opened r(folder_ / "r", no_poses);
  ASSERT_TRUE(succeeds(r.outcome));
  EXPECT_EQ(r.info.frames, c.written);
}

// After any number of operations on the disk: a clear sentence, and what was complete replays.
TEST_F(Recorded, AFullDiskAtAnyMomentLeavesWhatWasComplete) {
  RecordingOptions options;
  options.require_poses = false;
  for (int operations = 0; operations < 40; ++operations) {
    auto disk = std::make_unique<OddDisk>();
    disk->operations_left = operations;
    const fs::path path = folder_ / std::to_string(operations);
    LinearMotion motion(MotionMode::kObjectMoves);
    std::unique_ptr<Recorder> recorder;
    const Outcome made = make_recorder(std::move(disk), path, rig(), &motion, patient(), recorder);
    if (!made.ok()) {
      EXPECT_TRUE(fails(made, Status::kUnavailable, {"No space left"}));
      continue;
    }
    int taken = 0;
    while (taken < 8 && recorder->record(Frame(taken).frame) == Status::kOk) ++taken;
    const Outcome ended = recorder->finish();
    EXPECT_TRUE(fails(ended, Status::kUnavailable, {"No space left", "can be replayed"})) << operations;
    const std::uint64_t written = recorder->counters().written;
    Opened r(path, options);
    if (written == 0) {
      EXPECT_FALSE(r.outcome.ok());
      continue;
    }
    ASSERT_TRUE(succeeds(r.outcome)) << operations;
    EXPECT_EQ(r.info.frames, written);
    EXPECT_EQ(r.info.frames_with_pose, written);
    EXPECT_EQ(Played(*r.source).sequences.size(), written);
  }
}

// The real disk in a process whose files may not grow beyond a limit: the list is cut back to whole rows.
TEST_F(Recorded, AListThatCannotGrowKeepsWholeRows) {
  const fs::path file = folder_ / "list";
  const pid_t child = ::fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{25, 25};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    const auto disk = make_disk();
    const bool first = disk->append(file, "0123456789\n").ok(), second = disk->append(file, "0123456789\n").ok();
    const Outcome third = disk->append(file, "0123456789\n");
    const std::vector<std::uint8_t> image(100);
    const Outcome whole = disk->write_whole(file.parent_path() / "image", image);
    ::_exit(first && second && third.status == Status::kUnavailable && whole.status == Status::kUnavailable ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(fs::file_size(file), 22U);
  std::size_t others = 0;
  for (const auto& entry : fs::directory_iterator(folder_.path())) others += entry.path() != file ? 1 : 0;
  EXPECT_EQ(others, 0U) << "a half image was left";
}

TEST(PngEncoder, KeepsStridedRows) {
  if (!ACCRETE_HAS_PNG) GTEST_SKIP() << "this build leaves PNG out";
  std::vector<std::uint8_t> pixels(10 * 3, 0);
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<std::uint8_t>(7 * i);
  std::vector<std::uint8_t> file;
  std::string reason;
  ASSERT_TRUE(encode_png({pixels.data(), 4, 3, 10, PixelFormat::kGrey8}, file, reason)) << reason;
  ImageHeader header;
  ASSERT_TRUE(read_png_header(file, header, reason));
  std::vector<std::uint8_t> back(12);
  ASSERT_TRUE(decode_png(file, header, back.data(), reason));
  for (std::size_t y = 0; y < 3; ++y)
    for (std::size_t x = 0; x < 4; ++x) EXPECT_EQ(back[4 * y + x], pixels[10 * y + x]);
}

}  // namespace
}  // namespace accrete::hal
