#include "motion/pose_motion.h"

#include <algorithm>

#include "text/sentence.h"

namespace accrete::hal {

PoseMotion::PoseMotion(std::vector<StampedPose> poses, const PoseMotionSettings& settings, std::string name)
    : poses_(std::move(poses)), settings_(settings), name_(std::move(name)) {}

void PoseMotion::fill(Timestamp t, const Quaternion& rotation, const Vec3& translation, Motion& motion) const {
  motion = settings_.mode == MotionMode::kObjectMoves ? Motion::object(t, {rotation, translation})
                                                      : Motion::camera(t, {rotation, translation});
  motion.error = settings_.error;
  motion.covariance = settings_.covariance;
  motion.covariance_is_default = settings_.covariance_is_default;
}

Outcome PoseMotion::at(Timestamp t, Motion& motion) {
  const auto after = std::lower_bound(poses_.begin(), poses_.end(), t,
                                      [](const StampedPose& pose, Timestamp time) { return pose.t < time; });
  if (after != poses_.end() && after->t == t) {
    fill(t, after->rotation, after->translation, motion);
    return {};
  }
  const bool between = after != poses_.begin() && after != poses_.end();
  if (between && after->t - (after - 1)->t <= settings_.max_gap_ns) {
    const StampedPose &a = *(after - 1), &b = *after;
    const double s = static_cast<double>(t - a.t) / static_cast<double>(b.t - a.t);
    fill(t, slerp(a.rotation, b.rotation, s), a.translation + s * (b.translation - a.translation), motion);
    return {};
  }
  const StampedPose* nearest = nullptr;
  for (auto i = after == poses_.begin() ? after : after - 1; i != poses_.end() && i <= after; ++i)
    if (std::abs(i->t - t) <= kSameMoment_ns && (nearest == nullptr || std::abs(i->t - t) < std::abs(nearest->t - t)))
      nearest = &*i;
  if (nearest != nullptr) {
    fill(t, nearest->rotation, nearest->translation, motion);
    return {};
  }
  std::string why = "is empty";
  if (between)
    why = "has a gap of " + number(to_seconds(after->t - (after - 1)->t)) + " s there, more than the " +
          number(to_seconds(settings_.max_gap_ns)) + " s that are interpolated (--max-pose-gap)";
  else if (!poses_.empty())
    why = "covers " + number(to_seconds(poses_.front().t.ns), 12) + " s to " +
          number(to_seconds(poses_.back().t.ns), 12) + " s";
  return {Status::kNotFound, "no pose at " + number(to_seconds(t.ns), 12) + " s: " + name_ + " " + why};
}

}  // namespace accrete::hal
