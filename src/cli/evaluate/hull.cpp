#include "cli/evaluate/hull.h"

#include <algorithm>

namespace accrete::cli {
namespace {

double turn(Pixel a, Pixel b, Pixel c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

}  // namespace

std::vector<Pixel> convex_hull(std::vector<Pixel> points) {
  if (points.size() < 3) return {};
  std::sort(points.begin(), points.end(), [](Pixel a, Pixel b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  std::vector<Pixel> hull;
  for (int pass = 0; pass < 2; ++pass) {  // lower, then upper chain
    const std::size_t base = hull.size();
    for (const Pixel p : points) {
      while (hull.size() >= base + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull.size() < 3 ? std::vector<Pixel>{} : hull;
}

bool in_hull(const std::vector<Pixel>& hull, Pixel p) {
  for (std::size_t i = 0; i < hull.size(); ++i)
    if (turn(hull[i], hull[(i + 1) % hull.size()], p) < 0) return false;
  return !hull.empty();
}

}  // namespace accrete::cli
