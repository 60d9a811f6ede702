// Which files make which frames of a recording, and when they were taken.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "accrete/hal/recording.h"

namespace accrete::hal {

// 9 hours at 30 Hz.
inline constexpr std::size_t kMaxFrames = 1'000'000;

struct FrameFiles {
  std::filesystem::path left, right;
  Timestamp t_left, t_right;
  // Which line of a file without names or stamps may belong to it, from 0: counted over all names of both folders, over
  // those of the left one, or by the number that is the file's name (-1: it is none).
  std::size_t union_index = 0;
  std::size_t left_index = 0;
  std::int64_t number = -1;
};

struct FrameList {
  std::vector<FrameFiles> frames;  // pairs, in order
  std::size_t left_only = 0, right_only = 0;
  std::size_t union_count = 0, left_count = 0;

  // The line of each frame in a file of `lines` lines; nothing when no way of counting fits.
  [[nodiscard]] std::optional<std::vector<std::size_t>> lines_of_frames(std::size_t lines) const;
};

// A recording's place on disk.
struct Layout {
  RecordingKind kind = RecordingKind::kPlainFolder;
  std::filesystem::path root;         // EuRoC: the folder mav0
  std::filesystem::path left, right;  // the folders of the two cameras
};

// Finds the kind, or checks that `wanted` is there. Status: kNotFound, with what was looked for.
Outcome detect(const std::filesystem::path& path, std::optional<RecordingKind> wanted, Layout& layout,
               std::vector<std::string>& guesses);

// Pairs by name, without the extension: NAME.png and NAME.jpg are one frame. In the order of people: 9 before 10.
// Status: kNotFound (no images, or no pair), kInvalidArgument (one name twice in a folder), kCapacityExceeded.
Outcome list_folders(const Layout& layout, FrameList& list);
// Pairs by the stamps of the two data.csv: equal, or nearest within half a period and 8 ms. Status: as list_folders and
// read_text; kDataLoss (a row without a stamp, or with a file name that leaves the folder).
Outcome list_euroc(const Layout& layout, FrameList& list, std::vector<std::string>& warnings);

// Stamps of folders and KITTI: from times.txt, else from `rate_hz`, else 30 Hz (KITTI: 10 Hz) with a guess. Status:
// those of read_text and StampColumn; kInvalidArgument (not increasing, a number of lines that fits no way of
// counting).
Outcome assign_times(const Layout& layout, std::optional<double> rate_hz, FrameList& list, RecordingInfo& info);

// Digits compare as numbers. A total order: ties go to the plain comparison.
[[nodiscard]] bool natural_less(const std::string& a, const std::string& b);

}  // namespace accrete::hal
