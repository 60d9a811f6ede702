#include "cli/record/record_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>

#include "accrete/hal/recorder.h"
#include "cli/run/input.h"
#include "cli/run/interrupt.h"
#include "cli/text/print.h"

namespace accrete::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::int64_t kAcquireTimeoutNs = 500'000'000;  // so that Ctrl-C is seen while a camera is silent
constexpr int kSilentTimeouts = 10;                      // 5 s without a frame: the camera is gone, or stands still
constexpr std::uint64_t kSpelledOut = 5;                 // warnings of one kind; the rest is counted

void warn(const std::string& sentence) { print_error("warning: {}\n", sentence); }

class Recording {
 public:
  Recording(const RecordOptions& options, Input& input, hal::Recorder& recorder)
      : options_(options), input_(input), recorder_(recorder) {}

  // Frames from the source to the recorder until one of them ends, or the user ends it.
  void run() {
    if (const hal::Outcome started = input_.source->start(); !started.ok())
      throw Failure(ExitStatus::kInput, started.message);
    while (!(interrupted_ = interrupted()) && in_time() && next()) say_progress();
    input_.source->stop();
  }

  [[nodiscard]] bool was_interrupted() const { return interrupted_; }
  // Frames that the source lost or could not read, and whether it broke off.
  [[nodiscard]] std::uint64_t unreadable() const { return unreadable_; }
  [[nodiscard]] bool broken() const { return broken_; }

 private:
  bool next() {
    StereoFrame frame;
    const hal::Outcome acquired = input_.source->acquire(kAcquireTimeoutNs, frame);
    if (acquired.status == Status::kDataLoss) {
      if (++unreadable_ <= kSpelledOut) warn(acquired.message);
      return true;
    }
    const bool looking = input_.cameras && input_.cameras->reconnecting();  // it says itself when it gives up
    if (acquired.status == Status::kTimeout && (looking || ++silent_ < kSilentTimeouts)) return true;
    if (!acquired.ok()) {
      broken_ = acquired.status != Status::kEndOfStream;
      if (broken_) warn("the source ended: " + acquired.message);
      return false;
    }
    silent_ = 0;
    const bool go_on = frame.sequence <= options_.run.frames.last;
    Status taken = Status::kOk;
    if (options_.run.frames.contains(frame.sequence)) taken = recorder_.record(frame);
    input_.source->release();
    return go_on && taken != Status::kUnavailable;  // then finish() says why
  }

  [[nodiscard]] bool in_time() const {
    return options_.duration_ns == 0 || Clock::now() - begin_ < std::chrono::nanoseconds(options_.duration_ns);
  }

  void say_progress() {
    if (options_.quiet || Clock::now() - said_ < std::chrono::seconds(1)) return;
    said_ = Clock::now();
    const hal::RecorderCounters c = recorder_.counters();
    print_error("recorded {} frames, {:.1f} MB, dropped {}\n", c.written, 1e-6 * static_cast<double>(c.bytes),
                c.dropped);
  }

  const RecordOptions& options_;
  Input& input_;
  hal::Recorder& recorder_;
  const Clock::time_point begin_ = Clock::now();
  Clock::time_point said_ = begin_;
  std::uint64_t unreadable_ = 0;
  int silent_ = 0;
  bool interrupted_ = false, broken_ = false;
};

void print_result(const hal::RecorderCounters& c, const RecordOptions& options, const Input& input) {
  print("recorded     {} frames, {:.1f} MB, in {}/mav0\n", c.written, 1e-6 * static_cast<double>(c.bytes),
        options.folder.string());
  if (c.capacity > 0) print("buffer       {} of {} pairs were used at most\n", c.most_waiting, c.capacity);
  if (input.motion) print("poses        {} of {} frames\n", c.written - c.without_pose, c.written);
  print("replay       accrete run {}\n", options.folder.string());
}

}  // namespace

void RecordFlags::add(CLI::App& app) {
  const char* group = "How to record";
  const auto option = [&app, group](const char* name, auto& value, const char* kind, const char* help) {
    return app.add_option(name, value, help)->option_text(kind)->group(group);
  };
  option("-o,--out", plain_.folder, "FOLDER", "Where to; must not hold a recording yet")->required();
  option("--buffer", plain_.buffer_mb, "MB", "Images that wait for a slow disk, in memory (default 128)")
      ->check(CLI::Range(1, 1000000));
  option("--sync", sync_, "TIME",
         "How much a power failure may cost (default 1s; 0s: nothing, slower); a killed\nprogram costs nothing");
  option("--duration", duration_, "TIME", "Stop after this time (default: at the end, or with Ctrl-C)");
  app.add_flag("-q,--quiet", plain_.quiet, "Print warnings and errors only")->group(group);
}

RecordOptions RecordFlags::options(const RunOptions& run) const {
  RecordOptions o = plain_;
  o.run = run;
  if (!sync_.empty()) o.sync_period_ns = parse_duration_ns("--sync", sync_);
  if (!duration_.empty()) o.duration_ns = parse_duration_ns("--duration", duration_);
  return o;
}

ExitStatus record_command(const RecordOptions& given) {
  RecordOptions options = given;
  options.run.input.require_poses = !options.run.input.poses.empty();  // images without poses are worth keeping
  Input input = open_input(options.run);
  if (!options.quiet)
    for (const std::string& line : describe(input)) print("{}\n", line);
  flush_output();
  for (const std::string& warning : input.warnings) warn(warning);

  hal::RecorderSettings settings;
  settings.buffer_bytes = static_cast<std::size_t>(options.buffer_mb) << 20;
  settings.wait_when_full = !input.live;
  settings.sync_period_ns = options.sync_period_ns;
  settings.pose_wait_ns = options.run.pose_wait_ns;
  std::unique_ptr<hal::Recorder> recorder;
  if (const hal::Outcome made =
          hal::make_recorder(options.folder, input.source->rig(), input.motion.get(), settings, recorder);
      !made.ok())
    throw Failure(ExitStatus::kOutput, made.message);

  Recording recording(options, input, *recorder);
  recording.run();
  const hal::Outcome ended = recorder->finish();
  const hal::RecorderCounters c = recorder->counters();
  if (!options.quiet && c.written > 0) print_result(c, options, input);
  if (input.live_poses != nullptr)
    if (const hal::LiveMotionCounters p = input.live_poses->counters(); !options.quiet || c.without_pose > 0)
      print_error("{}: {}\n", input.live_poses->name(), live_poses_sentence(p));
  if (c.dropped > 0)
    warn(fmt::format(
        "{} frames of {} were dropped: the disk is too slow; record to a faster one, smaller or grey images, "
        "fewer a second, or bridge short stops with a larger --buffer",
        c.dropped, c.offered));
  if (c.refused > 0)
    warn(fmt::format("{} frames were refused: their times do not lie after those of the frames before", c.refused));
  if (recording.unreadable() > kSpelledOut)
    warn(fmt::format("{} frames in all were not readable", recording.unreadable()));
  if (!ended.ok()) throw Failure(ExitStatus::kOutput, ended.message);
  if (c.written == 0) {
    std::error_code ignored;  // it was made here and holds no frame; left behind it would refuse the next attempt
    std::filesystem::remove_all(options.folder / "mav0", ignored);
    throw Failure(ExitStatus::kNothing, "nothing was recorded: the source gave no frame");
  }
  if (recording.was_interrupted() && !input.live) return ExitStatus::kInterrupted;  // a camera ends in no other way
  return c.dropped + c.refused + recording.unreadable() > 0 || recording.broken() ? ExitStatus::kPartial
                                                                                  : ExitStatus::kOk;
}

}  // namespace accrete::cli
