// Recordings on disk, opened with one call: the kind, the calibration and the poses are found, checked and reported.
// Formats and conventions: docs/reference/recordings.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "accrete/hal/motion_source.h"
#include "accrete/hal/stereo_source.h"

namespace accrete::hal {

enum class RecordingKind : std::uint8_t {
  kPlainFolder,  // left/ right/ stereo.yml
  kEuroc,        // mav0/cam0/data.csv ...
  kKittiGrey,    // image_0/ image_1/ calib.txt
  kKittiColour,  // image_2/ image_3/ calib.txt
};

[[nodiscard]] const char* to_string(RecordingKind kind);  // "plain folder", "EuRoC/ASL", ...

// What the lines of a pose file mean where that differs from the file's own convention.
struct PoseConvention {
  // Object: false T_left_object, true T_object_left. Camera: false T_world_left, true T_left_world.
  bool inverse = false;
  enum class Frame : std::uint8_t {
    kOfFile,  // TUM: the left camera; KITTI: camera 0; EuRoC: the body, joined with T_BS
    kLeft,    // the left camera of this rig
    kRight,   // the right camera of this rig
  } frame = Frame::kOfFile;
};

// Every member overrides something that is found or assumed otherwise; the flag of `accrete run` is in brackets.
struct RecordingOptions {
  std::filesystem::path calibration;    // [--calibration] OpenCV YAML or KITTI calib.txt
  std::filesystem::path poses;          // [--poses] TUM, KITTI or EuRoC; told apart by their columns
  std::optional<MotionMode> mode;       // [--motion object|camera]
  std::optional<PoseError> pose_error;  // [--pose-error absolute|incremental]
  PoseConvention pose_convention;       // [--pose-dir frame_from_world|world_from_frame, --pose-frame left|right]
  std::optional<double> pose_sigma_m;   // [--pose-sigma 0.3mm:1mrad] of every pose; absent: none, reported as default
  std::optional<double> pose_sigma_rad;
  std::int64_t max_pose_gap_ns = 50'000'000;  // [--max-pose-gap] longest gap between two poses that is interpolated
  std::optional<double> rate_hz;              // [--fps] instead of times.txt
  std::optional<RecordingKind> kind;  // [--kind plain|euroc|kitti-grey|kitti-colour] where a folder holds several
  bool ignore_poses = false;  // [--poses -, fifo: or udp:] they come from elsewhere: the motion source stays null
  bool require_poses = true;  // false: missing or broken poses are a warning and the motion source stays null
  // false: a rig that cannot be right, and a calibration for images of another size, are warnings: for whoever wants to
  // find out what is wrong. The rig is then the file's, with the size of the images.
  bool require_sane_rig = true;
};

// What was found, with which conventions; for `accrete info` and for the first lines of `accrete run`.
struct RecordingInfo {
  RecordingKind kind = RecordingKind::kPlainFolder;
  std::filesystem::path root;

  std::uint64_t frames = 0;     // pairs
  std::uint64_t left_only = 0;  // images without a partner
  std::uint64_t right_only = 0;
  int width_px = 0, height_px = 0, image_channels = 0, image_bits = 0;  // of the left images, as stored
  std::string image_format;                                             // "PNG", "JPEG", "PGM/PPM"

  std::string calibration_source, calibration_convention;
  int calibrated_width_px = 0, calibrated_height_px = 0;  // where the calibration states a size of the left images
  std::string times_source;
  Timestamp first, last;  // of the left images

  std::string poses_source, poses_convention;  // empty: there are none
  std::optional<MotionMode> mode;
  std::uint64_t poses = 0;             // lines read
  std::uint64_t frames_with_pose = 0;  // frames whose motion is known, by interpolation or exactly

  std::vector<std::string> guesses;   // each a sentence that names what overrides it
  std::vector<std::string> warnings;  // what will not be used, and why
};

// Opens `path`: on success `source` is configured (call start() next), `motion` answers for its frames, `info` is
// filled. On failure both are null, `info` holds what was found so far and the message says what, where and what to do.
// Status: kNotFound (folder, images, calibration or poses are not there), kInvalidArgument (a calibration or poses that
// cannot be right, sizes that differ, an option out of range), kDataLoss (truncated or garbled text, no readable
// image), kCapacityExceeded (a file, an image or a list beyond the limits in docs/reference/recordings.md),
// kUnsupported (a format that is not understood or was left out of this build).
Outcome open_recording(const std::filesystem::path& path, const RecordingOptions& options,
                       std::unique_ptr<StereoSource>& source, std::unique_ptr<MotionSource>& motion,
                       RecordingInfo& info);

// The motion of cameras with this rig from options.poses alone, for images that come from elsewhere; what was found
// goes to the members of `info` about poses. The times are those of the images' own clock. Status: kNotFound, kDataLoss
// and kInvalidArgument as above, the latter also for poses without times.
Outcome open_pose_file(const RecordingOptions& options, const StereoRig& rig, std::unique_ptr<MotionSource>& motion,
                       RecordingInfo& info);

// The same motion at every time, for a scene that stands still or a pose that somebody else updates.
// Status: kInvalidArgument when validate(motion) refuses it; then `source` is null.
Outcome constant_motion(const Motion& motion, std::unique_ptr<MotionSource>& source);

}  // namespace accrete::hal
