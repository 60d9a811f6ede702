#include "motion/pose_motion.h"

#include <algorithm>

#include "text/sentence.h"

namespace accrete::hal {
namespace {

void fill(const PoseMotionSettings& settings, Timestamp t, const StampedPose& pose, Motion& motion) {
  motion = settings.mode == MotionMode::kObjectMoves ? Motion::object(t, {pose.rotation, pose.translation})
                                                     : Motion::camera(t, {pose.rotation, pose.translation});
  motion.error = settings.error;
  motion.covariance = pose.covariance ? *pose.covariance : settings.covariance;
  motion.covariance_is_default = !pose.covariance && settings.covariance_is_default;
}

// Of a mixture that is right for errors which change slowly, and too large otherwise; positive definite like its parts.
void mix_covariances(const StampedPose& a, const StampedPose& b, double s, Motion& motion) {
  if (!a.covariance || !b.covariance) return;
  for (std::size_t i = 0; i < motion.covariance.size(); ++i)
    motion.covariance[i] = (1 - s) * (*a.covariance)[i] + s * (*b.covariance)[i];
}

}  // namespace

PoseMotion::PoseMotion(std::vector<StampedPose> poses, const PoseMotionSettings& settings, std::string name)
    : poses_(std::move(poses)), settings_(settings), name_(std::move(name)) {}

Outcome interpolate(std::span<const StampedPose> poses, const PoseMotionSettings& settings, const std::string& name,
                    Timestamp t, Motion& motion) {
  const auto after = std::lower_bound(poses.begin(), poses.end(), t,
                                      [](const StampedPose& pose, Timestamp time) { return pose.t < time; });
  if (after != poses.end() && after->t == t) {
    fill(settings, t, *after, motion);
    return {};
  }
  const bool between = after != poses.begin() && after != poses.end();
  if (between && after->t - (after - 1)->t <= settings.max_gap_ns) {
    const StampedPose &a = *(after - 1), &b = *after;
    const double s = static_cast<double>(t - a.t) / static_cast<double>(b.t - a.t);
    StampedPose pose = a;
    pose.rotation = slerp(a.rotation, b.rotation, s);
    pose.translation = a.translation + s * (b.translation - a.translation);
    fill(settings, t, pose, motion);
    mix_covariances(a, b, s, motion);
    return {};
  }
  const StampedPose* nearest = nullptr;
  for (auto i = after == poses.begin() ? after : after - 1; i != poses.end() && i <= after; ++i)
    if (std::abs(i->t - t) <= kSameMoment_ns && (nearest == nullptr || std::abs(i->t - t) < std::abs(nearest->t - t)))
      nearest = &*i;
  if (nearest != nullptr) {
    fill(settings, t, *nearest, motion);
    return {};
  }
  std::string why = "is empty";
  if (between)
    why = "has a gap of " + number(to_seconds(after->t - (after - 1)->t)) + " s there, more than the " +
          number(to_seconds(settings.max_gap_ns)) + " s that are interpolated (--max-pose-gap)";
  else if (!poses.empty())
    why = "covers " + number(to_seconds(poses.front().t.ns), 12) + " s to " +
          number(to_seconds(poses.back().t.ns), 12) + " s";
  return {Status::kNotFound, "no pose at " + number(to_seconds(t.ns), 12) + " s: " + name + " " + why};
}

}  // namespace accrete::hal
