// KITTI odometry: rectified projections P_i = K [I | t_ci_c0]; all three components of t, not the first alone.
#include <array>
#include <cmath>

#include "calibration/calibration.h"
#include "text/file.h"
#include "text/parse.h"
#include "text/sentence.h"

namespace accrete::hal {
namespace {

struct Projection {
  std::array<double, 12> p{};
  std::size_t line = 0;  // 0: absent
};

Outcome read_row(const std::filesystem::path& path, const Row& row, Projection& out) {
  const std::string where = at_line(path, row.line) + ": " + std::string(row.fields[0].substr(0, 2));
  if (out.line != 0) return {Status::kDataLoss, where + " occurs a second time: remove one of the two"};
  if (row.field_count != 13)
    return {Status::kDataLoss, where + " has " + std::to_string(row.field_count - 1) +
                                   " numbers instead of 12 (a 3 x 4 projection, row after row): copy the file again"};
  for (std::size_t i = 0; i < 12; ++i)
    if (!parse(row.fields[i + 1], out.p[i]) || !std::isfinite(out.p[i]))
      return {Status::kInvalidArgument, where + ": value " + std::to_string(i + 1) + " is " +
                                            in_quotes(row.fields[i + 1]) + ", not a finite number: correct it"};
  out.line = row.line;
  return {};
}

Outcome convert(const std::filesystem::path& path, const Projection& projection, int number, Camera& camera,
                Vec3& t_ci_c0) {
  const auto& p = projection.p;
  const std::string where = at_line(path, projection.line) + ": P" + std::to_string(number);
  if (p[1] != 0 || p[4] != 0 || p[8] != 0 || p[9] != 0 || p[10] != 1)
    return {Status::kInvalidArgument,
            where +
                " is no projection of a rectified camera (fx 0 cx . / 0 fy cy . / 0 0 1 .): use KITTI's odometry "
                "calibration"};
  camera = {};
  camera.fx_px = p[0];
  camera.cx_px = p[2];
  camera.fy_px = p[5];
  camera.cy_px = p[6];
  if (!(camera.fx_px > 0 && camera.fy_px > 0))
    return {Status::kInvalidArgument, where + " has a focal length that is not positive: correct it"};
  t_ci_c0 = {(p[3] - p[2] * p[11]) / p[0], (p[7] - p[6] * p[11]) / p[5], p[11]};
  return {};
}

}  // namespace

Outcome read_kitti_calibration(const std::filesystem::path& path, KittiPair pair, Calibration& calibration) {
  std::string text;
  if (Outcome o = read_text(path, text); !o.ok()) return o;
  std::array<Projection, 4> projections;
  RowReader rows(text);
  for (Row row; rows.next(row);) {
    const std::string_view key = row.fields[0];
    if (key.size() == 3 && key[0] == 'P' && key[1] >= '0' && key[1] <= '3' && key[2] == ':')
      if (Outcome o = read_row(path, row, projections[static_cast<std::size_t>(key[1] - '0')]); !o.ok()) return o;
  }
  const int left = static_cast<int>(pair), right = left + 1;
  for (const int i : {left, right})
    if (projections[static_cast<std::size_t>(i)].line == 0)
      return {Status::kNotFound, path.string() + " has no line 'P" + std::to_string(i) + ": ...', the projection of " +
                                     "image_" + std::to_string(i) + ": add it, or give a calibration (--calibration)"};
  Vec3 t_l_c0{}, t_r_c0{};
  calibration = {};
  StereoRig& rig = calibration.rig;
  if (Outcome o = convert(path, projections[static_cast<std::size_t>(left)], left, rig.left, t_l_c0); !o.ok()) return o;
  if (Outcome o = convert(path, projections[static_cast<std::size_t>(right)], right, rig.right, t_r_c0); !o.ok())
    return o;
  rig.T_r_l.translation = t_r_c0 - t_l_c0;
  calibration.T_l_b.translation = t_l_c0;
  calibration.knows_body = true;
  calibration.source = path.string();
  calibration.convention = "KITTI odometry: rectified, P_i = K [I | t_ci_c0], cameras " + std::to_string(left) +
                           " and " + std::to_string(right) + ", metres, no distortion";
  calibration.complete = true;
  return check_rig(rig, calibration.source);
}

Outcome read_calibration_file(const std::filesystem::path& path, KittiPair pair, Calibration& calibration) {
  std::string text;
  if (Outcome o = read_text(path, text); !o.ok()) return o;
  RowReader rows(text);
  for (Row row; rows.next(row);)
    if (row.fields[0] == "P0:") return read_kitti_calibration(path, pair, calibration);
  const std::filesystem::path files[] = {path};
  return read_opencv_stereo(files, calibration);
}

}  // namespace accrete::hal
