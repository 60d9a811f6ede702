// Rendered recordings with exact truth: they need no file and no camera. An ideal pinhole pair (640 x 480, f 800 px,
// baseline 0.12 m) looks at painted solids; coverage is exact, light Lambertian from two fixed lamps, blur a Gaussian
// of 0.5 px in linear light, then sRGB and seeded noise. The same options give the same frames, in any order.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "accrete/hal/motion_source.h"
#include "accrete/hal/stereo_source.h"
#include "accrete/hal/truth.h"

namespace accrete::hal {

struct SyntheticOptions {
  int frames = 60;
  double degrees_per_frame = 0;  // 0: a full turn (box) or an arc of 40 degrees (room) in `frames`
  double noise_levels = 2.0;     // standard deviation in grey levels, independent per channel
  double pose_noise_m = 0;       // the reported pose has an independent absolute error a frame; its covariance says so
  double pose_noise_rad = 0;
  std::uint64_t seed = 1;       // of the paint, the noise of the images and the noise of the poses
  std::optional<bool> gripper;  // overrides what the name says
  std::optional<bool> occluder;
};

struct SyntheticScene {  // one of synthetic_scenes()
  const char* name;
  const char* description;
};

// box           a painted box, held by a gripper that moves along, turned before wall and table behind a passing bar
// box-plain     the same box alone before wall and table
// box-gripper   with the gripper, without the bar
// box-occluded  with the bar, without the gripper
// box-shimmer   the box alone; the colours of its face +z change with the viewing angle, by 60 % and a third apart
// room          nothing moves but the cameras, on an arc; the right camera is turned and has another focal length
[[nodiscard]] std::span<const SyntheticScene> synthetic_scenes();

// kNotFound: no such scene; the sentence lists those there are. kInvalidArgument: an option out of range (frames 1 ..
// 100000, noise 0 .. 64 levels, pose noise 0 .. 0.1 m and 0.1 rad, arc of the room up to 50 degrees).
[[nodiscard]] Outcome open_synthetic(std::string_view name, const SyntheticOptions& options,
                                     std::unique_ptr<StereoSource>& stereo, std::unique_ptr<MotionSource>& motion);

// The truth of that recording. Map is the object's frame (box) or the world's, which is the left camera's in the middle
// of the arc (room). Statuses of open_synthetic.
[[nodiscard]] Outcome synthetic_truth(std::string_view name, const SyntheticOptions& options, Truth& truth);

}  // namespace accrete::hal
