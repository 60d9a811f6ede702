#include "accrete/hal/live_motion.h"

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "motion/line_input.h"
#include "motion/live_poses.h"

namespace accrete::hal {
namespace {

using Clock = std::chrono::steady_clock;

class LineMotion final : public LiveMotion {
 public:
  LineMotion(std::unique_ptr<LineInput> input, const LiveMotionOptions& options)
      : input_(std::move(input)),
        wait_ns_(options.wait_ns),
        poses_(options, input_->name()),
        thread_([this] { read(); }) {}
  ~LineMotion() override {
    input_->stop();
    thread_.join();
  }
  LineMotion(const LineMotion&) = delete;
  LineMotion& operator=(const LineMotion&) = delete;

  Outcome at(Timestamp t, Motion& motion) override { return at_within(wait_ns_, t, motion); }

  Outcome at_within(std::int64_t wait_ns, Timestamp t, Motion& motion) override {
    const auto wait = std::chrono::nanoseconds(wait_ns);
    const Clock::time_point latest = Clock::now() + wait;
    std::unique_lock lock(mutex_);
    while (!ended_ && poses_.may_come(t)) {
      const Clock::time_point until = std::min(latest, last_line_ + wait);
      if (arrived_.wait_until(lock, until) == std::cv_status::timeout &&
          Clock::now() >= std::min(latest, last_line_ + wait))
        break;
    }
    return poses_.at(t, motion);
  }

  [[nodiscard]] LiveMotionCounters counters() const override {
    const std::scoped_lock lock(mutex_);
    return poses_.counters();
  }
  [[nodiscard]] std::string name() const override { return input_->name(); }
  [[nodiscard]] int port() const override { return input_->port(); }

 private:
  void read() {
    const auto locked = [this](auto&& change) {
      {
        const std::scoped_lock lock(mutex_);
        change();
      }
      arrived_.notify_all();
    };
    input_->run({[&](std::string_view line) {
                   locked([&] {
                     poses_.line(line);
                     last_line_ = Clock::now();
                   });
                 },
                 [&] { locked([&] { poses_.interrupted(); }); }, [&] { locked([&] { ended_ = true; }); }});
  }

  std::unique_ptr<LineInput> input_;
  std::int64_t wait_ns_;
  mutable std::mutex mutex_;
  std::condition_variable arrived_;
  LivePoses poses_;                             // under the mutex
  bool ended_ = false;                          // under the mutex
  Clock::time_point last_line_ = Clock::now();  // under the mutex; at first the opening
  std::thread thread_;                          // last: it uses all of the above
};

Outcome check(const LiveMotionOptions& o) {
  constexpr std::int64_t kHour_ns = 3'600'000'000'000;
  const auto bad = [](const char* what) -> Outcome {
    return {Status::kInvalidArgument, std::string("live poses: ") + what};
  };
  if (o.wait_ns < 0 || o.wait_ns > kHour_ns)
    return bad("the time that a frame waits must lie in 0 .. 1 h (--pose-wait)");
  if (o.max_gap_ns < 0) return bad("the longest gap must be zero or more (--max-pose-gap)");
  if (o.capacity < 2 || o.capacity > 1'000'000) return bad("the capacity must lie in 2 .. 1000000 poses");
  for (const auto& sigma : {o.sigma_m, o.sigma_rad})
    if (sigma && !(*sigma >= 0 && std::isfinite(*sigma))) return bad("a standard deviation must be zero or more");
  if ((o.sigma_m.value_or(0) > 0) != (o.sigma_rad.value_or(0) > 0))
    return bad("give the deviations of position and rotation both, or zero for both (--pose-sigma)");
  return {};
}

}  // namespace

bool is_live_motion(std::string_view where) {
  return where == "-" || where.starts_with("fifo:") || where.starts_with("udp:");
}

Outcome open_live_motion(const std::string& where, const LiveMotionOptions& options,
                         std::unique_ptr<LiveMotion>& motion) {
  motion.reset();
  if (Outcome o = check(options); !o.ok()) return o;
  auto input = std::make_unique<LineInput>();
  if (Outcome o = input->open(where); !o.ok()) return o;
  motion = std::make_unique<LineMotion>(std::move(input), options);
  return {};
}

}  // namespace accrete::hal
