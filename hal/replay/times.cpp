#include <cmath>

#include "replay/frame_list.h"
#include "text/file.h"
#include "text/sentence.h"
#include "text/stamps.h"

namespace accrete::hal {
namespace {

// One stamp a line; what follows it is ignored, some tools append the exposure.
Outcome read_times(const std::filesystem::path& path, StampColumn& column) {
  std::string text;
  if (Outcome o = read_text(path, text); !o.ok()) return o;
  RowReader rows(text);
  for (Row row; rows.next(row);) {
    if (column.values.size() == kMaxFrames)
      return {Status::kCapacityExceeded, path.string() + " has more than " + std::to_string(kMaxFrames) + " lines"};
    if (Outcome o = column.add(path, row, 0); !o.ok()) return o;
  }
  return {};
}

Outcome from_file(const std::filesystem::path& path, FrameList& list, RecordingInfo& info) {
  StampColumn column;
  if (Outcome o = read_times(path, column); !o.ok()) return o;
  std::vector<Timestamp> stamps;
  if (Outcome o = column.convert(path, stamps, info.guesses); !o.ok()) return o;
  const auto lines = list.lines_of_frames(stamps.size());
  if (!lines)
    return {Status::kInvalidArgument, path.string() + " has " + count(stamps.size(), "line") + " for " +
                                          count(list.frames.size(), "frame") +
                                          ": one line a frame is needed, or none of the file (--fps)"};
  for (std::size_t i = 0; i < list.frames.size(); ++i) {
    const std::size_t line = (*lines)[i];
    FrameFiles& frame = list.frames[i];
    frame.t_left = frame.t_right = stamps[line];
    if (i > 0 && frame.t_left <= list.frames[i - 1].t_left)
      return {Status::kInvalidArgument, at_line(path, column.lines[line]) + ": the time does not lie after that of " +
                                            list.frames[i - 1].left.filename().string() +
                                            ", the frame before: frames are read in the order of their names"};
  }
  info.times_source = path.string() + ", seconds";
  return {};
}

}  // namespace

Outcome assign_times(const Layout& layout, std::optional<double> rate_hz, FrameList& list, RecordingInfo& info) {
  const bool kitti = layout.kind == RecordingKind::kKittiGrey || layout.kind == RecordingKind::kKittiColour;
  const std::filesystem::path file = layout.root / "times.txt";
  std::error_code error;
  if (!rate_hz && std::filesystem::exists(file, error)) return from_file(file, list, info);
  // KITTI's cameras run at 10 Hz; 30 Hz is what cameras do when nobody asks them.
  const double rate = rate_hz.value_or(kitti ? 10.0 : 30.0);
  for (FrameFiles& frame : list.frames)
    frame.t_left.ns = frame.t_right.ns = std::llround(static_cast<double>(frame.union_index) * (1e9 / rate));
  info.times_source = number(rate) + " Hz";
  if (!rate_hz)
    info.guesses.push_back(file.string() + " is not there: " + number(rate) +
                           " Hz is assumed (--fps, or add the file)");
  return {};
}

}  // namespace accrete::hal
