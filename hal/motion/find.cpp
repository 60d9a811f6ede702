#include "motion/find.h"

#include "text/sentence.h"

namespace accrete::hal {
namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

MotionMode usual_mode(RecordingKind kind) {
  return kind == RecordingKind::kPlainFolder ? MotionMode::kObjectMoves : MotionMode::kCameraMoves;
}

const char* name_of(MotionMode mode) { return mode == MotionMode::kObjectMoves ? "object" : "camera"; }

Outcome from_option(const Layout& layout, const RecordingOptions& options, PoseFile& file,
                    std::vector<std::string>& guesses) {
  file.path = options.poses;
  if (options.mode) {
    file.mode = *options.mode;
    return {};
  }
  const std::string name = options.poses.filename().string();
  const bool object = name.find("object") != std::string::npos;
  const bool camera = name.find("camera") != std::string::npos || name.find("world") != std::string::npos;
  file.mode = object == camera ? usual_mode(layout.kind) : object ? MotionMode::kObjectMoves : MotionMode::kCameraMoves;
  guesses.push_back(options.poses.string() + ": taken for the motion of the " + name_of(file.mode) +
                    " (--motion object|camera)");
  return {};
}

Outcome find_plain(const fs::path& root, std::optional<MotionMode> mode, PoseFile& file,
                   std::vector<std::string>& guesses) {
  const fs::path object = root / "object_poses.txt", camera = root / "poses_camera.txt";
  const bool want_object = mode != MotionMode::kCameraMoves, want_camera = mode != MotionMode::kObjectMoves;
  const bool has_object = want_object && is_there(object), has_camera = want_camera && is_there(camera);
  if (!has_object && !has_camera)
    return {Status::kNotFound,
            root.string() + " has no poses: put " + (want_object ? "object_poses.txt (T_left_object)" : "") +
                (want_object && want_camera ? " or " : "") + (want_camera ? "poses_camera.txt (T_world_left)" : "") +
                " there, TUM lines 't tx ty tz qx qy qz qw', or give a file (--poses)"};
  file = has_object ? PoseFile{object, MotionMode::kObjectMoves} : PoseFile{camera, MotionMode::kCameraMoves};
  if (has_object && has_camera)
    guesses.push_back(root.string() +
                      " has object_poses.txt and poses_camera.txt: the object is taken to move "
                      "(--motion camera)");
  return {};
}

// Ground truth where EuRoC has it, and where TUM-VI and others put theirs. An object that moves before standing cameras
// is nothing that EuRoC knows: our own recordings have it in a folder of its own.
Outcome find_euroc(const fs::path& mav, PoseFile& file) {
  if (is_there(mav / "object0" / "data.csv")) {
    file = {mav / "object0" / "data.csv", MotionMode::kObjectMoves};
    return {};
  }
  for (const char* folder : {"state_groundtruth_estimate0", "gt", "mocap0"})
    if (is_there(mav / folder / "data.csv")) {
      file = {mav / folder / "data.csv", MotionMode::kCameraMoves};
      return {};
    }
  return {Status::kNotFound, mav.string() +
                                 " has no object0/data.csv, state_groundtruth_estimate0/data.csv, "
                                 "gt/data.csv or mocap0/data.csv: add one, or give poses (--poses)"};
}

Outcome find_kitti(const fs::path& root, PoseFile& file) {
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(root, error);
  const fs::path beside = whole.parent_path().parent_path() / "poses" / (whole.filename().string() + ".txt");
  for (const fs::path& path : {root / "poses.txt", beside})
    if (is_there(path)) {
      file = {path, MotionMode::kCameraMoves};
      return {};
    }
  return {Status::kNotFound, (root / "poses.txt").string() + " is not there, nor is " + beside.string() +
                                 ": add one (12 numbers a line), or give poses (--poses)"};
}

}  // namespace

Outcome find_poses(const Layout& layout, const RecordingOptions& options, PoseFile& file,
                   std::vector<std::string>& guesses) {
  if (!options.poses.empty()) return from_option(layout, options, file, guesses);
  Outcome o;
  switch (layout.kind) {
    case RecordingKind::kPlainFolder:
      return find_plain(layout.root, options.mode, file, guesses);
    case RecordingKind::kEuroc:
      o = find_euroc(layout.root, file);
      break;
    case RecordingKind::kKittiGrey:
    case RecordingKind::kKittiColour:
      o = find_kitti(layout.root, file);
      break;
  }
  if (options.mode) file.mode = *options.mode;
  return o;
}

}  // namespace accrete::hal
