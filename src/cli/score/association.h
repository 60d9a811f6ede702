// Which truth segment a primitive belongs to, and which part of the truth the primitives cover.
#pragma once

#include <vector>

#include "cli/score/scored_edges.h"
#include "cli/score/truth.h"

namespace accrete::cli {

// A position on an edge with its unit tangent.
struct EdgePoint {
  Vec3 position{};
  Vec3 tangent{};
};

// Relation of a point to one segment: perpendicular distance to its line (m), foot (m from p), unsigned angle (rad).
struct Relation {
  double distance_m = 0;
  double foot_m = 0;
  double angle = 0;
};
[[nodiscard]] Relation relate(const EdgePoint& point, const Segment& segment);

// The nearest segment that agrees in direction, with the foot on it or at most `pitch_m` beyond an end.
struct Association {
  int segment = -1;       // -1: none; then the distances are infinite and the rest NaN
  double distance_m = 0;  // perpendicular
  double foot_m = 0;
  double angle = 0;           // rad
  double any_distance_m = 0;  // to the nearest segment of any direction
};
[[nodiscard]] Association associate(const EdgePoint& point, const Segments& segments, double max_angle, double pitch_m);

// Share of each segment's length (0..1) that has a point of `points` in the tolerances within `along_m`, sampled every
// half millimetre.
[[nodiscard]] std::vector<double> coverage(const std::vector<EdgePoint>& points, const Segments& segments,
                                           double max_angle, double tolerance_m, double along_m);

// Distance of `p` to the nearest face whose border, grown by `tolerance_m`, holds it; infinite when there is none.
[[nodiscard]] double distance_to_faces(const Vec3& p, const std::vector<Quad>& faces, double tolerance_m);

}  // namespace accrete::cli
