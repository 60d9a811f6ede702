#include "cli/score/association.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace accrete::cli {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

Relation relate(const EdgePoint& point, const Segment& segment) {
  const Vec3 r = point.position - segment.p;
  const double foot = dot(r, segment.direction);
  const double cosine = std::min(1.0, std::abs(dot(point.tangent, segment.direction)));
  const double sine = norm(cross(point.tangent, segment.direction));
  return {norm(r - foot * segment.direction), foot, std::atan2(sine, cosine)};
}

Association associate(const EdgePoint& point, const Segments& segments, double max_angle, double pitch_m) {
  Association best{-1, kInfinity, kNan, kNan, kInfinity};
  double best_rank = kInfinity;
  for (std::size_t k = 0; k < segments.list.size(); ++k) {
    const Segment& segment = segments.list[k];
    const Relation r = relate(point, segment);
    if (r.foot_m < -pitch_m || r.foot_m > segment.length_m + pitch_m) continue;
    best.any_distance_m = std::min(best.any_distance_m, r.distance_m);
    if (r.angle > max_angle) continue;
    // Collinear neighbours tie in distance: prefer the segment that really holds the foot.
    const double over = std::max({0.0, -r.foot_m, r.foot_m - segment.length_m});
    const double rank = r.distance_m + 1e-6 * over;
    if (!(rank < best_rank)) continue;
    best_rank = rank;
    best = {static_cast<int>(k), r.distance_m, r.foot_m, r.angle, best.any_distance_m};
  }
  return best;
}

std::vector<double> coverage(const std::vector<EdgePoint>& points, const Segments& segments, double max_angle,
                             double tolerance_m, double along_m) {
  constexpr double kStepM = 0.0005;
  std::vector<double> covered(segments.list.size(), 0.0);
  std::vector<double> feet;
  for (std::size_t k = 0; k < segments.list.size(); ++k) {
    const double length = segments.list[k].length_m;
    feet.clear();
    for (const EdgePoint& point : points) {
      const Relation r = relate(point, segments.list[k]);
      if (r.distance_m <= tolerance_m && r.angle <= max_angle && r.foot_m >= -along_m && r.foot_m <= length + along_m)
        feet.push_back(r.foot_m);
    }
    if (feet.empty()) continue;
    std::sort(feet.begin(), feet.end());
    // Samples in the middles of equal steps, counted without visiting them: an edge may be as long as a file says.
    const double samples = std::max(1.0, std::ceil(length / kStepM)), step = length / samples;
    double hits = 0, next = 0;  // the first sample that has not been counted
    for (const double foot : feet) {
      const double first = std::max(next, std::ceil((foot - along_m) / step - 0.5));
      const double last = std::min(samples - 1, std::floor((foot + along_m) / step - 0.5));
      if (!(last >= first)) continue;
      hits += last - first + 1;
      next = last + 1;
    }
    covered[k] = hits / samples;
  }
  return covered;
}

double distance_to_faces(const Vec3& p, const std::vector<Quad>& faces, double tolerance_m) {
  double best = kInfinity;
  for (const Quad& face : faces) {
    Vec3 n = cross(face[1] - face[0], face[3] - face[0]);
    n = (1 / norm(n)) * n;
    bool inside = true;
    for (int i = 0; i < 4 && inside; ++i) {
      Vec3 inward = cross(n, face[(i + 1) % 4] - face[i]);
      inward = (1 / norm(inward)) * inward;
      inside = dot(p - face[i], inward) >= -tolerance_m;
    }
    if (inside) best = std::min(best, std::abs(dot(p - face[0], n)));
  }
  return best;
}

}  // namespace accrete::cli
