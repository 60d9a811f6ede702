// What a run reads: a recording or a synthetic scene, opened, with everything that was found out about it.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "accrete/hal/live_motion.h"
#include "accrete/hal/motion_source.h"
#include "accrete/hal/recording.h"
#include "accrete/hal/stereo_source.h"
#include "cli/live/live_cameras.h"
#include "cli/run/options.h"
#include "cli/score/truth.h"

namespace accrete::cli {

struct Input {
  std::string name;                           // short, for the folder of the results
  std::string kind;                           // "plain folder", "synthetic scene", ...
  std::unique_ptr<hal::StereoSource> source;  // configured
  std::unique_ptr<hal::MotionSource> motion;  // null only where poses were not required
  std::optional<hal::RecordingInfo> info;     // recordings; of live cameras what is known of their poses
  std::optional<LiveCameras> cameras;         // of this machine
  hal::LiveMotion* live_poses = nullptr;      // `motion`, where poses arrive while the program runs
  bool live = false;                          // the images come from a camera: it does not wait, and it has no end
  MotionMode mode = MotionMode::kObjectMoves;
  std::vector<std::string> guesses, warnings;
  std::vector<ExcludedBox> own_gripper;  // of a synthetic scene
  std::filesystem::path truth_folder;    // recordings: where its truth would be
};

// Throws Failure: kInput (nothing there, damaged, poses or calibration missing), kUsage (a kind of recording that is
// not understood; the sentence lists those that are).
[[nodiscard]] Input open_input(const RunOptions& options);

// The truth of the input: files of the recording, or the scene's own. Empty members where there is none.
[[nodiscard]] Truth truth_of(const Input& input, const RunOptions& options);

// One line each: images, calibration, times, poses with their conventions, and the guesses.
[[nodiscard]] std::vector<std::string> describe(const Input& input);

// Of a recording's folder, whatever slashes and dots the path has, and by the folder in which EuRoC's mav0 lies: the
// name that its results and pages carry, and where its truth would be.
[[nodiscard]] std::string name_of_recording(const std::string& recording);
[[nodiscard]] std::filesystem::path truth_folder_of(const std::string& recording);

// Throws Failure(kUsage) when `out` is the recording's own folder or one with truth, its own or `truth`.
void refuse_as_results(const std::filesystem::path& out, const Input& input, const std::filesystem::path& truth);

// What became of live poses, in one line.
[[nodiscard]] std::string live_poses_sentence(const hal::LiveMotionCounters& counters);

// "synthetic:box" gives "box", anything else nothing.
[[nodiscard]] std::optional<std::string> synthetic_name(const std::string& recording);

}  // namespace accrete::cli
