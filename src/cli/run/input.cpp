#include "cli/run/input.h"

#include <fmt/format.h>

#include "accrete/hal/v4l2.h"
#include "cli/failure.h"
#include "cli/live/camera_flags.h"
#include "cli/write/snapshot.h"

namespace accrete::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSyntheticPrefix = "synthetic:";

std::string understood() {
  std::string scenes;
  for (const hal::SyntheticScene& scene : hal::synthetic_scenes())
    scenes += fmt::format("\n  synthetic:{:13} {}", scene.name, scene.description);
  return "understood are\n  a folder               plain (left/ right/ stereo.yml), EuRoC (mav0/), KITTI (image_0/ "
         "image_1/ calib.txt)\n  v4l2:LEFT,RIGHT        live cameras (accrete devices)\n"
         "  libcamera:LEFT,RIGHT   live cameras, as a Raspberry Pi has them" +
         scenes;
}

[[noreturn]] void fail(ExitStatus status, const std::string& sentence) { throw Failure(status, sentence); }

// The path itself where it cannot be followed: whoever opens it says why.
fs::path followed(const fs::path& path) {
  std::error_code unknown;
  const fs::path found = fs::weakly_canonical(path, unknown);
  return unknown ? path : found;
}

// The folder that a recording is called by: of a EuRoC recording that in which mav0 lies.
fs::path home_of(const fs::path& recording) {
  const fs::path root = followed(recording);
  return root.filename() == "mav0" ? root.parent_path() : root;
}

Input open_scene(const std::string& name, const RunOptions& options) {
  Input input;
  input.name = name.empty() ? "synthetic" : name;
  input.kind = "synthetic scene";
  if (const std::string poses = options.input.poses.string(); !poses.empty() && !hal::is_live_motion(poses))
    fail(ExitStatus::kUsage,
         fmt::format("synthetic:{}: the scene knows its own motion, a file of poses ({}) has no place here: leave out "
                     "--poses; --scene-pose-noise makes the scene's poses inexact",
                     input.name, poses));
  const hal::Outcome opened = hal::open_synthetic(name, options.scene, input.source, input.motion);
  if (opened.status == Status::kNotFound)
    fail(ExitStatus::kUsage, fmt::format("there is no synthetic scene '{}'; {}", name, understood()));
  if (!opened.ok()) fail(ExitStatus::kUsage, fmt::format("synthetic:{}: {}", name, opened.message));
  if (input.source->state() == hal::StereoSource::SourceState::kClosed)
    if (const hal::Outcome configured = input.source->configure(); !configured.ok())
      fail(ExitStatus::kInput, configured.message);
  Motion first;
  if (input.motion->at({0}, first).ok()) input.mode = first.mode;
  hal::Truth truth;
  if (hal::synthetic_truth(name, options.scene, truth).ok())
    for (const hal::TruthBox& box : truth.excluded) {
      ExcludedBox excluded;
      for (std::size_t i = 0; i < 3; ++i) {
        excluded.min_m[i] = static_cast<float>(box.min[i]);
        excluded.max_m[i] = static_cast<float>(box.max[i]);
      }
      input.own_gripper.push_back(excluded);
    }
  if (!input.own_gripper.empty() && !options.excluded_given)
    input.guesses.push_back(
        fmt::format("nothing is accumulated in the scene's gripper ({} boxes); --exclude-box names other boxes",
                    input.own_gripper.size()));
  return input;
}

Input open_folder(const RunOptions& options) {
  Input input;
  hal::RecordingInfo info;
  hal::RecordingOptions how = options.input;
  how.ignore_poses = hal::is_live_motion(options.input.poses.string());
  const hal::Outcome opened = hal::open_recording(options.recording, how, input.source, input.motion, info);
  if (!opened.ok()) {
    std::error_code unknown;
    const bool absent = !fs::exists(options.recording, unknown) && !unknown;
    fail(ExitStatus::kInput, absent ? fmt::format("{}; {}", opened.message, understood()) : opened.message);
  }
  input.kind = hal::to_string(info.kind);
  const fs::path home = home_of(info.root.empty() ? fs::path(options.recording) : info.root);
  input.name = home.filename().string();
  input.truth_folder = home / "truth";
  if (info.mode) input.mode = *info.mode;
  input.guesses = info.guesses;
  input.warnings = info.warnings;
  input.info = std::move(info);
  return input;
}

// Images and motion are opened apart from each other: poses may come from elsewhere than a file.
void open_camera_poses(const RunOptions& options, Input& input) {
  input.info.emplace();
  if (hal::is_live_motion(options.input.poses.string())) return;
  hal::RecordingInfo info;
  const hal::Outcome opened = hal::open_pose_file(options.input, input.source->rig(), input.motion, info);
  if (!opened.ok()) {
    if (options.input.require_poses) fail(ExitStatus::kInput, opened.message);
    input.warnings.push_back(opened.message);
  }
  if (info.mode) input.mode = *info.mode;
  input.guesses = info.guesses;
  input.warnings.insert(input.warnings.end(), info.warnings.begin(), info.warnings.end());
  input.info = std::move(info);
}

Input open_cameras(const RunOptions& options) {
  Input input;
  input.name = "live";
  input.kind = "live cameras";
  std::unique_ptr<hal::LiveSource> cameras;
  if (options.cameras.calibration.empty())
    fail(ExitStatus::kUsage,
         fmt::format("{}: live cameras need their calibration: --calibration stereo.yml", options.recording));
  const hal::Outcome opened = options.recording.starts_with(kV4l2Prefix)
                                  ? hal::open_v4l2(options.cameras, cameras)
                                  : hal::open_libcamera(options.cameras, cameras);
  if (!opened.ok())
    fail(opened.status == Status::kInvalidArgument ? ExitStatus::kUsage : ExitStatus::kInput, opened.message);
  input.cameras = watch(*cameras);
  input.live = true;
  input.source = std::move(cameras);
  open_camera_poses(options, input);
  return input;
}

std::string lens(const Camera& camera) {
  const char* model = camera.distortion == Distortion::kNone            ? "pinhole"
                      : camera.distortion == Distortion::kKannalaBrandt ? "Kannala-Brandt"
                                                                        : "Brown-Conrady";
  return fmt::format("{} x {}, f {:.1f} px, {}", camera.width_px, camera.height_px, camera.fx_px, model);
}

}  // namespace

std::optional<std::string> synthetic_name(const std::string& recording) {
  if (recording == "synthetic") return "box";
  if (!recording.starts_with(kSyntheticPrefix)) return std::nullopt;
  return recording.substr(kSyntheticPrefix.size());
}

namespace {

Input open_images(const RunOptions& options) {
  if (const auto scene = synthetic_name(options.recording)) return open_scene(*scene, options);
  const auto colon = options.recording.find(':');
  std::error_code unknown;
  if (colon != std::string::npos && !fs::exists(options.recording, unknown)) {
    const std::string kind = options.recording.substr(0, colon);
    if (are_cameras(options.recording)) return open_cameras(options);
    fail(ExitStatus::kUsage,
         fmt::format("{}: '{}' is no kind of recording; {}", options.recording, kind, understood()));
  }
  return open_folder(options);
}

// Poses that arrive while the program runs, in the place of whatever the images brought along.
void take_live_poses(Input& input, const RunOptions& options) {
  const std::string where = options.input.poses.string();
  hal::LiveMotionOptions live;
  live.mode = options.input.mode.value_or(MotionMode::kObjectMoves);
  live.error = options.input.pose_error;
  live.inverse = options.input.pose_convention.inverse;
  if (options.input.pose_convention.frame == hal::PoseConvention::Frame::kRight)
    live.T_l_f = retag<Left, Body>(input.source->rig().T_r_l.inverse());
  live.sigma_m = options.input.pose_sigma_m;
  live.sigma_rad = options.input.pose_sigma_rad;
  live.max_gap_ns = options.input.max_pose_gap_ns;
  live.wait_ns = options.pose_wait_ns;
  std::unique_ptr<hal::LiveMotion> motion;
  if (const hal::Outcome opened = hal::open_live_motion(where, live, motion); !opened.ok())
    fail(opened.status == Status::kInvalidArgument ? ExitStatus::kUsage : ExitStatus::kInput, opened.message);
  if (!options.input.mode)
    input.guesses.push_back(
        fmt::format("{}: taken for the motion of the object (--motion object|camera)", motion->name()));
  input.mode = live.mode;
  input.live_poses = motion.get();
  input.motion = std::move(motion);
}

}  // namespace

Input open_input(const RunOptions& options) {
  Input input = open_images(options);
  if (const std::uint64_t size = input.source->size(); size > 0 && options.frames.first >= size)
    fail(ExitStatus::kUsage, fmt::format("--frames begins at {}: the recording has {} frames, 0 to {}",
                                         options.frames.first, size, size - 1));
  if (hal::is_live_motion(options.input.poses.string())) take_live_poses(input, options);
  return input;
}

std::string name_of_recording(const std::string& recording) { return home_of(recording).filename().string(); }

fs::path truth_folder_of(const std::string& recording) { return home_of(recording) / "truth"; }

void refuse_as_results(const fs::path& out, const Input& input, const fs::path& truth) {
  if (!input.info || input.cameras) return;
  std::error_code unknown;
  for (const fs::path& kept : {input.info->root, input.truth_folder.parent_path(), input.truth_folder, truth})
    if (fs::equivalent(out, kept, unknown))
      fail(ExitStatus::kUsage,
           fmt::format("{}: results there would mix with the recording, or replace its truth: choose "
                       "another folder with --out, {} for one",
                       out.string(), (input.truth_folder.parent_path() / "results").string()));
}

std::string live_poses_sentence(const hal::LiveMotionCounters& c) {
  return fmt::format(
      "{} poses came, {} late, {} back in time, {} lines malformed, {} writers gone; {} frames with a pose, {} before "
      "the "
      "first one, {} without",
      c.poses, c.late, c.backwards, c.malformed, c.interrupted, c.served, c.early, c.missing);
}

Truth truth_of(const Input& input, const RunOptions& options) {
  const auto scene = synthetic_name(options.recording);
  if (input.cameras) return {};
  if (!scene) return read_truth(input.truth_folder);
  hal::Truth exact;
  if (const hal::Outcome outcome = hal::synthetic_truth(*scene, options.scene, exact); !outcome.ok())
    fail(ExitStatus::kInput, outcome.message);
  Truth truth;
  const std::string name = "truth of synthetic:" + *scene;
  truth.edges = parse_segments(hal::to_csv(exact.edges), name);
  if (!exact.extra.empty()) truth.extra = parse_segments(hal::to_csv(exact.extra), name);
  if (!exact.background.empty()) truth.background = parse_segments(hal::to_csv(exact.background), name);
  truth.bbox = Box{exact.bounds.min, exact.bounds.max};
  return truth;
}

std::vector<std::string> describe(const Input& input) {
  std::vector<std::string> lines;
  const StereoRig& rig = input.source->rig();
  const auto line = [&lines](const char* label, const std::string& text) {
    lines.push_back(fmt::format("{:13}{}", label, text));
  };
  line("recording", fmt::format("{} ({})", input.name, input.kind));
  if (input.cameras) {
    for (const auto& [label, text] : input.cameras->lines) line(label.c_str(), text);
  } else if (input.info) {
    const hal::RecordingInfo& i = *input.info;
    std::string images =
        fmt::format("{} pairs, {} x {}, {} channel{} of {} bits, {}", i.frames, i.width_px, i.height_px,
                    i.image_channels, i.image_channels == 1 ? "" : "s", i.image_bits, i.image_format);
    if (i.left_only + i.right_only > 0)
      images += fmt::format("; without partner {} left, {} right", i.left_only, i.right_only);
    line("images", images);
    line("times", fmt::format("{}; {:.3f} s in all", i.times_source, to_seconds(i.last - i.first)));
    line("calibration", fmt::format("{}; {}", i.calibration_source, i.calibration_convention));
  } else {
    line("images",
         fmt::format("{} pairs, {} x {}, rendered", input.source->size(), rig.left.width_px, rig.left.height_px));
  }
  line("left camera", lens(rig.left));
  line("right camera", fmt::format("{}; baseline {:.2f} mm", lens(rig.right), 1e3 * rig.baseline_m()));
  if (input.cameras && !input.info->poses_source.empty())
    line("poses",
         fmt::format("{}; {}; {} lines", input.info->poses_source, input.info->poses_convention, input.info->poses));
  else if (input.info && !input.info->poses_source.empty())
    line("poses", fmt::format("{}; {}; {} lines, {} of {} frames covered", input.info->poses_source,
                              input.info->poses_convention, input.info->poses, input.info->frames_with_pose,
                              input.info->frames));
  if (input.live_poses != nullptr) line("poses", input.live_poses->name());
  line("motion", input.motion ? fmt::format("the {}; edges stand still in the {} frame",
                                            input.mode == MotionMode::kObjectMoves ? "object moves" : "cameras move",
                                            frame_text(input.mode))
                              : "unknown: there are no poses");
  for (const std::string& guess : input.guesses) line("guess", guess);
  return lines;
}

}  // namespace accrete::cli
