// Figures on faces: rectangles, triangles and striped bars, and the truth of their outlines.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "synthetic/scene.h"

namespace accrete::hal::synthetic {
namespace {

// Linear albedo. No paint is so dark that noise hides its colour, or so bright that two lamps saturate it.
constexpr std::array<Colour, 10> kPaints{{{0.72, 0.69, 0.62},
                                          {0.055, 0.055, 0.06},
                                          {0.66, 0.07, 0.05},
                                          {0.06, 0.11, 0.48},
                                          {0.75, 0.58, 0.05},
                                          {0.07, 0.32, 0.09},
                                          {0.74, 0.27, 0.045},
                                          {0.32, 0.07, 0.36},
                                          {0.1, 0.44, 0.54},
                                          {0.75, 0.42, 0.4}}};

constexpr double kContrast = 0.12;     // of encoded brightness, 0..1: 15 times the usual noise
constexpr double kClearance = 0.0025;  // m between a figure and the border of its cell: 3 px at 0.6 m
constexpr double kPi = 3.14159265358979323846;

double brightness(const Colour& c) { return (encode_srgb(c[0]) + encode_srgb(c[1]) + encode_srgb(c[2])) / 3; }

// The face's own axes, such that (u, v, outward normal) is right-handed: turning from u to v runs against the clock for
// a viewer outside.
struct Plane {
  Vec3 centre, u, v;
  [[nodiscard]] Vec3 at(double a, double b) const { return centre + a * u + b * v; }
};

class Painter {
 public:
  Painter(Scene& scene, std::size_t solid, std::size_t face, Random& random)
      : scene_(scene), solid_(solid), face_(face), random_(random) {}

  void rectangle(const Plane& plane, double half_length, double half_width) {
    const Colour paint = pick_paint(base(), random_);
    fill(plane,
         {{-half_length, -half_width},
          {half_length, -half_width},
          {half_length, half_width},
          {-half_length, half_width}},
         paint);
    const std::array<Vec3, 4> c{plane.at(-half_length, -half_width), plane.at(half_length, -half_width),
                                plane.at(half_length, half_width), plane.at(-half_length, half_width)};
    for (std::size_t i = 0; i < 4; ++i) outline(c[i], c[(i + 1) % 4], paint);
  }

  void triangle(const Plane& plane, double radius) {
    const Colour paint = pick_paint(base(), random_);
    std::array<Pixel, 3> corner{};
    for (std::size_t i = 0; i < 3; ++i) {
      const double angle = 2 * kPi / 3 * static_cast<double>(i) + random_.uniform(-0.25, 0.25);
      corner[i] = {radius * std::cos(angle), radius * std::sin(angle)};
    }
    fill(plane, {corner.begin(), corner.end()}, paint);
    for (std::size_t i = 0; i < 3; ++i) {
      const Pixel p = corner[i], q = corner[(i + 1) % 3];
      outline(plane.at(p.x, p.y), plane.at(q.x, q.y), paint);
    }
  }

  // Three stripes side by side, the outer two of one paint.
  void bar(const Plane& plane, double half_length, double half_width) {
    const Colour outer = pick_paint(base(), random_);
    Colour inner = pick_paint(outer, random_);
    while (std::abs(brightness(inner) - brightness(base())) < 0.8 * kContrast) inner = pick_paint(outer, random_);
    for (int stripe = 0; stripe < 3; ++stripe) {
      const double a = half_length * (2.0 * stripe / 3 - 1), b = half_length * (2.0 * (stripe + 1) / 3 - 1);
      const Colour paint = stripe == 1 ? inner : outer;
      fill(plane, {{a, -half_width}, {b, -half_width}, {b, half_width}, {a, half_width}}, paint);
      outline(plane.at(a, -half_width), plane.at(b, -half_width), paint);
      outline(plane.at(b, half_width), plane.at(a, half_width), paint);
      if (stripe > 0)  // upwards: the stripe before lies on the left
        edge(plane.at(a, -half_width), plane.at(a, half_width), stripe == 1 ? outer : inner, paint);
    }
    outline(plane.at(half_length, -half_width), plane.at(half_length, half_width), outer);
    outline(plane.at(-half_length, half_width), plane.at(-half_length, -half_width), outer);
  }

 private:
  [[nodiscard]] const Colour& base() const { return scene_.solids[solid_].faces[face_].base.albedo; }

  void fill(const Plane& plane, const std::vector<Pixel>& corners, const Colour& paint) {
    Patch patch{{}, paint};
    for (const Pixel p : corners) patch.corners.push_back(plane.at(p.x, p.y));
    scene_.solids[solid_].faces[face_].paint.push_back(std::move(patch));
  }
  // Walked against the clock, so that the figure lies on the left.
  void outline(const Vec3& p0, const Vec3& p1, const Colour& paint) { edge(p0, p1, paint, base()); }
  void edge(const Vec3& p0, const Vec3& p1, const Colour& left, const Colour& right) {
    scene_.edges.push_back({solid_, face_, face_, p0, p1, left, right, TruthKind::kAlbedo});
  }

  Scene& scene_;
  std::size_t solid_, face_;
  Random& random_;
};

}  // namespace

Colour pick_paint(const Colour& other, Random& random) {
  for (;;) {  // ends: dark and bright paints are 0.5 apart, so that one of them always will do
    const Colour paint = kPaints[random.below(kPaints.size())];
    if (std::abs(brightness(paint) - brightness(other)) >= kContrast) return paint;
  }
}

void paint_figures(Scene& scene, std::size_t solid, std::size_t face, const Grid& grid, Random& random) {
  Painter painter(scene, solid, face, random);
  const Vec3 normal = scene.solids[solid].faces[face].normal;
  const double length = norm(grid.along), width = norm(grid.across);
  const Vec3 u = (1 / length) * grid.along, v = cross(normal, u);
  const double cell_length = length / grid.columns, cell_width = width / grid.rows;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const double turn = random.uniform(-0.45, 0.45);  // rad; upright edges would all look alike
      const double c = std::cos(turn), s = std::sin(turn);
      const Plane plane{
          grid.corner + ((column + 0.5) / grid.columns) * grid.along + ((row + 0.5) / grid.rows) * grid.across,
          c * u + s * v, c * v - s * u};
      const double radius = 0.5 * std::min(cell_length, cell_width) - kClearance;
      const double diagonal = random.uniform(0.45, 0.9);  // rad: from oblong to nearly square
      switch (grid.rectangles_only ? 0 : random.below(3)) {
        case 0:
          painter.rectangle(plane, radius * std::cos(diagonal), radius * std::sin(diagonal));
          break;
        case 1:
          painter.triangle(plane, radius);
          break;
        default:
          painter.bar(plane, radius * std::cos(0.4), radius * std::sin(0.4));
          break;
      }
    }
  }
}

}  // namespace accrete::hal::synthetic
