// One frame after the other, and what is said when none comes.
#include <algorithm>
#include <cmath>

#include "camera/paired_source.h"
#include "camera/span_text.h"
#include "text/sentence.h"

namespace accrete::hal::camera {

Outcome PairedSource::do_acquire(std::int64_t timeout_ns, StereoFrame& frame) {
  const std::int64_t begin = now_ns();
  const std::int64_t deadline = begin + std::min(timeout_ns, INT64_MAX - begin);
  arrived_before_[0] = device(Eye::kLeft).arrived;
  arrived_before_[1] = device(Eye::kRight).arrived;
  interruptions_ = 0;
  for (bool last = false;;) {
    if (statistics_.state == LiveState::kReconnecting || statistics_.state == LiveState::kLost) {
      if (Outcome o = reconnect(deadline); !o.ok()) return o;
    } else if (next_frame(frame)) {
      update_counters();
      return {};
    } else if (last || interruptions_ > kMaxInterruptions) {
      update_counters();
      return too_late(timeout_ns);
    }
    if (statistics_.state == LiveState::kReconnecting) continue;
    last = now_ns() >= deadline;  // even then whatever is there already is taken
    collect(deadline);
  }
}

bool PairedSource::next_frame(StereoFrame& frame) {
  Pair pair;
  while (next_pair(pair)) {
    outage_ = false;
    if (warm_up()) {
      give_back(pair);
      continue;
    }
    if (deliver(pair, frame)) return true;
  }
  return false;
}

bool PairedSource::next_pair(Pair& pair) {
  if (!two()) {
    if (singles_.empty()) return false;
    pair = {singles_.front(), singles_.front()};
    singles_.erase(singles_.begin());
    return true;
  }
  const bool found = pairer_.next(pair);
  for (const Eye eye : {Eye::kLeft, Eye::kRight}) {
    for (const Waiting& image : pairer_.unpaired(eye)) {
      ++device(eye).unpaired;
      give_back(eye, image.slot);
    }
    pairer_.unpaired(eye).clear();
  }
  return found;
}

void PairedSource::give_back(const Pair& pair) {
  give_back(Eye::kLeft, pair.left.slot);
  if (two()) give_back(Eye::kRight, pair.right.slot);
}

// True while pairs are left out.
bool PairedSource::warm_up() {
  if (statistics_.state != LiveState::kWarmingUp) return false;
  if (++statistics_.warm_up < static_cast<std::uint64_t>(options_.warm_up_frames)) return true;
  if (options_.lock_exposure) lock_exposure();
  statistics_.state = LiveState::kStreaming;
  return true;
}

bool PairedSource::deliver(const Pair& pair, StereoFrame& frame) {
  const RawImage left = raw(Eye::kLeft, pair.left.slot);
  const Eyes::Made made = two() ? eyes_.pair(left, raw(Eye::kRight, pair.right.slot), frame)
                                : eyes_.split_one(options_.layout, left, frame);
  if (made == Eyes::Made::kDamaged) {
    LiveDeviceStatistics& s = device(eyes_.damaged());
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
void PairedSource::number(const Pair& pair, StereoFrame& frame) {
  const std::uint64_t its = pair.left.sequence;
  if (!base_) {
    std::uint64_t next = 0;
    if (gap_) {
      const auto away = static_cast<double>(std::max<std::int64_t>(time_difference(pair.left.t_ns, last_t_ns_), 0));
      const double periods = period_ns() > 0 ? away / static_cast<double>(period_ns()) : 0;
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

Outcome PairedSource::too_late(std::int64_t timeout_ns) const {
  const auto silent = [this, timeout_ns](Eye eye) {
    const LiveDeviceStatistics& its = device(eye);
    const std::string text = "no image from " + who(eye) + " within " + span_text(timeout_ns);
    if (its.arrived > 0) return text + ": it was delivering before; is its cable loose, or does the bus save power?";
    if (its.damaged > 0)
      return text + ", but " + count(its.damaged, "damaged one") +
             ": a bad cable, too little bandwidth, or a format that the camera does not really have";
    return text +
           ": too little bandwidth (try MJPG, a lower rate, another USB port), or a camera that waits for a trigger";
  };
  if (device(Eye::kLeft).arrived == arrived_before_[0]) return {Status::kTimeout, silent(Eye::kLeft)};
  if (two() && device(Eye::kRight).arrived == arrived_before_[1]) return {Status::kTimeout, silent(Eye::kRight)};
  if (statistics_.state == LiveState::kWarmingUp)
    return {Status::kTimeout, "the cameras are warming up: " + std::to_string(statistics_.warm_up) + " of " +
                                  count(static_cast<std::uint64_t>(options_.warm_up_frames), "frame")};
  std::string text = "images arrive, but no pair within " + span_text(timeout_ns);
  if (pairer_.nearest_miss_ns() >= 0)
    text += ": left and right are " + span_text(pairer_.nearest_miss_ns()) + " apart at least, " +
            span_text(statistics_.pair_tolerance_ns) + " are tolerated; do both have one rate?";
  return {Status::kTimeout, text};
}

void PairedSource::arrived(Eye eye, const Waiting& image) {
  interruptions_ = 0;
  if (two())
    pairer_.add(eye, image);
  else
    singles_.push_back(image);
}

void PairedSource::update_counters() {
  const LiveDeviceStatistics &l = device(Eye::kLeft), &r = device(Eye::kRight);
  counters_.dropped = l.dropped + r.dropped + l.damaged + r.damaged;
  counters_.unpaired = l.unpaired + r.unpaired;
}

}  // namespace accrete::hal::camera
