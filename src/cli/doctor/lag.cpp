#include "cli/doctor/lag.h"

#include <algorithm>
#include <cmath>

#include "cli/doctor/limits.h"
#include "cli/score/statistics.h"

namespace accrete::cli {
namespace {

struct RowMotion {
  double rows, motion;  // px: row difference of a pair, vertical motion of its left point
};

// Points of the left images that move, with the row differences of their pairs at both ends of the motion.
std::vector<RowMotion> row_motions(const Patient& patient) {
  std::vector<RowMotion> out;
  const auto& samples = patient.samples->list;
  const AlignedRig aligned = align(patient.rig);
  const Camera& camera = patient.change.swap ? patient.rig.right : patient.rig.left;
  const Mat3& R_a_c = patient.change.swap ? aligned.R_a_r : aligned.R_a_l;
  std::vector<std::vector<const AlignedPair*>> by_landmark(samples.size());
  for (std::size_t s = 0; s < samples.size(); ++s) by_landmark[s].resize(samples[s].left.landmarks.size());
  for (const AlignedPair& pair : patient.view.pairs)
    by_landmark[pair.sample][patient.change.swap ? pair.index_right : pair.index_left] = &pair;
  const auto pixel = [&](Pixel p) {
    if (patient.change.left_columns) p.x = camera.width_px - 1 - p.x;
    if (patient.change.left_rows) p.y = camera.height_px - 1 - p.y;
    return p;
  };
  for (std::size_t s = 0; s + 1 < samples.size(); ++s) {
    if (!samples[s].has_next) continue;
    for (const Pair& next : samples[s].next) {
      double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
      if (!to_aligned(camera, R_a_c, aligned.focal_px, pixel(next.a), x0, y0) ||
          !to_aligned(camera, R_a_c, aligned.focal_px, pixel(next.b), x1, y1))
        continue;
      if (std::hypot(x1 - x0, y1 - y0) < 1) continue;  // it stands still
      for (const AlignedPair* pair : {by_landmark[s][next.index_a], by_landmark[s + 1][next.index_b]})
        if (pair != nullptr && std::abs(pair->rows()) <= kWindowPx) out.push_back({pair->rows(), y1 - y0});
    }
  }
  return out;
}

// Mean of |rows - offset - lag * motion|, capped: what is no pair must not decide. The offset is the median.
double cost(const std::vector<RowMotion>& points, double lag) {
  constexpr double kCapPx = 5;
  std::vector<double> rest;
  rest.reserve(points.size());
  for (const RowMotion& p : points) rest.push_back(p.rows - lag * p.motion);
  const double offset = median(rest);
  double sum = 0;
  for (const double r : rest) sum += std::min(kCapPx, std::abs(r - offset));
  return sum / static_cast<double>(rest.size());
}

}  // namespace

bool Lag::clear() const {
  return points >= kFewestLagPoints && std::abs(frames) >= kMostLagFrames && gain <= kLagGain;
}

Lag lag_of(const Patient& patient) {
  Lag lag;
  const std::vector<RowMotion> points = row_motions(patient);
  std::vector<double> magnitudes;
  for (const RowMotion& p : points)
    if (std::abs(p.motion) >= kOnLinePx) magnitudes.push_back(std::abs(p.motion));
  lag.points = magnitudes.size();
  if (lag.points < kFewestLagPoints) return lag;
  lag.row_motion_px = median(magnitudes);
  const double none = cost(points, 0);
  double best = none;
  for (int i = -40; i <= 40; ++i) {
    const double c = cost(points, 0.05 * i);
    if (c >= best) continue;
    best = c;
    lag.frames = 0.05 * i;
  }
  lag.gain = best / std::max(none, 1e-9);
  return lag;
}

}  // namespace accrete::cli
