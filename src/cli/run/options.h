// What the command line says about a run, checked and in SI units.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "accrete/hal/libcamera.h"
#include "accrete/hal/recording.h"
#include "accrete/hal/synthetic.h"
#include "accrete/params.h"
#include "cli/live/camera_flags.h"
#include "cli/run/units.h"

namespace CLI {
class App;
}

namespace accrete::cli {

enum class Capacity { kAuto, kSmall, kDefault, kLarge };

struct RunOptions {
  std::string recording = "synthetic:box";
  std::filesystem::path out;  // empty: results/<UTC time>_<name>/
  hal::RecordingOptions input;
  std::int64_t pose_wait_ns = 100'000'000;  // of poses that arrive while the program runs
  hal::SyntheticOptions scene;
  hal::LibcameraOptions cameras;  // of v4l2:... and libcamera:...
  Params params;
  bool excluded_given = false;  // --exclude-box: otherwise a synthetic scene excludes its own gripper
  FrameRange frames;
  Capacity capacity = Capacity::kAuto;
  int threads = 0;               // of a step: 1, 2, or 0: as many as the processor has cores, up to 2
  std::filesystem::path resume;  // empty: a new model
  bool save_model = false;
  bool full_covariance = false;
  int overlay_every = 0;  // 0: none
  float min_existence = 0;
  bool json = false;
  bool quiet = false;
};

// The flags of `run`, shared with `info` and `evaluate`; the texts live as long as the application.
class RunFlags {
 public:
  // Which flags a command has: how to read the recording; live cameras; how to accumulate; what to write.
  void add_input(CLI::App& app);
  void add_cameras(CLI::App& app);
  void add_accumulation(CLI::App& app);
  void add_output(CLI::App& app);

  // After parsing. Throws Failure(kUsage).
  [[nodiscard]] RunOptions options() const;

 private:
  RunOptions plain_;  // flags that need no conversion
  std::string motion_, pose_error_, pose_direction_, pose_frame_, kind_, capacity_ = "auto";
  std::string pose_sigma_, max_pose_gap_, pose_wait_, scene_pose_noise_, depth_range_, frames_;
  double rate_hz_ = 0;
  std::vector<std::string> excluded_, settings_;
  CameraFlags cameras_;
};

// "auto", "small", "default", "large".
[[nodiscard]] const char* to_string(Capacity capacity);

}  // namespace accrete::cli
