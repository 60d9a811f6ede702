// One frame after the other, and what happens when none comes.
#include <algorithm>
#include <cerrno>
#include <cmath>

#include "text/sentence.h"
#include "v4l2/live_source.h"

namespace accrete::hal::v4l2 {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
// How often a lost camera is looked for: udev needs about that long to make its links.
constexpr std::int64_t kRetry_ns = 500 * kMillisecond;

std::string span_text(std::int64_t ns) {
  if (ns >= 1000 * kMillisecond) return number(static_cast<double>(ns) * 1e-9, 3) + " s";
  return number(static_cast<double>(ns) * 1e-6, 3) + " ms";
}

}  // namespace

Outcome LiveSource::do_acquire(std::int64_t timeout_ns, StereoFrame& frame) {
  const std::int64_t begin = kernel_.now_ns();
  const std::int64_t deadline = begin + std::min(timeout_ns, INT64_MAX - begin);
  arrived_before_[0] = left_.capture.statistics.arrived;
  arrived_before_[1] = right_.capture.statistics.arrived;
  interruptions_ = 0;
  for (bool last = false;;) {
    if (statistics_.state == V4l2State::kReconnecting || statistics_.state == V4l2State::kLost) {
      if (Outcome o = reconnect(deadline); !o.ok()) return o;
    } else if (next_frame(frame)) {
      update_counters();
      return {};
    } else if (last || interruptions_ > kMaxInterruptions) {
      update_counters();
      return too_late(timeout_ns);
    }
    if (statistics_.state == V4l2State::kReconnecting) continue;
    last = kernel_.now_ns() >= deadline;  // even then whatever is there already is taken
    collect(deadline);
  }
}

bool LiveSource::next_frame(StereoFrame& frame) {
  Pair pair;
  while (next_pair(pair)) {
    outage_ = false;
    if (warm_up(pair)) {
      give_back(pair);
      continue;
    }
    if (deliver(pair, frame)) return true;
  }
  return false;
}

bool LiveSource::next_pair(Pair& pair) {
  if (!two()) {
    if (singles_.empty()) return false;
    pair = {singles_.front(), singles_.front()};
    singles_.erase(singles_.begin());
    return true;
  }
  const bool found = pairer_.next(pair);
  for (const Eye eye : {Eye::kLeft, Eye::kRight}) {
    Capture& capture = eye == Eye::kLeft ? left_.capture : right_.capture;
    for (const Waiting& image : pairer_.unpaired(eye)) {
      ++capture.statistics.unpaired;
      capture.give_back(image.slot);
    }
    pairer_.unpaired(eye).clear();
  }
  return found;
}

void LiveSource::give_back(const Pair& pair) {
  left_.capture.give_back(pair.left.slot);
  if (two()) right_.capture.give_back(pair.right.slot);
}

// True while pairs are left out.
bool LiveSource::warm_up(const Pair& /*pair*/) {
  if (statistics_.state != V4l2State::kWarmingUp) return false;
  if (++statistics_.warm_up < static_cast<std::uint64_t>(options_.warm_up_frames)) return true;
  if (options_.lock_exposure)
    exposure_.lock(left_.capture.fd(), left_.capture.statistics, two() ? right_.capture.fd() : -1,
                   right_.capture.statistics);
  statistics_.state = V4l2State::kStreaming;
  return true;
}

bool LiveSource::deliver(const Pair& pair, StereoFrame& frame) {
  const RawImage left = left_.capture.raw(pair.left.slot);
  const Eyes::Made made = two() ? eyes_.pair(left, right_.capture.raw(pair.right.slot), frame)
                                : eyes_.split_one(options_.layout, left, frame);
  if (made == Eyes::Made::kDamaged) {
    V4l2DeviceStatistics& s = eyes_.damaged() == Eye::kLeft ? left_.capture.statistics : right_.capture.statistics;
    --s.arrived;
    ++s.damaged;
    give_back(pair);
    return false;
  }
  if (made == Eyes::Made::kViews)
    held_ = pair;
  else
    give_back(pair);
  frame.t_left = {pair.left.t_ns};
  frame.t_right = {pair.right.t_ns};
  number(pair, frame);
  const std::int64_t skew = time_difference(pair.right.t_ns, pair.left.t_ns);
  const bool first = statistics_.delivered++ == 0;
  statistics_.skew_min_ns = first ? skew : std::min(statistics_.skew_min_ns, skew);
  statistics_.skew_max_ns = first ? skew : std::max(statistics_.skew_max_ns, skew);
  skew_sum_ns_ += static_cast<double>(skew);
  return true;
}

// The first pair is 0; later numbers follow the left camera's, so that what was lost is missing. A loss of the camera
// leaves out as many as it took periods, one at least.
void LiveSource::number(const Pair& pair, StereoFrame& frame) {
  const std::uint64_t its = pair.left.sequence;
  if (!base_) {
    std::uint64_t next = 0;
    if (gap_) {
      const auto away = static_cast<double>(std::max<std::int64_t>(time_difference(pair.left.t_ns, last_t_ns_), 0));
      const double periods = period_ns() > 0 ? away / period_ns() : 0;
      next = last_number_ + static_cast<std::uint64_t>(std::max(2LL, std::llround(periods)));
    }
    base_ = next - its;  // modulo 2^64
  }
  frame.sequence = *base_ + its;
  last_number_ = frame.sequence;
  last_t_ns_ = pair.left.t_ns;
  statistics_.after_gap = gap_;
  if (gap_) ++statistics_.gaps;
  gap_ = false;
}

void LiveSource::collect(std::int64_t deadline_ns) {
  pollfd fds[2] = {{left_.capture.fd(), POLLIN, 0}, {right_.capture.fd(), POLLIN, 0}};
  const unsigned count = two() ? 2 : 1;
  const int ready = wait(kernel_, fds, count, deadline_ns);
  if (ready < 0) return lose("waiting for images fails: " + error_text(errno));
  if (ready == 0) {
    if (kernel_.now_ns() < deadline_ns) ++interruptions_;
    return;
  }
  if (fds[0].revents != 0) take_from(left_, Eye::kLeft, fds[0].revents, deadline_ns);
  if (two() && fds[1].revents != 0 && right_.capture.streaming())
    take_from(right_, Eye::kRight, fds[1].revents, deadline_ns);
}

void LiveSource::take_from(Device& device, Eye eye, short revents, std::int64_t deadline_ns) {
  Capture::Image image;
  switch (device.capture.take(revents, image)) {
    case Capture::Took::kImage:
      if (two())
        pairer_.add(eye, {image.slot, image.t_ns, image.sequence});
      else
        singles_.push_back({image.slot, image.t_ns, image.sequence});
      interruptions_ = 0;
      return;
    case Capture::Took::kNothing:  // poll() promised one: no busy loop
      wait(kernel_, nullptr, 0, std::min(deadline_ns, kernel_.now_ns() + kMillisecond));
      return;
    case Capture::Took::kDamaged:
      return;
    case Capture::Took::kLost:
      return lose(device.capture.loss());
  }
}

// Everything is torn down, on both sides: buffers of a stream that has ended are worth nothing, and two cameras start
// together again.
void LiveSource::lose(const std::string& why) {
  close_all();
  pairer_.clear();
  singles_.clear();
  base_.reset();
  gap_ = statistics_.delivered > 0;
  statistics_.loss = last_failure_ = why;
  statistics_.state = V4l2State::kReconnecting;
  const std::int64_t now = kernel_.now_ns();
  next_try_ns_ = outage_ ? now + kRetry_ns : now;  // one that failed at once is not asked in a loop
  if (!outage_) lost_at_ns_ = now;
  outage_ = true;
}

Outcome LiveSource::reconnect(std::int64_t deadline_ns) {
  for (int interruptions = 0;;) {
    const std::int64_t now = kernel_.now_ns();
    const std::int64_t give_up = lost_at_ns_ + std::min(options_.reconnect_timeout_ns, INT64_MAX - lost_at_ns_);
    if (statistics_.state == V4l2State::kLost || now >= give_up) {
      statistics_.state = V4l2State::kLost;
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
        ++statistics_.reconnects;
        statistics_.state = statistics_.warm_up < static_cast<std::uint64_t>(options_.warm_up_frames)
                                ? V4l2State::kWarmingUp
                                : V4l2State::kStreaming;
        return {};
      }
      last_failure_ = std::move(o.message);
      next_try_ns_ = kernel_.now_ns() + kRetry_ns;
    }
    if (now >= deadline_ns || interruptions > kMaxInterruptions)
      return {Status::kTimeout, "the camera is gone (" + statistics_.loss + "); looking for it for another " +
                                    span_text(give_up - now) + " (" + last_failure_ + ")"};
    const std::int64_t until = std::min({deadline_ns, next_try_ns_, give_up});
    wait(kernel_, nullptr, 0, until);
    if (kernel_.now_ns() < until) ++interruptions;
  }
}

Outcome LiveSource::too_late(std::int64_t timeout_ns) const {
  const auto silent = [timeout_ns](const Device& device) {
    const V4l2DeviceStatistics& its = device.capture.statistics;
    const std::string text = "no image from " + device.capture.who() + " within " + span_text(timeout_ns);
    if (its.arrived > 0) return text + ": it was delivering before; is its cable loose, or does the bus save power?";
    if (its.damaged > 0)
      return text + ", but " + count(its.damaged, "damaged one") +
             ": a bad cable, too little bandwidth, or a format that the camera does not really have";
    return text +
           ": too little bandwidth (try MJPG, a lower rate, another USB port), or a camera that waits for a trigger";
  };
  if (left_.capture.statistics.arrived == arrived_before_[0]) return {Status::kTimeout, silent(left_)};
  if (two() && right_.capture.statistics.arrived == arrived_before_[1]) return {Status::kTimeout, silent(right_)};
  if (statistics_.state == V4l2State::kWarmingUp)
    return {Status::kTimeout, "the cameras are warming up: " + std::to_string(statistics_.warm_up) + " of " +
                                  count(static_cast<std::size_t>(options_.warm_up_frames), "frame")};
  std::string text = "images arrive, but no pair within " + span_text(timeout_ns);
  if (pairer_.nearest_miss_ns() >= 0)
    text += ": left and right are " + span_text(pairer_.nearest_miss_ns()) + " apart at least, " +
            span_text(statistics_.pair_tolerance_ns) + " are tolerated; do both have one rate?";
  return {Status::kTimeout, text};
}

void LiveSource::update_counters() {
  const V4l2DeviceStatistics &l = left_.capture.statistics, &r = right_.capture.statistics;
  counters_.dropped = l.dropped + r.dropped + l.damaged + r.damaged;
  counters_.unpaired = l.unpaired + r.unpaired;
}

}  // namespace accrete::hal::v4l2
