#include "v4l2/live_source.h"

#include <algorithm>
#include <cmath>

#include "text/sentence.h"

namespace accrete::hal::v4l2 {
namespace {

constexpr std::int64_t kMaxTolerance_ns = 8'000'000;  // as EuRoC's pairs: a quarter of a period at 30 Hz

}  // namespace

LiveSource::LiveSource(Kernel& kernel, V4l2Options options)
    : kernel_(kernel),
      options_(std::move(options)),
      left_(kernel),
      right_(kernel),
      exposure_(kernel),
      pairer_(kMaxTolerance_ns, 1) {}

std::vector<LiveSource::Device*> LiveSource::devices() {
  if (two()) return {&left_, &right_};
  return {&left_};
}

double LiveSource::period_ns() const {
  const double left = left_.capture.format().rate_hz, right = two() ? right_.capture.format().rate_hz : 0;
  const double rate = std::max(left, right);
  return rate > 0 ? 1e9 / rate : 0;
}

V4l2Statistics LiveSource::statistics() const {
  V4l2Statistics s = statistics_;
  s.left = left_.capture.statistics;
  if (two()) s.right = right_.capture.statistics;
  if (s.delivered > 0) s.skew_mean_ns = skew_sum_ns_ / static_cast<double>(s.delivered);
  return s;
}

void LiveSource::close_all() {
  left_.capture.close();
  right_.capture.close();
}

// What belongs to a stream, not to the device.
void LiveSource::reset_statistics() {
  statistics_ = {};
  skew_sum_ns_ = 0;
  for (Device* device : devices()) {
    V4l2DeviceStatistics& s = device->capture.statistics;
    s.clock = V4l2Clock::kUnknown;
    s.arrived = s.dropped = s.damaged = s.unpaired = 0;
    s.locked.clear();
  }
  counters_ = {};
}

// A device that came back under another node, or that was never away.
Outcome LiveSource::open_again(Device& device) {
  const std::string node = find_again(kernel_, device.identity);
  if (node.empty())
    return {Status::kNotFound,
            (device.identity.link.empty() ? device.identity.node : device.identity.link) + " is not there"};
  const NegotiatedFormat format = device.capture.format();  // of before
  if (Outcome o = device.capture.open(node); !o.ok()) return o;
  const Capability& found = device.capture.capability();
  if (device.identity.link.empty() && (found.card != device.identity.card || found.bus != device.identity.bus)) {
    device.capture.close();
    return {Status::kNotFound, node + " is another camera now (" + found.card + " instead of " + device.identity.card +
                                   "); one with a link in /dev/v4l would be found again"};
  }
  return device.capture.negotiate({format.known, format.width_px, format.height_px, options_.rate_hz});
}

// All or nothing: on failure every device is closed.
Outcome LiveSource::start_streams() {
  Outcome o;
  for (Device* device : devices())
    if (o.ok() && !device->capture.is_open()) o = open_again(*device);
  for (Device* device : devices()) {
    if (!o.ok()) break;
    if (exposure_.locked())
      exposure_.apply(device->capture.fd(), device->capture.statistics);
    else if (options_.lock_exposure && options_.warm_up_frames > 0)
      exposure_.make_automatic(device->capture.fd());
    o = device->capture.prepare(options_.buffers);
  }
  for (Device* device : devices())
    if (o.ok()) o = device->capture.stream_on();
  if (!o.ok()) {
    close_all();
    return o;
  }
  int fewest = left_.capture.buffers();
  if (two()) fewest = std::min(fewest, right_.capture.buffers());
  const double half_period = period_ns() > 0 ? 0.5 * period_ns() : static_cast<double>(kMaxTolerance_ns);
  statistics_.pair_tolerance_ns = options_.pair_tolerance_ns > 0
                                      ? options_.pair_tolerance_ns
                                      : static_cast<std::int64_t>(std::min(half_period, 1.0 * kMaxTolerance_ns));
  // The driver always has two to fill.
  pairer_ = Pairer(statistics_.pair_tolerance_ns, fewest - 2);
  singles_.clear();
  held_.reset();
  return {};
}

Outcome LiveSource::do_start() {
  reset_statistics();
  exposure_.forget();
  outage_ = gap_ = false;
  interruptions_ = 0;
  base_.reset();
  if (Outcome o = start_streams(); !o.ok()) return o;
  statistics_.state = options_.warm_up_frames > 0 ? V4l2State::kWarmingUp : V4l2State::kStreaming;
  if (options_.lock_exposure && options_.warm_up_frames == 0)
    exposure_.lock(left_.capture.fd(), left_.capture.statistics, two() ? right_.capture.fd() : -1,
                   right_.capture.statistics);
  return {};
}

void LiveSource::do_release() {
  if (held_) give_back(*held_);
  held_.reset();
}

void LiveSource::do_stop() {
  left_.capture.stop();
  right_.capture.stop();
  pairer_.clear();
  singles_.clear();
  held_.reset();
  statistics_.state = V4l2State::kStopped;
}

}  // namespace accrete::hal::v4l2
