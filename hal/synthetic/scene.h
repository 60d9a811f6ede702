// The stage: painted convex solids, and the edges between their paints. Built once from a seed, in metres.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "accrete/hal/truth.h"
#include "synthetic/canvas.h"
#include "synthetic/random.h"

namespace accrete::hal::synthetic {

// A convex plane polygon of one paint.
struct Patch {
  std::vector<Vec3> corners;
  Colour albedo{};
};

struct Face {
  Patch base;
  Vec3 normal{};             // outwards
  std::vector<Patch> paint;  // on the base, without overlap
  double shimmer = 0;        // 0 .. 1: how much its colours change with the viewing angle, as those of a beetle do
};

// The scene stands still; the object and the bar move in it.
enum class Carrier : std::uint8_t { kScene, kObject, kBar };

// A box with axes parallel to those of its carrier, or a single face. Of two solids the one with the smaller layer can
// hide the other; solids of one layer share a carrier and are separated by a plane along one of its axes.
struct Solid {
  Carrier carrier = Carrier::kScene;
  int layer = 0;
  TruthBox extent;
  std::vector<Face> faces;
};

// An edge in the frame of its solid's carrier, with the faces and paints on both sides.
struct SceneEdge {
  std::size_t solid = 0, face_left = 0, face_right = 0;
  Vec3 p0{}, p1{};
  Colour left{}, right{};
  TruthKind kind = TruthKind::kAlbedo;
};

struct Scene {
  std::vector<Solid> solids;
  std::vector<SceneEdge> edges;
  std::vector<TruthBox> excluded;                    // around the gripper, in the object's frame
  std::size_t first_gripper = 0, gripper_count = 0;  // which solids it is made of
};

// Where the pieces stand, as the camera of the first frame sees them.
inline constexpr Vec3 kObjectPosition{0.06, -0.005, 0.6};  // half way between the cameras' axes
inline constexpr double kBarDepth = 0.36;

[[nodiscard]] Scene make_scene(std::uint64_t seed, bool gripper, bool bar, bool shimmer);

// A box of six faces of one paint each; faces in the order -x +x -y +y -z +z. Adds its twelve creases.
void add_box(Scene& scene, Carrier carrier, int layer, const TruthBox& extent, const std::array<Colour, 6>& albedo);

// Paints figures in a grid of cells onto a rectangle of a face (corner, and two sides at right angles) and adds their
// outlines to the edges.
struct Grid {
  Vec3 corner{}, along{}, across{};
  int columns = 1, rows = 1;
  bool rectangles_only = false;
};
void paint_figures(Scene& scene, std::size_t solid, std::size_t face, const Grid& grid, Random& random);

// A paint whose encoded brightness differs clearly from that of `other`.
[[nodiscard]] Colour pick_paint(const Colour& other, Random& random);

}  // namespace accrete::hal::synthetic
