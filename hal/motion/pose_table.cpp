#include "motion/pose_table.h"

#include <algorithm>

#include "motion/pose_row.h"
#include "text/file.h"
#include "text/parse.h"
#include "text/sentence.h"
#include "text/stamps.h"

namespace accrete::hal {
namespace {

Outcome recognise(const std::filesystem::path& path, const Row& row, PoseFormat& format) {
  if (row.comma_separated && (row.field_count == 8 || row.field_count == 17 || row.field_count == kCovarianceColumns)) {
    format = PoseFormat::kEuroc;
  } else if (!row.comma_separated && (row.field_count == 8 || row.field_count == kCovarianceColumns)) {
    format = PoseFormat::kTum;
  } else if (!row.comma_separated && row.field_count == 12) {
    format = PoseFormat::kKitti;
  } else {
    return {Status::kUnsupported,
            at_line(path, row.line) +
                ": no pose format has these columns. Understood are TUM (t tx ty tz qx qy qz qw), "
                "KITTI (12 numbers) and EuRoC (t,px,py,pz,qw,qx,qy,qz[,9 more] with commas), the first and the last "
                "also with the 21 numbers of a covariance"};
  }
  return {};
}

// Drops the empty field that a comma at the end of a row makes.
void drop_trailing_comma(Row& row) {
  if (row.comma_separated && row.field_count > 1 && row.field_count <= Row::kMaxFields &&
      row.fields[row.field_count - 1].empty())
    --row.field_count;
}

// A header line that lacks its '#'.
bool is_header(const Row& row) {
  double value = 0;
  return row.comma_separated && !parse(row.fields[0], value);
}

Outcome put_in_order(PoseTable& table) {
  const auto earlier = [](const StampedPose& a, const StampedPose& b) { return a.t < b.t; };
  auto& poses = table.poses;
  if (!std::is_sorted(poses.begin(), poses.end(), earlier)) {
    std::stable_sort(poses.begin(), poses.end(), earlier);
    table.notices.push_back(table.source.string() + ": times out of order, sorted");
  }
  std::size_t kept = 0, repeated = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (kept > 0 && poses[i].t == poses[kept - 1].t) {
      if (!(poses[i].rotation == poses[kept - 1].rotation) || poses[i].translation != poses[kept - 1].translation)
        return {Status::kInvalidArgument, at_line(table.source, poses[i].line) + ": the same time as line " +
                                              std::to_string(poses[kept - 1].line) +
                                              ", but another pose: remove one of the two"};
      ++repeated;
      continue;
    }
    poses[kept++] = poses[i];
  }
  poses.resize(kept);
  if (repeated > 0)
    table.notices.push_back(table.source.string() + ": " + count(repeated, "repeated line") + " dropped");
  return {};
}

}  // namespace

Outcome read_poses(const std::filesystem::path& path, PoseTable& table) {
  table = {};
  table.source = path;
  std::string text;
  if (Outcome o = read_text(path, text); !o.ok()) return o;
  RowReader rows(text);
  StampColumn stamps;
  std::size_t columns = 0;
  bool first = true;
  for (Row row; rows.next(row); first = false) {
    drop_trailing_comma(row);
    if (first && is_header(row)) continue;
    if (columns == 0) {
      if (Outcome o = recognise(path, row, table.format); !o.ok()) return o;
      columns = row.field_count;
    }
    StampedPose pose;
    Outcome read;
    if (row.field_count != columns)
      read = {Status::kDataLoss, at_line(path, row.line) + " has another number of columns than the " +
                                     std::to_string(columns) + " before: truncated or damaged, copy the file again"};
    if (read.ok()) read = read_pose_row(path.string(), row, table.format, pose);
    // What a recording that was killed or met a full disk ends with.
    if (!read.ok() && table.format == PoseFormat::kEuroc && rows.at_end() && !text.ends_with('\n') &&
        !table.poses.empty()) {
      table.notices.push_back(at_line(path, row.line) + ": the last row is torn and left out");
      break;
    }
    if (!read.ok()) return read;
    if (table.poses.size() == kMaxPoses)
      return {Status::kCapacityExceeded,
              path.string() + " has more than " + std::to_string(kMaxPoses) + " poses: cut it to the recording"};
    if (table.format == PoseFormat::kTum)
      if (Outcome o = stamps.add(path, row, 0); !o.ok()) return o;
    table.poses.push_back(pose);
  }
  if (table.poses.empty()) return {Status::kDataLoss, path.string() + " has no poses: one line a pose is needed"};
  if (table.format == PoseFormat::kKitti) return {};
  if (table.format == PoseFormat::kTum) {
    std::vector<Timestamp> t;
    if (Outcome o = stamps.convert(path, t, table.notices); !o.ok()) return o;
    for (std::size_t i = 0; i < t.size(); ++i) table.poses[i].t = t[i];
  }
  return put_in_order(table);
}

}  // namespace accrete::hal
