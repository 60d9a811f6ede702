#include "cli/doctor/pose_evidence.h"

#include <algorithm>
#include <cmath>

#include "cli/score/statistics.h"

namespace accrete::cli {
namespace {

constexpr double kAgreePx = 2;
constexpr std::size_t kFewest = 12;  // twice the unknowns of a motion

const Camera& tracked_camera(const StereoRig& rig, bool right) { return right ? rig.right : rig.left; }

}  // namespace

Tracks track(const Samples& samples, const RigView& view, const StereoRig& rig, const ImageChange& change,
             MotionMode mode) {
  Tracks tracks;
  tracks.tracks_right = change.swap;
  const Camera& camera = tracked_camera(rig, change.swap);
  tracks.focal_px = 0.5 * (camera.fx_px + camera.fy_px);
  const AlignedRig aligned = align(rig);
  const Mat3 R_c_a = transposed(change.swap ? aligned.R_a_r : aligned.R_a_l);

  std::vector<std::vector<const AlignedPair*>> of_sample(samples.list.size());
  for (const AlignedPair& pair : view.pairs) of_sample[pair.sample].push_back(&pair);
  for (std::size_t s = 0; s + 1 < samples.list.size(); ++s) {
    const Sample& sample = samples.list[s];
    if (!sample.has_next) continue;
    ++tracks.tried;
    // By the landmark of the left image as it lies on disk: the tracked one.
    std::vector<const AlignedPair*> by_landmark(sample.left.landmarks.size(), nullptr);
    for (const AlignedPair* pair : of_sample[s]) by_landmark[change.swap ? pair->index_right : pair->index_left] = pair;
    std::vector<TrackedPoint> points;
    std::vector<double> flows;
    for (const Pair& next : sample.next) {
      const AlignedPair* pair = by_landmark[next.index_a];
      if (pair == nullptr || std::abs(pair->rows()) > kOnLinePx || pair->disparity() < 1) continue;
      Pixel seen = next.b;
      if (change.left_columns) seen.x = camera.width_px - 1 - seen.x;
      if (change.left_rows) seen.y = camera.height_px - 1 - seen.y;
      const Result<Normalized> after = unproject(camera, seen);
      if (!after.ok()) continue;
      const double z = aligned.focal_px * aligned.baseline_m / pair->disparity();
      Vec3 p{pair->x_l * z / aligned.focal_px, pair->y_l * z / aligned.focal_px, z};
      if (change.swap) p[0] -= aligned.baseline_m;
      const TrackedPoint point{R_c_a * p, after.value()};
      const double flow = tracks.focal_px * reprojection_error({}, point);
      if (mode == MotionMode::kObjectMoves && flow < 1) continue;  // background: it stands still
      points.push_back(point);
      flows.push_back(flow);
    }
    if (points.size() < kFewest) continue;
    // Coarse: as far as the points moved. Fine: a quarter of what counts as agreement weighs a half.
    const double coarse = std::max(4 * kAgreePx, 2 * percentile(flows, 90)) / tracks.focal_px;
    const auto motion = estimate_motion(points, coarse, 0.5 * kAgreePx / tracks.focal_px);
    Step step;
    step.sample = s;
    std::vector<double> own, kept;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double error = tracks.focal_px * reprojection_error(motion, points[i]);
      if (error > kAgreePx) continue;
      step.points.push_back(points[i]);
      own.push_back(error);
      kept.push_back(flows[i]);
    }
    if (step.points.size() < kFewest || 2 * step.points.size() < points.size()) continue;
    step.flow_px = median(kept);
    step.own_px = median(own);
    tracks.steps.push_back(std::move(step));
  }
  return tracks;
}

PoseFit fit_poses(const Samples& samples, const Tracks& tracks, const StereoRig& rig, const PoseReading& reading) {
  PoseFit fit;
  std::vector<double> residuals, flows, own;
  for (const Step& step : tracks.steps) {
    const auto poses = reading(samples.list[step.sample], samples.list[step.sample + 1]);
    if (!poses) continue;
    Transform<Left, Left> motion = poses->after * poses->before.inverse();
    if (tracks.tracks_right) {
      const auto moved = rig.T_r_l * motion * rig.T_r_l.inverse();
      motion = {moved.rotation, moved.translation};
    }
    ++fit.steps;
    for (const TrackedPoint& point : step.points)
      residuals.push_back(std::min(1e4, tracks.focal_px * reprojection_error(motion, point)));
    flows.push_back(step.flow_px);
    own.push_back(step.own_px);
  }
  if (residuals.empty()) return fit;
  fit.residual_px = median(residuals);
  fit.flow_px = median(flows);
  fit.own_px = median(own);
  return fit;
}

}  // namespace accrete::cli
