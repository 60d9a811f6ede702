// What the doctor looks at: pairs of consecutive frames, evenly chosen, with their landmarks and the motions around.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "accrete/hal/motion_source.h"
#include "accrete/hal/stereo_source.h"
#include "accrete/motion.h"
#include "cli/doctor/landmarks.h"
#include "cli/run/units.h"

namespace accrete::cli {

struct Sample {
  std::uint64_t number = 0;  // of the frame in the recording
  Timestamp t_left, t_right;
  LandmarkImage left, right;
  std::vector<Pair> stereo;                           // left to right, whatever the calibration says
  std::vector<Pair> next;                             // left to the next frame's left; empty where that is no sample
  bool has_next = false;                              // the next sample is the next frame
  std::optional<Motion> motion;                       // as given
  std::optional<Motion> motion_before, motion_after;  // of the frames before and after it
};

struct Samples {
  std::vector<Sample> list;
  std::uint64_t frames = 0;      // that were read or passed
  std::uint64_t unreadable = 0;  // damaged, or of another size
  std::string why_unreadable;    // of the first such frame
  std::uint64_t without_motion = 0;
};

// Which of `count` frames to take, about `wanted` of them: runs of two, evenly spaced. All where there are fewer.
[[nodiscard]] std::vector<std::uint64_t> choose_frames(std::uint64_t first, std::uint64_t count, std::uint64_t wanted);

// Reads a source that is configured or streaming. `motion` may be null. Where the source does not know its size (live
// cameras), every frame is taken until there are `wanted`. `stopped` ends it early. Throws Failure(kInput).
[[nodiscard]] Samples take_samples(hal::StereoSource& source, hal::MotionSource* motion, const FrameRange& range,
                                   std::uint64_t wanted, const std::function<bool()>& stopped);

}  // namespace accrete::cli
