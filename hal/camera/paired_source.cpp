// From options to a running stream, and back to it when a camera was lost.
#include "camera/paired_source.h"

#include <algorithm>

#include "camera/options.h"
#include "camera/span_text.h"
#include "text/sentence.h"

namespace accrete::hal::camera {
namespace {

constexpr std::int64_t kMaxTolerance_ns = 8'000'000;  // as EuRoC's pairs: a quarter of a period at 30 Hz
// How often a lost camera is looked for: udev needs about that long to make its links.
constexpr std::int64_t kRetry_ns = 500'000'000;

}  // namespace

PairedSource::PairedSource(LiveOptions options) : options_(std::move(options)), pairer_(kMaxTolerance_ns, 1) {}

std::int64_t PairedSource::period_ns() const {
  const double rate = std::max(rate_hz(Eye::kLeft), two() ? rate_hz(Eye::kRight) : 0);
  return rate > 0 ? static_cast<std::int64_t>(1e9 / rate) : 0;
}

LiveStatistics PairedSource::statistics() const {
  LiveStatistics s = statistics_;
  s.left = device(Eye::kLeft);
  if (two()) s.right = device(Eye::kRight);
  if (s.delivered > 0) s.skew_mean_ns = skew_sum_ns_ / static_cast<double>(s.delivered);
  return s;
}

// What belongs to a stream, not to the device.
void PairedSource::reset_statistics() {
  statistics_ = {};
  skew_sum_ns_ = 0;
  for (const Eye eye : eyes_of(options_.layout)) {
    LiveDeviceStatistics& s = device(eye);
    s.clock = LiveClock::kUnknown;
    s.arrived = s.dropped = s.damaged = s.unpaired = 0;
    s.locked.clear();
  }
  counters_ = {};
}

Outcome PairedSource::do_configure() {
  if (Outcome o = check_options(options_); !o.ok()) return o;
  if (Outcome o = read_calibration(options_, rig_, eye_); !o.ok()) return o;
  Outcome o = configure_devices();
  if (o.ok()) o = settle_size();
  if (!o.ok()) close_all();
  return o;
}

Outcome PairedSource::settle_size() {
  for (const Eye which : eyes_of(options_.layout)) {
    const Size buffer = negotiated_size(which);
    Size eye;
    if (!eye_size(options_.layout, buffer, eye))
      return {Status::kUnsupported, who(which) + " delivers " + size_text(buffer.width_px, buffer.height_px) +
                                        ", which the layout " + to_string(options_.layout) + " cannot divide"};
    if (eye_.width_px == 0) eye_ = eye;
    if (eye.width_px != eye_.width_px || eye.height_px != eye_.height_px)
      return {Status::kUnsupported, who(which) + " delivers " + size_text(eye.width_px, eye.height_px) +
                                        " an eye instead of " + size_text(eye_.width_px, eye_.height_px) +
                                        ": give the size"};
  }
  if (eye_.width_px > kMaxImageSide_px || eye_.height_px > kMaxImageSide_px)
    return {Status::kCapacityExceeded, "an eye of " + size_text(eye_.width_px, eye_.height_px) + " pixels: at most " +
                                           size_text(kMaxImageSide_px, kMaxImageSide_px) + " are possible"};
  if (!options_.calibration.empty() && rig_.left.width_px == 0)
    for (Camera* camera : {&rig_.left, &rig_.right}) {
      camera->width_px = eye_.width_px;
      camera->height_px = eye_.height_px;
    }
  return {};
}

void PairedSource::streams_started() {
  const double half_period = 0.5 * static_cast<double>(period_ns() > 0 ? period_ns() : 2 * kMaxTolerance_ns);
  statistics_.pair_tolerance_ns = options_.pair_tolerance_ns > 0
                                      ? options_.pair_tolerance_ns
                                      : static_cast<std::int64_t>(std::min(half_period, 1.0 * kMaxTolerance_ns));
  pairer_ = Pairer(statistics_.pair_tolerance_ns, fewest_buffers() - 2);  // the driver always has two to fill
  singles_.clear();
  held_.reset();
}

Outcome PairedSource::do_start() {
  reset_statistics();
  forget_exposure();
  outage_ = gap_ = false;
  interruptions_ = 0;
  base_.reset();
  if (Outcome o = start_streams(); !o.ok()) return o;
  streams_started();
  statistics_.state = options_.warm_up_frames > 0 ? LiveState::kWarmingUp : LiveState::kStreaming;
  if (options_.lock_exposure && options_.warm_up_frames == 0) lock_exposure();
  return {};
}

void PairedSource::do_release() {
  if (held_) give_back(*held_);
  held_.reset();
}

void PairedSource::do_stop() {
  stop_streams();
  pairer_.clear();
  singles_.clear();
  held_.reset();
  statistics_.state = LiveState::kStopped;
}

// On both sides: buffers of a stream that has ended are worth nothing, and two cameras start
// together again.
void PairedSource::lose(const std::string& why) {
  close_all();
  pairer_.clear();
  singles_.clear();
  base_.reset();
  gap_ = statistics_.delivered > 0;
  statistics_.loss = last_failure_ = why;
  statistics_.state = LiveState::kReconnecting;
  const std::int64_t now = now_ns();
  next_try_ns_ = outage_ ? now + kRetry_ns : now;  // one that failed at once is not asked in a loop
  if (!outage_) lost_at_ns_ = now;
  outage_ = true;
}

Outcome PairedSource::reconnect(std::int64_t deadline_ns) {
  for (int interruptions = 0;;) {
    const std::int64_t now = now_ns();
    const std::int64_t give_up = lost_at_ns_ + std::min(options_.reconnect_timeout_ns, INT64_MAX - lost_at_ns_);
    if (statistics_.state == LiveState::kLost || now >= give_up) {
      statistics_.state = LiveState::kLost;
      return {Status::kNotFound, "the camera is lost (" + statistics_.loss + ")" +
                                     (options_.reconnect_timeout_ns > 0
                                          ? " and did not come back within " +
                                                span_text(options_.reconnect_timeout_ns) + " (" + last_failure_ + ")"
                                          : std::string()) +
                                     ": plug it in again and start again"};
    }
    if (now >= next_try_ns_) {
      Outcome o = start_streams();
      if (o.ok()) {
        streams_started();
        ++statistics_.reconnects;
        statistics_.state = statistics_.warm_up < static_cast<std::uint64_t>(options_.warm_up_frames)
                                ? LiveState::kWarmingUp
                                : LiveState::kStreaming;
        return {};
      }
      last_failure_ = std::move(o.message);
      next_try_ns_ = now_ns() + kRetry_ns;
    }
    if (now >= deadline_ns || interruptions > kMaxInterruptions)
      return {Status::kTimeout, "the camera is gone (" + statistics_.loss + "); looking for it for another " +
                                    span_text(give_up - now) + " (" + last_failure_ + ")"};
    const std::int64_t until = std::min({deadline_ns, next_try_ns_, give_up});
    sleep_until(until);
    if (now_ns() < until) ++interruptions;
  }
}

}  // namespace accrete::hal::camera
