#include "calibration/find.h"

#include <algorithm>

namespace accrete::hal {
namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

// The YAML files that stand in `folder`, at most two: with two it is a guess already.
std::vector<fs::path> yaml_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator i(folder, error), end; !error && i != end && files.size() < 2; i.increment(error)) {
    const fs::path extension = i->path().extension();
    if (extension == ".yml" || extension == ".yaml") files.push_back(i->path());
  }
  return files;
}

Outcome find_plain(const fs::path& root, Calibration& calibration) {
  for (const char* name : {"stereo.yml", "stereo.yaml"})
    if (is_there(root / name)) {
      const fs::path files[] = {root / name};
      return read_opencv_stereo(files, calibration);
    }
  for (const char* extension : {".yml", ".yaml"}) {
    const fs::path files[] = {root / (std::string("intrinsics") + extension),
                              root / (std::string("extrinsics") + extension)};
    if (is_there(files[0]) && is_there(files[1])) return read_opencv_stereo(files, calibration);
  }
  if (is_there(root / "calib.txt")) return read_kitti_calibration(root / "calib.txt", KittiPair::kGrey, calibration);
  if (const auto files = yaml_files(root); files.size() == 1) {
    Outcome o = read_opencv_stereo(files, calibration);
    if (o.ok()) calibration.guesses.push_back(files[0].string() + ": taken for the calibration (--calibration)");
    return o;
  }
  return {Status::kNotFound, root.string() +
                                 " has no calibration: put stereo.yml (OpenCV: image_width image_height M1 "
                                 "D1 M2 D2 R T) or calib.txt (KITTI) there, or give one (--calibration)"};
}

Outcome find_kitti(const fs::path& root, KittiPair pair, Calibration& calibration) {
  if (is_there(root / "calib.txt")) return read_kitti_calibration(root / "calib.txt", pair, calibration);
  return {Status::kNotFound,
          root.string() + " has no calib.txt (lines 'P0: 12 numbers' ...): add it, or give one (--calibration)"};
}

Outcome find_euroc(const Layout& layout, Calibration& calibration) {
  const fs::path left = layout.left / "sensor.yaml", right = layout.right / "sensor.yaml";
  for (const fs::path& file : {left, right})
    if (!is_there(file))
      return {Status::kNotFound, file.string() + " is not there: add it, or give a calibration (--calibration)"};
  return read_euroc_pair(left, right, calibration);
}

}  // namespace

Outcome find_calibration(const Layout& layout, const fs::path& override_file, Calibration& calibration) {
  const KittiPair pair = layout.kind == RecordingKind::kKittiColour ? KittiPair::kColour : KittiPair::kGrey;
  if (!override_file.empty()) return read_calibration_file(override_file, pair, calibration);
  switch (layout.kind) {
    case RecordingKind::kPlainFolder:
      return find_plain(layout.root, calibration);
    case RecordingKind::kEuroc:
      return find_euroc(layout, calibration);
    case RecordingKind::kKittiGrey:
    case RecordingKind::kKittiColour:
      return find_kitti(layout.root, pair, calibration);
  }
  return {Status::kUnsupported, layout.root.string() + " is of no kind that has a calibration"};
}

}  // namespace accrete::hal
