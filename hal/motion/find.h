// Which poses belong to a recording, and what they mean.
#pragma once

#include <memory>

#include "calibration/calibration.h"
#include "replay/frame_list.h"

namespace accrete::hal {

// A pose file with the mode that it is for.
struct PoseFile {
  std::filesystem::path path;
  MotionMode mode = MotionMode::kObjectMoves;
};

// Status: kInvalidArgument, with the flag in the sentence.
Outcome check_pose_options(const RecordingOptions& options);

// The file of `options`, or what stands in the recording. Status: kNotFound, with the names that were looked for.
Outcome find_poses(const Layout& layout, const RecordingOptions& options, PoseFile& file,
                   std::vector<std::string>& guesses);

// Reads the file, joins it with calibration and frames, and fills the part of `info` that is about poses. Status: of
// find_poses and read_poses; kInvalidArgument (poses of a body that the calibration does not know, a matrix list whose
// lines fit no frames), kNotFound (not one frame has a pose).
Outcome open_poses(const Layout& layout, const RecordingOptions& options, const Calibration& calibration,
                   const FrameList& list, std::unique_ptr<MotionSource>& motion, RecordingInfo& info);

}  // namespace accrete::hal
