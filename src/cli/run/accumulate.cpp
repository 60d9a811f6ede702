#include "cli/run/accumulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <thread>

#include "accrete/hal/second_thread.h"
#include "cli/failure.h"
#include "cli/run/interrupt.h"
#include "cli/run/stage_clock.h"

namespace accrete::cli {
namespace {

constexpr std::int64_t kAcquireTimeoutNs = 5'000'000'000;  // far beyond any frame period: a file system that hangs
// Of a camera in pieces, so that Ctrl-C is heard while nothing comes; a stall is given up after all of it.
constexpr std::int64_t kLiveTimeoutNs = 200'000'000, kLivePatienceNs = 10'000'000'000;
constexpr std::size_t kSpelledOut = 5;  // frames of one fate whose reason is printed; the rest is counted

class Loop {
 public:
  Loop(Input& input, Engine& engine, const RunOptions& options, Progress& progress, const LoopHooks& hooks)
      : input_(input), engine_(engine), options_(options), progress_(progress), hooks_(hooks) {
    run_.recording_frames = input.source->size();
    engine_.set_observer(clock_.observer());
    if (options.threads == 2 || (options.threads == 0 && std::thread::hardware_concurrency() > 1)) lend_thread();
  }
  ~Loop() {
    engine_.set_observer({});
    engine_.set_pair_runner({});
  }
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  RunRecord run() {
    if (const hal::Outcome started = input_.source->start(); !started.ok())
      throw Failure(ExitStatus::kInput, started.message);
    while (!(run_.interrupted = interrupted()) && next()) {
    }
    progress_.finish();
    if (input_.cameras) run_.cameras = input_.cameras->statistics();
    input_.source->stop();
    if (run_.cameras)
      for (const std::string& sentence : sentences(*run_.cameras)) note(sentence);
    conclude();
    return std::move(run_);
  }

 private:
  void lend_thread() {
    engine_.set_pair_runner(second_thread_.emplace().runner());
    if (second_thread_->available())
      run_.threads = 2;
    else if (options_.threads == 2)
      warn("--threads 2: the system has no second thread to give; one does it all");
  }

  // Handles one frame; false at the end.
  bool next() {
    const auto begin = StageClock::Clock::now();
    StereoFrame frame;
    const hal::Outcome acquired = acquire(frame);
    FrameRecord record;
    record.read_ms = StageClock::milliseconds(StageClock::Clock::now() - begin);
    record.number = next_number_;
    if (acquired.status == Status::kDataLoss) {  // one damaged frame: the source goes on with the frame after it
      ++next_number_;
      if (options_.frames.contains(record.number))
        lose(record, FrameFate::kUnreadable, acquired.message);  // names the frame
      return true;
    }
    if (!acquired.ok()) {
      const bool told_to_stop = acquired.status == Status::kTimeout && (run_.interrupted = interrupted());
      if (acquired.status != Status::kEndOfStream && !told_to_stop)
        warn(fmt::format("stopped at frame {}: {}", next_number_, acquired.message));
      return false;
    }
    record.number = frame.sequence;
    next_number_ = frame.sequence + 1;
    const bool go_on = record.number <= options_.frames.last;
    if (go_on && options_.frames.contains(record.number)) use(frame, record);
    input_.source->release();
    return go_on;
  }

  // A camera that is gone is waited for as long as the source looks for it.
  hal::Outcome acquire(StereoFrame& frame) {
    if (!input_.cameras) return input_.source->acquire(kAcquireTimeoutNs, frame);
    bool said = false;
    for (std::int64_t waited_ns = 0;;) {
      hal::Outcome outcome = input_.source->acquire(kLiveTimeoutNs, frame);
      if (outcome.status != Status::kTimeout || interrupted()) return outcome;
      if (input_.cameras->reconnecting()) {
        if (!said) warn(outcome.message);
        said = true;
      } else if ((waited_ns += kLiveTimeoutNs) >= kLivePatienceNs) {
        return outcome;
      }
    }
  }

  void use(const StereoFrame& frame, FrameRecord& record) {
    record.t_ns = frame.t_left.ns;
    Motion motion;
    if (const hal::Outcome posed = input_.motion->at(frame.t_left, motion); !posed.ok())
      return lose(record, FrameFate::kNoPose, fmt::format("frame {} is left out: {}", record.number, posed.message));
    const FrameContext context{record.number, frame, motion, engine_, run_};
    if (hooks_.hold_out && hooks_.hold_out(record.number)) {
      record.fate = FrameFate::kHeldOut;
      run_.frames.push_back(record);
      if (hooks_.held_out) hooks_.held_out(context);
      return;
    }
    if (first_ && hooks_.first) hooks_.first(frame.t_left);
    first_ = false;
    clock_.reset();
    const auto begin = StageClock::Clock::now();
    record.report = engine_.step(frame, motion);
    record.step_ms = StageClock::milliseconds(StageClock::Clock::now() - begin);
    record.stage_ms = clock_.times_ms();
    if (record.report.status != Status::kOk)
      return lose(record,
                  record.report.status == Status::kInvalidArgument && other_size(frame) ? FrameFate::kUnreadable
                                                                                        : FrameFate::kRefused,
                  fmt::format("frame {} is left out: {}", record.number, reason(frame, record.report.status)));
    run_.motion_covariance_is_default |= record.report.motion_covariance_is_default;
    run_.resumed = run_.resumed || (run_.used.empty() && record.report.frame > 0);
    // A resumed model's count is its own, and a number out of a file: no table of that length.
    while (!run_.resumed && run_.used.size() <= record.report.frame) run_.used.push_back(record.number);
    run_.frames.push_back(record);
    progress_.update(record, run_);
    if (hooks_.accumulated) hooks_.accumulated(context);
  }

  [[nodiscard]] bool other_size(const StereoFrame& frame) const {
    const StereoRig& rig = input_.source->rig();
    return frame.left.width_px != rig.left.width_px || frame.left.height_px != rig.left.height_px ||
           frame.right.width_px != rig.right.width_px || frame.right.height_px != rig.right.height_px;
  }

  [[nodiscard]] std::string reason(const StereoFrame& frame, Status status) const {
    const StereoRig& rig = input_.source->rig();
    if (other_size(frame))
      return fmt::format("the images have {} x {} and {} x {} pixels, the calibration says {} x {} and {} x {}",
                         frame.left.width_px, frame.left.height_px, frame.right.width_px, frame.right.height_px,
                         rig.left.width_px, rig.left.height_px, rig.right.width_px, rig.right.height_px);
    return fmt::format("the accumulator refuses it: {} (is its time later than the previous frame's, its pose finite?)",
                       to_string(status));
  }

  void lose(FrameRecord& record, FrameFate fate, const std::string& why) {
    record.fate = fate;
    run_.frames.push_back(record);
    if (run_.count(fate) <= kSpelledOut) warn(why);
    progress_.update(record, run_);
  }

  void warn(const std::string& sentence) {
    run_.warnings.push_back(sentence);
    progress_.say("warning: " + sentence);
  }

  // Worth knowing, but no warning: nothing may be wrong.
  void note(const std::string& sentence) {
    if (!options_.quiet) progress_.say(sentence);
  }

  // What is only known at the end.
  void conclude() {
    for (const FrameFate fate : {FrameFate::kUnreadable, FrameFate::kNoPose, FrameFate::kRefused})
      if (const std::size_t n = run_.count(fate); n > kSpelledOut)
        warn(fmt::format("{} frames {} in all", n, fate == FrameFate::kNoPose ? "without a pose" : to_string(fate)));
    std::uint64_t evicted = 0, refused = 0;
    for (const FrameRecord& f : run_.frames) {
      evicted += f.report.evicted + f.report.birth_refused_capacity;
      refused += f.report.left.refused_capacity + f.report.right.refused_capacity;
    }
    if (evicted > 0)
      warn(
          fmt::format("the store of {} primitives was full: {} were given up or not taken, the least probable ones; "
                      "--capacity large holds more",
                      engine_.max_primitives(), evicted));
    if (refused > 0) warn(fmt::format("{} 2D-primitives beyond the capacity were left out, the weakest ones", refused));
    if (run_.motion_covariance_is_default)
      run_.warnings.push_back("the poses state no uncertainty and count as exact; --pose-sigma states one");
  }

  Input& input_;
  Engine& engine_;
  const RunOptions& options_;
  Progress& progress_;
  const LoopHooks& hooks_;
  StageClock clock_;
  std::optional<hal::SecondThread> second_thread_;
  bool first_ = true;
  RunRecord run_;
  std::uint64_t next_number_ = 0;
};

}  // namespace

RunRecord accumulate(Input& input, Engine& engine, const RunOptions& options, Progress& progress,
                     const LoopHooks& hooks) {
  return Loop(input, engine, options, progress, hooks).run();
}

std::uint64_t expected_frames(const Input& input, const RunOptions& options) {
  const std::uint64_t size = input.source->size();
  if (size == 0 || options.frames.first >= size) return 0;
  return std::min(options.frames.last, size - 1) - options.frames.first + 1;
}

}  // namespace accrete::cli
