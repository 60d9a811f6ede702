#include <cmath>

#include "calibration/yaml_file.h"
#include "motion/convention.h"
#include "motion/find.h"
#include "motion/pose_motion.h"
#include "motion/pose_table.h"
#include "text/sentence.h"

namespace accrete::hal {
namespace {

using Frame = PoseConvention::Frame;

// Where the poses' own camera or body is, seen from the left camera.
Outcome offset_of(const PoseTable& table, Frame frame, const Calibration& calibration, Transform<Left, Body>& T_l_f,
                  std::string& name) {
  T_l_f = {};
  if (frame == Frame::kRight) {
    name = "right";
    T_l_f = retag<Left, Body>(calibration.rig.T_r_l.inverse());
  } else if (frame == Frame::kLeft || table.format == PoseFormat::kTum) {
    name = "left";
  } else if (calibration.knows_body) {
    name = table.format == PoseFormat::kKitti ? "cam0" : "body";
    T_l_f = calibration.T_l_b;
  } else if (table.format == PoseFormat::kEuroc) {
    return {Status::kInvalidArgument,
            table.source.string() + " has poses of the body, but " + calibration.source +
                " does not say where the camera is on it (T_BS): say whose poses they are (--pose-frame left|right)"};
  } else {
    name = "left";
  }
  return {};
}

// A list without times: line by line to the frames.
Outcome stamp_by_frame(PoseTable& table, const FrameList& list, std::vector<std::string>& warnings) {
  const std::size_t n = table.poses.size();
  auto lines = list.lines_of_frames(n);
  if (!lines && n > list.union_count)
    return {Status::kInvalidArgument, table.source.string() + " has " + count(n, "line") + " for " +
                                          count(list.union_count, "frame") +
                                          " and the names of the images are no numbers that choose among them: cut it "
                                          "to the recording, or write TUM lines with times"};
  if (!lines) {
    lines.emplace();
    for (const FrameFiles& frame : list.frames) lines->push_back(frame.union_index);
    warnings.push_back(table.source.string() + " has " + count(n, "line") + " for " + count(list.union_count, "frame") +
                       ": they are taken for the first ones");
  }
  std::vector<StampedPose> poses;
  for (std::size_t i = 0; i < list.frames.size(); ++i) {
    if ((*lines)[i] >= n) continue;
    poses.push_back(table.poses[(*lines)[i]]);
    poses.back().t = list.frames[i].t_left;
  }
  table.poses = std::move(poses);
  return {};
}

// Our own recordings say beside the poses how their errors add up.
Outcome stated_error(const std::filesystem::path& path, PoseError& error) {
  std::error_code failure;
  YamlFile file;
  if (!std::filesystem::exists(path, failure) || !file.load(path).ok()) return {};
  const YamlEntry* entry = file.find({"pose_error"});
  if (entry == nullptr) return {};
  const std::string value = entry->values.size() == 1 ? entry->values[0] : "";
  if (value != "absolute" && value != "incremental")
    return {Status::kInvalidArgument, file.where(*entry) + " must be absolute or incremental"};
  error = value == "absolute" ? PoseError::kAbsolute : PoseError::kIncremental;
  return {};
}

std::string sentence_of(const PoseTable& table, MotionMode mode, bool inverse, const std::string& frame) {
  const char* format = table.format == PoseFormat::kTum     ? "TUM lines"
                       : table.format == PoseFormat::kKitti ? "KITTI 3 x 4 matrices"
                                                            : "EuRoC rows";
  const std::string map = mode == MotionMode::kObjectMoves ? "object" : "world";
  const bool frame_first = (mode == MotionMode::kObjectMoves) != inverse;
  return std::string(format) + ", T_" + (frame_first ? frame + "_" + map : map + "_" + frame) + ", metres; the " +
         (mode == MotionMode::kObjectMoves ? "object moves" : "cameras move");
}

Outcome check_coverage(const FrameList& list, const PoseTable& table, MotionSource& motion, RecordingInfo& info) {
  Motion ignored;
  Outcome first_failure;
  for (const FrameFiles& frame : list.frames) {
    Outcome o = motion.at(frame.t_left, ignored);
    if (o.ok())
      ++info.frames_with_pose;
    else if (first_failure.ok())
      first_failure = std::move(o);
  }
  if (info.frames_with_pose == list.frames.size()) return {};
  const std::uint64_t without = list.frames.size() - info.frames_with_pose;
  const std::string sentence = table.source.string() + ": " + count(without, "frame") + " of " +
                               std::to_string(list.frames.size()) + " without a pose (" + first_failure.message + ")";
  if (info.frames_with_pose == 0)
    return {Status::kNotFound, sentence + ". Are the times of poses and images of one clock (times.txt, --fps)?"};
  info.warnings.push_back(sentence);
  return {};
}

}  // namespace

Outcome check_pose_options(const RecordingOptions& options) {
  const auto bad = [](const char* flag, const std::string& rule) -> Outcome {
    return {Status::kInvalidArgument, std::string(flag) + ": " + rule};
  };
  for (const auto& sigma : {options.pose_sigma_m, options.pose_sigma_rad})
    if (sigma && !(*sigma >= 0 && std::isfinite(*sigma)))
      return bad("--pose-sigma", number(*sigma) + " is no standard deviation: give zero or more, in m and rad");
  if ((options.pose_sigma_m.value_or(0) > 0) != (options.pose_sigma_rad.value_or(0) > 0))
    return bad("--pose-sigma", "give both of position and rotation, or zero for both: an exact half of a pose is none");
  if (options.max_pose_gap_ns < 0) return bad("--max-pose-gap", "give zero or more");
  return {};
}

Outcome open_poses(const Layout& layout, const RecordingOptions& options, const Calibration& calibration,
                   const FrameList& list, std::unique_ptr<MotionSource>& motion, RecordingInfo& info) {
  PoseFile file;
  if (Outcome o = find_poses(layout, options, file, info.guesses); !o.ok()) return o;
  PoseTable table;
  if (Outcome o = read_poses(file.path, table); !o.ok()) return o;
  info.warnings.insert(info.warnings.end(), table.notices.begin(), table.notices.end());
  info.poses = table.poses.size();
  std::string frame;
  Transform<Left, Body> T_l_f;
  if (Outcome o = offset_of(table, options.pose_convention.frame, calibration, T_l_f, frame); !o.ok()) return o;
  if (table.format == PoseFormat::kKitti && list.frames.empty())
    return {Status::kInvalidArgument,
            file.path.string() +
                " has poses without times, which live images need: write TUM lines 't tx ty tz qx qy "
                "qz qw'"};
  if (table.format == PoseFormat::kKitti)
    if (Outcome o = stamp_by_frame(table, list, info.warnings); !o.ok()) return o;
  for (StampedPose& pose : table.poses) to_canonical(pose, file.mode, options.pose_convention.inverse, T_l_f);

  PoseMotionSettings settings;
  settings.mode = file.mode;
  // Motion capture measures absolutely; KITTI's and a plain folder's camera poses are taken for odometry.
  settings.error = file.mode == MotionMode::kObjectMoves || table.format == PoseFormat::kEuroc
                       ? PoseError::kAbsolute
                       : PoseError::kIncremental;
  if (table.format == PoseFormat::kEuroc)
    if (Outcome o = stated_error(file.path.parent_path() / "sensor.yaml", settings.error); !o.ok()) return o;
  settings.error = options.pose_error.value_or(settings.error);
  settings.covariance_is_default = !options.pose_sigma_m && !options.pose_sigma_rad;
  settings.covariance = diagonal_pose_covariance(options.pose_sigma_m.value_or(0), options.pose_sigma_rad.value_or(0));
  settings.max_gap_ns = options.max_pose_gap_ns;
  auto source = std::make_unique<PoseMotion>(std::move(table.poses), settings, file.path.string());
  table.poses.clear();
  if (Outcome o = check_coverage(list, table, *source, info); !o.ok()) return o;
  info.mode = file.mode;
  info.poses_source = file.path.string();
  info.poses_convention = sentence_of(table, file.mode, options.pose_convention.inverse, frame);
  motion = std::move(source);
  return {};
}

Outcome open_pose_file(const RecordingOptions& options, const StereoRig& rig, std::unique_ptr<MotionSource>& motion,
                       RecordingInfo& info) {
  motion.reset();
  if (options.poses.empty()) return {Status::kNotFound, "there is no motion: give a file of poses (--poses)"};
  if (Outcome o = check_pose_options(options); !o.ok()) return o;
  Calibration calibration;
  calibration.rig = rig;
  calibration.source = "the calibration";
  return open_poses({}, options, calibration, {}, motion, info);
}

}  // namespace accrete::hal
