#include "cli/run/options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>

#include "cli/failure.h"
#include "cli/run/params_table.h"

namespace accrete::cli {
namespace {

using hal::RecordingKind;

[[noreturn]] void fail(const std::string& sentence) { throw Failure(ExitStatus::kUsage, sentence); }

// Which way round the poses of a file are; the two names without `frame` say the mode of motion as well.
void apply_direction(const std::string& text, hal::RecordingOptions& input) {
  const auto set = [&input, &text](MotionMode mode, bool inverse) {
    if (input.mode && *input.mode != mode) fail(fmt::format("--pose-dir {}: contradicts --motion", text));
    input.mode = mode;
    input.pose_convention.inverse = inverse;
  };
  if (text == "left_from_object") return set(MotionMode::kObjectMoves, false);
  if (text == "object_from_left") return set(MotionMode::kObjectMoves, true);
  if (text == "world_from_left") return set(MotionMode::kCameraMoves, false);
  if (text == "left_from_world") return set(MotionMode::kCameraMoves, true);
  if (!input.mode) fail(fmt::format("--pose-dir {}: say --motion object or --motion camera too", text));
  const bool frame_first = text == "frame_from_world";
  input.pose_convention.inverse = frame_first == (*input.mode == MotionMode::kCameraMoves);
}

}  // namespace

const char* to_string(Capacity capacity) {
  switch (capacity) {
    case Capacity::kAuto:
      return "auto";
    case Capacity::kSmall:
      return "small";
    case Capacity::kDefault:
      return "default";
    case Capacity::kLarge:
      return "large";
  }
  return "unknown";
}

void RunFlags::add_input(CLI::App& app) {
  app.add_option("recording", plain_.recording,
                 "A folder, v4l2:LEFT,RIGHT, libcamera:LEFT,RIGHT or synthetic:NAME; without it synthetic:box")
      ->option_text("RECORDING");
  const char* group = "How to read the recording (all of it is found by itself; these override)";
  const auto option = [&app, group](const char* name, auto& value, const char* kind, const char* help) {
    return app.add_option(name, value, help)->option_text(kind)->group(group);
  };
  option("--calibration", plain_.input.calibration, "FILE", "OpenCV stereo YAML or KITTI calib.txt");
  option("--poses", plain_.input.poses, "FILE",
         "TUM, KITTI or EuRoC, told apart by their columns; or lines that arrive while\n"
         "the program runs: - (standard input), fifo:PATH, udp:PORT, udp:HOST:PORT");
  option("--motion", motion_, "WHAT", "What moves: object or camera")->check(CLI::IsMember({"object", "camera"}));
  option("--pose-dir", pose_direction_, "DIRECTION",
         "left_from_object, object_from_left, world_from_left or left_from_world;\n"
         "with --motion also frame_from_world or world_from_frame")
      ->check(CLI::IsMember({"left_from_object", "object_from_left", "world_from_left", "left_from_world",
                             "frame_from_world", "world_from_frame"}));
  option("--pose-frame", pose_frame_, "EYE", "Whose poses they are: left or right")
      ->check(CLI::IsMember({"left", "right"}));
  option("--pose-error", pose_error_, "KIND", "absolute (robot, motion capture) or incremental (odometry)")
      ->check(CLI::IsMember({"absolute", "incremental"}));
  option("--pose-sigma", pose_sigma_, "L:A", "Standard deviations of every pose, with units: 0.3mm:1mrad");
  option("--max-pose-gap", max_pose_gap_, "TIME", "Longest gap between poses that is bridged (default 50ms)");
  option("--pose-wait", pose_wait_, "TIME", "Live poses: how long a frame waits for the pose after it (default 100ms)");
  option("--fps", rate_hz_, "HZ", "Frames per second, instead of the recording's times; of a camera")
      ->check(CLI::Range(1e-3, 1e5));
  option("--kind", kind_, "KIND", "plain, euroc, kitti-grey or kitti-colour, where a folder holds several")
      ->check(CLI::IsMember({"plain", "euroc", "kitti-grey", "kitti-colour"}));
  option("--frames", frames_, "A:B", "Use frames A to B only, both included, counted from 0; A: or :B");
  const char* scene = "Synthetic scene";
  app.add_option("--scene-frames", plain_.scene.frames, "Frames of the recording (default 60)")
      ->option_text("N")
      ->check(CLI::Range(1, 100000))
      ->group(scene);
  app.add_option("--scene-seed", plain_.scene.seed, "Seed of paint and noise (default 1)")
      ->option_text("N")
      ->group(scene);
  app.add_option("--scene-pose-noise", scene_pose_noise_, "Error of the reported poses, with units: 0.3mm:1mrad")
      ->option_text("L:A")
      ->group(scene);
}

void RunFlags::add_cameras(CLI::App& app) { cameras_.add(app); }

void RunFlags::add_accumulation(CLI::App& app) {
  const char* group = "How to accumulate";
  const auto option = [&app, group](const char* name, auto& value, const char* kind, const char* help) {
    return app.add_option(name, value, help)->option_text(kind)->group(group);
  };
  option("--depth-range", depth_range_, "NEAR:FAR",
         "Where the edges are, in metres: 0.4:0.9, or with units 400mm:900mm");
  option("--noise", plain_.params.extract.noise_sigma, "LEVELS",
         "Image noise, standard deviation in grey levels (default 2)")
      ->check(CLI::Range(0.01, 128.0));
  option("--exclude-box", excluded_, "BOX",
         "xmin,ymin,zmin,xmax,ymax,zmax in metres, object or world frame: accumulate\n"
         "nothing in there (a gripper that moves along); up to 8 times")
      ->allow_extra_args(false);
  option("--capacity", capacity_, "SIZE", "Of the store: small, default, large, or auto by the image size")
      ->check(CLI::IsMember({"auto", "small", "default", "large"}));
  option("--threads", plain_.threads, "N",
         "Of a step: 1, or 2 (each image in a thread of its own; the default where there are\n"
         "two processors). The results are the same")
      ->check(CLI::Range(1, 2));
  option("--set", settings_, "KEY=VALUE", "Any tunable by its name in config.yaml, stereo.min_psi=0.5; repeatable")
      ->allow_extra_args(false);
}

void RunFlags::add_output(CLI::App& app) {
  const char* group = "What to write";
  const auto option = [&app, group](const char* name, auto& value, const char* kind, const char* help) {
    return app.add_option(name, value, help)->option_text(kind)->group(group);
  };
  option("-o,--out", plain_.out, "FOLDER", "Default results/<UTC time>_<name>/, with a link results/latest");
  option("--resume", plain_.resume, "PATH", "Go on with a saved model: the file, or the folder of results that has it");
  app.add_flag("--save-model", plain_.save_model, "model.accrete among the results, for --resume")->group(group);
  app.add_flag("--full-covariance", plain_.full_covariance, "Both covariance matrices in edges.csv")->group(group);
  option("--overlay", plain_.overlay_every, "N", "Pictures of every N-th frame: primitives, matches, model")
      ->check(CLI::Range(1, 1000000));
  option("--min-existence", plain_.min_existence, "P", "Least existence probability in the PLY files (default 0)")
      ->check(CLI::Range(0.0, 1.0));
  app.add_flag("--json", plain_.json, "Print summary.json on standard output, and nothing else there")->group(group);
  app.add_flag("-q,--quiet", plain_.quiet, "Print warnings and errors only")->group(group);
}

RunOptions RunFlags::options() const {
  RunOptions o = plain_;
  if (!motion_.empty()) o.input.mode = motion_ == "object" ? MotionMode::kObjectMoves : MotionMode::kCameraMoves;
  if (!pose_error_.empty())
    o.input.pose_error = pose_error_ == "absolute" ? PoseError::kAbsolute : PoseError::kIncremental;
  if (!pose_direction_.empty()) apply_direction(pose_direction_, o.input);
  if (!pose_frame_.empty())
    o.input.pose_convention.frame =
        pose_frame_ == "left" ? hal::PoseConvention::Frame::kLeft : hal::PoseConvention::Frame::kRight;
  if (!pose_sigma_.empty()) {
    const PoseSigma sigma = parse_pose_sigma("--pose-sigma", pose_sigma_);
    o.input.pose_sigma_m = sigma.sigma_m;
    o.input.pose_sigma_rad = sigma.sigma_rad;
  }
  if (!scene_pose_noise_.empty()) {
    const PoseSigma sigma = parse_pose_sigma("--scene-pose-noise", scene_pose_noise_);
    o.scene.pose_noise_m = sigma.sigma_m;
    o.scene.pose_noise_rad = sigma.sigma_rad;
  }
  if (!max_pose_gap_.empty()) o.input.max_pose_gap_ns = parse_duration_ns("--max-pose-gap", max_pose_gap_);
  if (!pose_wait_.empty()) o.pose_wait_ns = parse_duration_ns("--pose-wait", pose_wait_);
  if (rate_hz_ > 0) o.input.rate_hz = rate_hz_;
  if (are_cameras(o.recording)) {
    o.cameras = cameras_.options(o.recording);
    o.cameras.calibration = o.input.calibration;
    o.cameras.rate_hz = rate_hz_;
  }
  static const std::map<std::string, RecordingKind> kKinds{{"plain", RecordingKind::kPlainFolder},
                                                           {"euroc", RecordingKind::kEuroc},
                                                           {"kitti-grey", RecordingKind::kKittiGrey},
                                                           {"kitti-colour", RecordingKind::kKittiColour}};
  if (!kind_.empty()) o.input.kind = kKinds.at(kind_);
  if (!frames_.empty()) o.frames = parse_frame_range(frames_);
  std::string culprit;  // the first flag that made the tunables impossible; a later one may have mended that
  const auto blame = [&](const char* flag, const std::string& value) {
    if (culprit.empty() && validate(o.params) != Status::kOk) culprit = fmt::format("{} {}", flag, value);
  };
  blame("--noise", fmt::format("{:g}", o.params.extract.noise_sigma));
  if (!depth_range_.empty()) {
    const DepthRange range = parse_depth_range(depth_range_);
    o.params.stereo.min_depth_m = static_cast<float>(range.min_m);
    o.params.stereo.max_depth_m = static_cast<float>(range.max_m);
    blame("--depth-range", depth_range_);
  }
  static const std::map<std::string, Capacity> kCapacities{{"auto", Capacity::kAuto},
                                                           {"small", Capacity::kSmall},
                                                           {"default", Capacity::kDefault},
                                                           {"large", Capacity::kLarge}};
  o.capacity = kCapacities.at(capacity_);
  o.excluded_given = !excluded_.empty();
  if (excluded_.size() > static_cast<std::size_t>(kMaxExcludedBoxes))
    fail(fmt::format("--exclude-box: {} boxes given, at most {} are possible", excluded_.size(), kMaxExcludedBoxes));
  for (const std::string& box : excluded_) {
    o.params.excluded[static_cast<std::size_t>(o.params.excluded_count++)] = parse_excluded_box(box);
    blame("--exclude-box", box);
  }
  for (const std::string& setting : settings_) {
    set_param(o.params, setting);
    blame("--set", setting);
  }
  if (validate(o.params) != Status::kOk)
    fail(fmt::format(
        "{}: out of its range, or it contradicts another tunable; docs/reference/program.md lists the ranges",
        culprit));
  return o;
}

}  // namespace accrete::cli
