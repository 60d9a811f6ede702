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

// Points of the left images with the row differences of their pairs, where the motion begins and where it ends. An eye
// that is late shows the right one at the end of the motion it has just missed; seen from a late left eye, that is the
// motion which begins there.
struct RowMotions {
  std::vector<RowMotion> begin, end;
};

RowMotions row_motions(const Patient& patient) {
  RowMotions out;
  const auto& samples = patient.samples->list;
  const AlignedRig aligned = align(patient.rig);
  const Camera& camera = patient.change.swap ? patient.rig.right : patient.rig.left;
  const Mat3& R_a_c = patient.change.swap ? aligned.R_a_r : aligned.R_a_l;
  std::vector<std::vector<const AlignedPair*>> by_landmark(samples.size());
  for (std::size_t s = 0; s < samples.size(); ++s) by_landmark[s].resize(samples[s].left.landmarks.size());
  for (const AlignedPair& pair : patient.view.pairs)
    by_landmark[pair.sample][patient.change.swap ? pair.index_right : pair.index_left] = &pair;
  const double sign = patient.change.swap ? -1 : 1;  // rows: that of the tracked eye less that of the other
  const auto aligned_y = [&](Pixel p, double& y) {
    if (patient.change.left_columns) p.x = camera.width_px - 1 - p.x;
    if (patient.change.left_rows) p.y = camera.height_px - 1 - p.y;
    double x = 0;
    return to_aligned(camera, R_a_c, aligned.focal_px, p, x, y);
  };
  for (std::size_t s = 0; s + 1 < samples.size(); ++s) {
    if (!samples[s].has_next) continue;
    for (const Pair& next : samples[s].next) {
      double y0 = 0, y1 = 0;
      if (!aligned_y(next.a, y0) || !aligned_y(next.b, y1)) continue;
      const auto offer = [&](const AlignedPair* pair, std::vector<RowMotion>& list) {
        if (pair != nullptr && std::abs(pair->rows()) <= kWindowPx) list.push_back({sign * pair->rows(), y1 - y0});
      };
      offer(by_landmark[s][next.index_a], out.begin);
      offer(by_landmark[s + 1][next.index_b], out.end);
    }
  }
  return out;
}

// Farther than the window, a late eye's pair would not be looked at.
bool moves(const RowMotion& p) { return std::abs(p.motion) >= kLeastRowMotionPx && std::abs(p.motion) <= kWindowPx; }
bool stands(const RowMotion& p) { return std::abs(p.motion) < 0.5; }

// The best lag among those of one sign. The offset between the rows is what points that stand have, where there are
// enough of them: it must not be taken for a lag, nor the other way round.
Lag best_lag(const std::vector<RowMotion>& points, double sign) {
  constexpr std::size_t kEnoughStanding = 20;
  constexpr double kCapPx = 5;  // what is no pair must not decide
  std::vector<double> standing, magnitudes;
  for (const RowMotion& p : points) {
    if (stands(p)) standing.push_back(p.rows);
    if (moves(p)) magnitudes.push_back(std::abs(p.motion));
  }
  Lag lag;
  lag.points = magnitudes.size();
  if (lag.points < kFewestLagPoints) return lag;
  lag.row_motion_px = median(magnitudes);
  const auto cost = [&](double frames) {
    std::vector<double> rest;
    for (const RowMotion& p : points)
      if (moves(p)) rest.push_back(p.rows - frames * p.motion);
    const double offset = median(standing.size() >= kEnoughStanding ? standing : rest);
    double sum = 0;
    for (const double r : rest) sum += std::min(kCapPx, std::abs(r - offset));
    return sum / static_cast<double>(rest.size());
  };
  const double none = cost(0);
  double best = none;
  for (int i = 1; i <= 40; ++i) {
    const double frames = sign * 0.05 * i, c = cost(frames);
    if (c >= best) continue;
    best = c;
    lag.frames = frames;
  }
  lag.gain = best / std::max(none, 1e-9);
  return lag;
}

}  // namespace

bool Lag::clear() const { return points >= kFewestLagPoints && std::abs(frames) >= kMostLagFrames && gain <= kLagGain; }

Lag lag_of(const Patient& patient) {
  const RowMotions motions = row_motions(patient);
  const Lag right = best_lag(motions.end, 1), left = best_lag(motions.begin, -1);
  return left.gain < right.gain ? left : right;
}

}  // namespace accrete::cli
