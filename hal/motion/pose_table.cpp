#include "motion/pose_table.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "calibration/calibration.h"
#include "text/file.h"
#include "text/parse.h"
#include "text/sentence.h"
#include "text/stamps.h"

namespace accrete::hal {
namespace {

Outcome recognise(const std::filesystem::path& path, const Row& row, PoseFormat& format) {
  if (row.comma_separated && (row.field_count == 8 || row.field_count == 17)) {
    format = PoseFormat::kEuroc;
  } else if (!row.comma_separated && row.field_count == 8) {
    format = PoseFormat::kTum;
  } else if (!row.comma_separated && row.field_count == 12) {
    format = PoseFormat::kKitti;
  } else {
    return {Status::kUnsupported,
            at_line(path, row.line) +
                ": no pose format has these columns. Understood are TUM (t tx ty tz qx qy qz qw), "
                "KITTI (12 numbers) and EuRoC (t,px,py,pz,qw,qx,qy,qz[,9 more] with commas)"};
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

Outcome numbers(const std::filesystem::path& path, const Row& row, std::size_t first, std::span<double> out) {
  for (std::size_t i = 0; i < out.size(); ++i)
    if (!parse(row.fields[first + i], out[i]) || !std::isfinite(out[i]))
      return {Status::kInvalidArgument, at_line(path, row.line) + ": column " + std::to_string(first + i + 1) + " is " +
                                            in_quotes(row.fields[first + i]) +
                                            ", not a finite number: remove the line, or correct it"};
  return {};
}

Outcome quaternion(const std::filesystem::path& path, const Row& row, const Quaternion& raw, StampedPose& pose) {
  const auto q = normalized(raw);
  if (!q.ok()) {
    const double n = std::sqrt(raw.x * raw.x + raw.y * raw.y + raw.z * raw.z + raw.w * raw.w);
    return {Status::kInvalidArgument, at_line(path, row.line) + ": the quaternion has the length " + number(n, 3) +
                                          " and is no rotation: remove the line, or correct it"};
  }
  pose.rotation = q.value();
  return {};
}

Outcome read_row(const std::filesystem::path& path, const Row& row, PoseFormat format, StampedPose& pose) {
  pose.line = row.line;
  if (format == PoseFormat::kKitti) {
    std::array<double, 12> m{};
    if (Outcome o = numbers(path, row, 0, m); !o.ok()) return o;
    pose.translation = {m[3], m[7], m[11]};
    const Mat3 r{m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]};
    return check_rotation(r, at_line(path, row.line) + ": the 3 x 3 part", pose.rotation);
  }
  std::array<double, 7> v{};
  if (Outcome o = numbers(path, row, 1, v); !o.ok()) return o;
  pose.translation = {v[0], v[1], v[2]};
  if (format == PoseFormat::kTum) return quaternion(path, row, {v[3], v[4], v[5], v[6]}, pose);
  if (Outcome o = quaternion(path, row, {v[4], v[5], v[6], v[3]}, pose); !o.ok()) return o;
  if (!parse(row.fields[0], pose.t.ns) || !is_stamp(pose.t.ns))
    return {Status::kInvalidArgument, at_line(path, row.line) + ": the time " + in_quotes(row.fields[0]) +
                                          " is no integer: EuRoC has nanoseconds; write TUM lines for seconds"};
  return {};
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
    if (row.field_count != columns)
      return {Status::kDataLoss, at_line(path, row.line) + " has another number of columns than the " +
                                     std::to_string(columns) + " before: truncated or damaged, copy the file again"};
    if (table.poses.size() == kMaxPoses)
      return {Status::kCapacityExceeded,
              path.string() + " has more than " + std::to_string(kMaxPoses) + " poses: cut it to the recording"};
    StampedPose pose;
    if (Outcome o = read_row(path, row, table.format, pose); !o.ok()) return o;
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
