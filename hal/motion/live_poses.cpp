#include "motion/live_poses.h"

#include <algorithm>

#include "motion/convention.h"
#include "motion/pose_row.h"
#include "text/sentence.h"

namespace accrete::hal {
namespace {

// Datagrams overtake each other by milliseconds. A step further back is a clock that was set, or a writer that began
// anew.
constexpr std::int64_t kReordered_ns = 1'000'000'000;

PoseMotionSettings settings_of(const LiveMotionOptions& o) {
  PoseMotionSettings s;
  s.mode = o.mode;
  s.error = o.error.value_or(o.mode == MotionMode::kObjectMoves ? PoseError::kAbsolute : PoseError::kIncremental);
  s.covariance = diagonal_pose_covariance(o.sigma_m.value_or(0), o.sigma_rad.value_or(0));
  s.covariance_is_default = !o.sigma_m && !o.sigma_rad;
  s.max_gap_ns = o.max_gap_ns;
  return s;
}

// Seconds, or nanoseconds above 1e12, as in files.
bool parse_stamp(std::string_view text, Timestamp& t) {
  constexpr std::int64_t kSurelyNanoseconds = 1'000'000'000'000;
  Decimal value;
  if (!parse(text, value)) return false;
  if (value.whole > kSurelyNanoseconds) {
    t.ns = value.whole;
    return is_stamp(t.ns);
  }
  if (!value.fits_ns()) return false;
  t.ns = value.ns();
  return true;
}

}  // namespace

LivePoses::LivePoses(const LiveMotionOptions& options, std::string name)
    : options_(options), settings_(settings_of(options)), name_(std::move(name)) {
  poses_.reserve(2 * options_.capacity);
}

bool LivePoses::parse_line(std::string_view text, StampedPose& pose) {
  RowReader rows(text);
  Row row;
  if (!rows.next(row) || row.comma_separated) return false;
  if (columns_ == 0 ? row.field_count != 8 && row.field_count != kCovarianceColumns : row.field_count != columns_)
    return false;
  if (!parse_stamp(row.fields[0], pose.t) || !read_pose_row(name_, row, PoseFormat::kTum, pose).ok()) return false;
  columns_ = row.field_count;
  to_canonical(pose, options_.mode, options_.inverse, options_.T_l_f);
  return true;
}

void LivePoses::line(std::string_view text) {
  text = trimmed(text);
  if (text.empty() || text[0] == '#') return;
  StampedPose pose;
  if (text.size() > Row::kMaxLength || !parse_line(text, pose)) {
    ++counters_.malformed;
    return;
  }
  insert(std::move(pose));
}

void LivePoses::insert(StampedPose pose) {
  if (gave_up_ && pose.t <= given_up_) ++counters_.late;
  if (!poses_.empty() && pose.t <= poses_.back().t) {
    ++counters_.backwards;
    // The newest line is right: one stamp of the year 3000 must not shut out all that follow it.
    if (poses_.back().t - pose.t > kReordered_ns)
      while (!poses_.empty() && poses_.back().t >= pose.t) poses_.pop_back();
  }
  const auto place =
      std::lower_bound(poses_.begin(), poses_.end(), pose.t, [](const StampedPose& p, Timestamp t) { return p.t < t; });
  if (place != poses_.end() && place->t == pose.t) return;  // the first one stays
  poses_.insert(place, std::move(pose));
  ++counters_.poses;
  if (poses_.size() == 2 * options_.capacity)
    poses_.erase(poses_.begin(), poses_.begin() + static_cast<std::ptrdiff_t>(options_.capacity));
}

Outcome LivePoses::at(Timestamp t, Motion& motion) {
  Outcome o = interpolate(poses_, settings_, name_, t, motion);
  if (o.ok()) {
    ++counters_.served;
    return o;
  }
  if (!poses_.empty() && t < poses_.front().t) {
    ++counters_.early;
  } else {
    ++counters_.missing;
    if (!gave_up_ || t > given_up_) given_up_ = t;
    gave_up_ = true;
  }
  return o;
}

}  // namespace accrete::hal
