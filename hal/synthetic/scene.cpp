#include "synthetic/scene.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace accrete::hal::synthetic {
namespace {

// Smaller layers stand before larger ones.
enum Layer { kBarLayer, kObjectLayer, kTableLayer, kWallLayer };

constexpr Vec3 kObjectHalf{0.06, 0.04, 0.03};
constexpr TruthBox kTable{{-0.55, 0.15, 0.45}, {0.65, 0.19, 1.1}};
constexpr double kWallDepth = 1.2;
constexpr double kMaxPiece = 0.03;  // m: longer creases are cut, so that each piece's midpoint speaks for it

// Corner of a box: bit k of `which` chooses the upper end of axis k.
Vec3 corner(const TruthBox& box, unsigned which) {
  return {which & 1U ? box.max[0] : box.min[0], which & 2U ? box.max[1] : box.min[1],
          which & 4U ? box.max[2] : box.min[2]};
}

// A crease of a box along axis `k`, between the faces across the two other axes.
void add_creases(Scene& scene, std::size_t solid, std::size_t k) {
  const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
  const Solid& box = scene.solids[solid];
  const int pieces = static_cast<int>(std::ceil((box.extent.max[k] - box.extent.min[k]) / kMaxPiece - 1e-9));
  for (unsigned side = 0; side < 4; ++side) {
    const std::size_t face_a = 2 * a + (side & 1U), face_b = 2 * b + (side >> 1);
    Vec3 start = corner(box.extent, ((side & 1U) << a) | ((side >> 1) << b)), end = start;
    end[k] = box.extent.max[k];
    // Face a lies on the left, face b on the right: right = t x n_a points the way that n_b does.
    const bool forward = dot(cross(end - start, box.faces[face_a].normal), box.faces[face_b].normal) > 0;
    if (!forward) std::swap(start, end);
    for (int i = 0; i < pieces; ++i) {
      const Vec3 step = (1.0 / pieces) * (end - start);
      scene.edges.push_back({solid, face_a, face_b, start + double(i) * step, start + double(i + 1) * step,
                             box.faces[face_a].base.albedo, box.faces[face_b].base.albedo, TruthKind::kCrease});
    }
  }
}

void add_object(Scene& scene, Random& random) {
  const std::array<Colour, 6> albedo{{{0.66, 0.62, 0.55},
                                      {0.12, 0.3, 0.42},
                                      {0.7, 0.5, 0.12},
                                      {0.5, 0.16, 0.12},
                                      {0.55, 0.55, 0.58},
                                      {0.16, 0.33, 0.16}}};
  const TruthBox extent{-1.0 * kObjectHalf, kObjectHalf};
  add_box(scene, Carrier::kObject, kObjectLayer, extent, albedo);
  const std::size_t solid = scene.solids.size() - 1;
  const auto [x, y, z] = kObjectHalf;
  const double gap = 0.016;  // half width of the strip on the faces +-x where the fingers hold
  for (std::size_t side = 0; side < 2; ++side) {
    const double s = side == 0 ? -1 : 1;
    for (const double low : {-y, gap})
      paint_figures(scene, solid, side, {{s * x, low, -z}, {0, 0, 2 * z}, {0, y - gap, 0}, 2, 1}, random);
    paint_figures(scene, solid, 2 + side, {{-x, s * y, -z}, {2 * x, 0, 0}, {0, 0, 2 * z}, 3, 1}, random);
    paint_figures(scene, solid, 4 + side, {{-x, -y, s * z}, {2 * x, 0, 0}, {0, 2 * y, 0}, 3, 2}, random);
  }
}

// Two fingers hold the object at its faces +-x, a palm joins them.
void add_gripper(Scene& scene, Random& random) {
  const double x = kObjectHalf[0], margin = 0.002;  // m: what an edge of the gripper may be off and still be excluded
  const std::array<TruthBox, 3> parts{{{{-x - 0.015, -0.012, -0.015}, {-x, 0.012, 0.085}},
                                       {{x, -0.012, -0.015}, {x + 0.015, 0.012, 0.085}},
                                       {{-x - 0.015, -0.016, 0.085}, {x + 0.015, 0.016, 0.105}}}};
  scene.first_gripper = scene.solids.size();
  scene.gripper_count = parts.size();
  for (const TruthBox& part : parts) {
    const Colour c{0.2, 0.2, 0.22}, d{0.26, 0.25, 0.24}, e{0.15, 0.16, 0.19};
    add_box(scene, Carrier::kObject, kObjectLayer, part, {c, c, d, d, e, e});
    const std::size_t solid = scene.solids.size() - 1;
    const bool finger = part.max[2] < 0.1;
    const Vec3 size = part.max - part.min;
    const Vec3 along = finger ? Vec3{0, 0, size[2]} : Vec3{size[0], 0, 0};
    for (std::size_t side = 0; side < 2; ++side) {  // faces +-y
      const Vec3 start{part.min[0], side == 0 ? part.min[1] : part.max[1], part.min[2]};
      paint_figures(scene, solid, 2 + side, {start, along, finger ? Vec3{size[0], 0, 0} : Vec3{0, 0, size[2]}, 6, 1},
                    random);
    }
    if (finger) {  // the outer face; the inner one touches
      const std::size_t face = part.min[0] < 0 ? 0 : 1;
      const Vec3 start{face == 0 ? part.min[0] : part.max[0], part.min[1], part.min[2]};
      paint_figures(scene, solid, face, {start, along, {0, size[1], 0}, 4, 1}, random);
    }
    const Vec3 rim{margin, margin, margin};
    scene.excluded.push_back({part.min - rim, part.max + rim});
  }
}

void add_table(Scene& scene, Random& random) {
  const Colour wood{0.3, 0.17, 0.09};
  add_box(scene, Carrier::kScene, kTableLayer, kTable, {wood, wood, wood, wood, wood, wood});
  const Vec3 size = kTable.max - kTable.min;
  paint_figures(scene, scene.solids.size() - 1, 2, {kTable.min, {size[0], 0, 0}, {0, 0, size[2]}, 4, 2, true}, random);
}

void add_wall(Scene& scene, Random& random) {
  // Wide enough to fill both pictures from every place that the cameras of the room take.
  const TruthBox extent{{-2.2, -1.0, kWallDepth}, {2.2, 1.0, kWallDepth}};
  const Vec3 a = extent.min, b{extent.max[0], extent.min[1], kWallDepth}, c = extent.max,
             d{extent.min[0], extent.max[1], kWallDepth};
  scene.solids.push_back({Carrier::kScene, kWallLayer, extent, {{{{a, b, c, d}, {0.5, 0.53, 0.55}}, {0, 0, -1}, {}}}});
  paint_figures(scene, scene.solids.size() - 1, 0, {a, b - a, d - a, 18, 8, true}, random);
}

void add_bar(Scene& scene) {
  const Colour paint{0.42, 0.4, 0.1};
  add_box(scene, Carrier::kBar, kBarLayer, {{-0.009, -0.3, kBarDepth}, {0.009, 0.3, kBarDepth + 0.01}},
          {paint, paint, paint, paint, paint, paint});
}

}  // namespace

void add_box(Scene& scene, Carrier carrier, int layer, const TruthBox& extent, const std::array<Colour, 6>& albedo) {
  Solid solid{carrier, layer, extent, {}};
  for (std::size_t k = 0; k < 3; ++k) {
    for (unsigned side = 0; side < 2; ++side) {
      const unsigned a = 1U << ((k + 1) % 3), b = 1U << ((k + 2) % 3), on = side << k;
      Face face{{{}, albedo[2 * k + side]}, {}, {}};
      for (const unsigned which : {on, on | a, on | a | b, on | b}) face.base.corners.push_back(corner(extent, which));
      face.normal[k] = side == 0 ? -1 : 1;
      solid.faces.push_back(std::move(face));
    }
  }
  scene.solids.push_back(std::move(solid));
  for (std::size_t k = 0; k < 3; ++k) add_creases(scene, scene.solids.size() - 1, k);
}

Scene make_scene(std::uint64_t seed, bool gripper, bool bar, bool shimmer) {
  Scene scene;
  Random object(seed, 1), hand(seed, 2), table(seed, 3), wall(seed, 4);  // parts do not change with their neighbours
  add_object(scene, object);
  if (shimmer) scene.solids[0].faces[5].shimmer = 0.6;  // the face +z
  if (gripper) add_gripper(scene, hand);
  if (bar) add_bar(scene);
  add_table(scene, table);
  add_wall(scene, wall);
  return scene;
}

}  // namespace accrete::hal::synthetic
