#include "synthetic/polygon.h"

#include <algorithm>
#include <cstddef>

namespace accrete::hal::synthetic {
namespace {

// Below this a piece is rounding, not geometry (px^2).
constexpr double kMinArea = 1e-9;

struct Line {
  double a, b, c;
  [[nodiscard]] double at(Pixel p) const { return a * p.x + b * p.y + c; }
};

// Positive inside.
Line edge_line(const Convex& polygon, std::size_t i) {
  const Pixel p = polygon[i], q = polygon[(i + 1) % polygon.size()];
  const double a = p.y - q.y, b = q.x - p.x;
  return {a, b, -(a * p.x + b * p.y)};
}

double cross(Pixel o, Pixel a, Pixel b) { return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x); }

}  // namespace

double area(const Convex& polygon) {
  double twice = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i) twice += cross(polygon[0], polygon[i - 1], polygon[i]);
  return 0.5 * twice;
}

Convex clip(const Convex& polygon, double a, double b, double c) {
  const Line line{a, b, c};
  Convex result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Pixel p = polygon[i], q = polygon[(i + 1) % polygon.size()];
    const double dp = line.at(p), dq = line.at(q);
    if (dp >= 0) result.push_back(p);
    if ((dp >= 0) != (dq >= 0)) {
      const double s = dp / (dp - dq);
      result.push_back({p.x + s * (q.x - p.x), p.y + s * (q.y - p.y)});
    }
  }
  return result;
}

Convex clip_to_rectangle(const Convex& polygon, double x0, double y0, double x1, double y1) {
  return clip(clip(clip(clip(polygon, 1, 0, -x0), -1, 0, x1), 0, 1, -y0), 0, -1, y1);
}

void subtract(const Convex& polygon, const Convex& hole, std::vector<Convex>& pieces) {
  for (std::size_t i = 0; i < hole.size(); ++i) {
    const Line line = edge_line(hole, i);
    if (std::all_of(polygon.begin(), polygon.end(), [&](Pixel p) { return line.at(p) <= 0; })) {
      pieces.push_back(polygon);  // apart: keep it whole
      return;
    }
  }
  Convex rest = polygon;
  for (std::size_t i = 0; i < hole.size() && rest.size() > 2; ++i) {
    const Line line = edge_line(hole, i);
    Convex outside = clip(rest, -line.a, -line.b, -line.c);
    if (area(outside) > kMinArea) pieces.push_back(std::move(outside));
    rest = clip(rest, line.a, line.b, line.c);
  }
}

Convex convex_hull(std::vector<Pixel> points) {  // Andrew's monotone chain
  std::sort(points.begin(), points.end(), [](Pixel a, Pixel b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  Convex hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = hull.size();
    for (const Pixel p : points) {
      while (hull.size() >= start + 2 && cross(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
      hull.push_back(p);
    }
    if (!hull.empty()) hull.pop_back();  // begins the other half
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

bool contains(const Convex& polygon, Pixel p) {
  if (polygon.size() < 3) return false;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    if (edge_line(polygon, i).at(p) < 0) return false;
  return true;
}

}  // namespace accrete::hal::synthetic
