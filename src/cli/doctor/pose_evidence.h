// How well given poses move points that were seen by both eyes to where the next frame shows them.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "cli/doctor/rig_evidence.h"
#include "cli/doctor/rigid_motion.h"

namespace accrete::cli {

// Two consecutive frames between which the images alone tell one rigid motion.
struct Step {
  std::size_t sample = 0;            // index of the first of the two
  std::vector<TrackedPoint> points;  // those that agree on the motion, in the frame of the tracked camera
  double flow_px = 0;                // median distance that they moved
  double own_px = 0;                 // median residual of the motion that they agree on
};

struct Tracks {
  std::vector<Step> steps;
  std::size_t tried = 0;      // pairs of consecutive frames
  bool tracks_right = false;  // the points are in the right camera's frame (the eyes were swapped)
  double focal_px = 0;
};

// Points of `view` (made by the same rig and change) that are found again in the next frame. Where the object moves,
// only points that move are taken. A step is kept where at least 12 points and half of all agree within 2 px.
[[nodiscard]] Tracks track(const Samples& samples, const RigView& view, const StereoRig& rig, const ImageChange& change,
                           MotionMode mode);

// T_l_m after and before a step; empty where poses are missing.
struct PoseStep {
  Transform<Left, Map> before, after;
};
using PoseReading = std::function<std::optional<PoseStep>(const Sample& first, const Sample& second)>;

struct PoseFit {
  std::size_t steps = 0;
  double residual_px = 0;  // median over all points of all steps
  double flow_px = 0;      // the same for how far they moved
  double own_px = 0;       // the same for the motion that the images tell
};
[[nodiscard]] PoseFit fit_poses(const Samples& samples, const Tracks& tracks, const StereoRig& rig,
                                const PoseReading& reading);

}  // namespace accrete::cli
