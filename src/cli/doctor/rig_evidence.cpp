#include "cli/doctor/rig_evidence.h"

#include <algorithm>
#include <cmath>

#include "cli/score/statistics.h"

namespace accrete::cli {
namespace {

Pixel changed(const Camera& camera, Pixel p, bool columns, bool rows) {
  if (columns) p.x = camera.width_px - 1 - p.x;
  if (rows) p.y = camera.height_px - 1 - p.y;
  return p;
}

}  // namespace

bool to_aligned(const Camera& camera, const Mat3& R_a_c, double focal_px, const Pixel& p, double& x, double& y) {
  const Result<Normalized> ray = unproject(camera, p);
  if (!ray.ok()) return false;
  const Vec3 d = R_a_c * Vec3{ray.value().x, ray.value().y, 1};
  if (!(d[2] > 0.1 * norm(d))) return false;  // 84 degrees off the axis: no place in the aligned image
  x = focal_px * d[0] / d[2];
  y = focal_px * d[1] / d[2];
  return true;
}

RigView look(const std::vector<std::vector<Pair>>& stereo, const StereoRig& rig, const ImageChange& change) {
  RigView view;
  const AlignedRig aligned = align(rig);
  for (std::size_t s = 0; s < stereo.size(); ++s)
    for (const Pair& pair : stereo[s]) {
      ++view.all;
      Pixel l = changed(rig.left, pair.a, change.left_columns, change.left_rows);
      Pixel r = changed(rig.right, pair.b, change.right_columns, change.right_rows);
      AlignedPair out;
      out.sample = static_cast<std::uint32_t>(s);
      out.index_left = pair.index_a;
      out.index_right = pair.index_b;
      out.brightness_left = pair.brightness_a;
      out.brightness_right = pair.brightness_b;
      if (change.swap) {
        std::swap(l, r);
        std::swap(out.index_left, out.index_right);
        std::swap(out.brightness_left, out.brightness_right);
      }
      if (to_aligned(rig.left, aligned.R_a_l, aligned.focal_px, l, out.x_l, out.y_l) &&
          to_aligned(rig.right, aligned.R_a_r, aligned.focal_px, r, out.x_r, out.y_r))
        view.pairs.push_back(out);
    }
  return view;
}

RigEvidence weigh(const RigView& view) {
  RigEvidence e;
  e.pairs = view.all;
  if (view.all == 0) return e;
  std::vector<double> rows, magnitudes;
  double score = 0, on_line = 0, negative = 0;
  for (const AlignedPair& p : view.pairs) {
    const double dy = p.rows();
    if (std::abs(dy) > kWindowPx) continue;
    rows.push_back(dy);
    magnitudes.push_back(std::abs(dy));
    if (std::abs(dy) > kOnLinePx) continue;
    ++on_line;
    if (p.disparity() < -1) {
      ++negative;
    } else {
      score += 1 - dy * dy / (kOnLinePx * kOnLinePx);
    }
  }
  const auto n = static_cast<double>(view.all);
  e.score = score / n;
  e.on_line = on_line / n;
  e.negative = on_line > 0 ? negative / on_line : 0;
  if (rows.empty()) return e;
  e.median_rows_px = percentile(rows, 50);
  e.median_abs_rows_px = percentile(magnitudes, 50);
  e.p90_abs_rows_px = percentile(magnitudes, 90);
  return e;
}

}  // namespace accrete::cli
