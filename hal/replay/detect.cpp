#include <algorithm>

#include "replay/frame_list.h"
#include "text/file.h"

namespace accrete::hal {
namespace {

namespace fs = std::filesystem;

bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}
bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

// Everything that `path` may be; the preferred kind first.
std::vector<Layout> candidates(const fs::path& path) {
  std::vector<Layout> found;
  for (const fs::path& mav : {path / "mav0", path})
    if (is_there(mav / "cam0" / "data.csv")) {
      found.push_back({RecordingKind::kEuroc, mav, mav / "cam0", mav / "cam1"});
      break;
    }
  const auto pair = [&](RecordingKind kind, const char* left, const char* right) {
    if (is_folder(path / left) && is_folder(path / right)) found.push_back({kind, path, path / left, path / right});
  };
  pair(RecordingKind::kPlainFolder, "left", "right");
  pair(RecordingKind::kKittiColour, "image_2", "image_3");
  pair(RecordingKind::kKittiGrey, "image_0", "image_1");
  return found;
}

// A folder whose partner is missing, as a hint.
std::string half_of_a_pair(const fs::path& path) {
  constexpr const char* kPairs[][2] = {{"left", "right"}, {"image_0", "image_1"}, {"image_2", "image_3"}};
  for (const auto& pair : kPairs)
    for (const int i : {0, 1})
      if (is_folder(path / pair[i]) && !is_folder(path / pair[1 - i]))
        return (path / pair[i]).string() + " is there, but " + pair[1 - i] + "/ beside it is missing: add it";
  return {};
}

}  // namespace

const char* to_string(RecordingKind kind) {
  switch (kind) {
    case RecordingKind::kPlainFolder:
      return "plain folder";
    case RecordingKind::kEuroc:
      return "EuRoC/ASL";
    case RecordingKind::kKittiGrey:
      return "KITTI odometry, grey";
    case RecordingKind::kKittiColour:
      return "KITTI odometry, colour";
  }
  return "recording";
}

Outcome detect(const fs::path& path, std::optional<RecordingKind> wanted, Layout& layout,
               std::vector<std::string>& guesses) {
  if (Outcome o = reachable(path); !o.ok()) return o;
  if (!is_there(path)) return {Status::kNotFound, path.string() + " is not there: check the name of the recording"};
  if (!is_folder(path))
    return {Status::kNotFound, path.string() + " is a file: give the folder that holds the recording"};
  const std::vector<Layout> found = candidates(path);
  for (const Layout& candidate : found)
    if (!wanted || candidate.kind == *wanted) {
      layout = candidate;
      if (!wanted && found.size() > 1)
        guesses.push_back(path.string() + " holds several recordings: the " + to_string(layout.kind) +
                          " one is read (--kind)");
      return {};
    }
  if (std::string half = half_of_a_pair(path); !half.empty()) return {Status::kNotFound, std::move(half)};
  return {Status::kNotFound, path.string() + " is no recording" +
                                 (wanted ? std::string(" of the kind ") + to_string(*wanted) : std::string()) +
                                 ": looked for left/ and right/, mav0/cam0/data.csv (EuRoC), image_0/ and image_1/ or "
                                 "image_2/ and image_3/ (KITTI)"};
}

}  // namespace accrete::hal
