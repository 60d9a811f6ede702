// What a scene with known geometry can say about its own edges: the truth that accumulated edges are scored against.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "accrete/geometry.h"
#include "accrete/hal/stereo_source.h"

namespace accrete::hal {

enum class TruthKind : std::uint8_t {
  kAlbedo,  // two paints on one plane
  kCrease,  // two faces meet; while one of them is turned away the image shows what lies behind it instead
};

// A straight piece of an edge, metres, in the frame of the list that holds it. Whoever walks from p0 to p1 on the
// surface and looks against `normal` has `left` and `right` at his sides: right lies at (p1 - p0) x normal.
struct TruthSegment {
  Vec3 p0{}, p1{};
  Vec3 normal{};                          // unit, of the surface on the left, towards the viewer
  Vec3 normal_right{};                    // crease: of the surface on the right; otherwise equal to `normal`
  std::array<double, 3> left{}, right{};  // RGB 0..1 as a camera sees it (sRGB), mean of the frames that show this side
  TruthKind kind = TruthKind::kAlbedo;
  double visible = 0;       // share of the frames in which the left camera sees the midpoint
  double visible_both = 0;  // share of the frames in which both cameras do
};

// Axis-aligned, metres.
struct TruthBox {
  Vec3 min{}, max{};
};

struct Truth {
  std::vector<TruthSegment> edges;       // map frame: what ought to be accumulated, and nothing else
  std::vector<TruthSegment> extra;       // map frame: moves along without being judged (the gripper, edges it touches)
  std::vector<TruthSegment> background;  // left camera frame: stands still and must not enter an object's model
  std::vector<TruthBox> excluded;        // map frame: the gripper, for Params::excluded
  TruthBox bounds;                       // map frame: holds all of `edges` with 10 mm to spare
};

// One list as comma separated values: x0,y0,z0,x1,y1,z1,nx,ny,nz,mx,my,mz,left_r,left_g,left_b,right_r,right_g,right_b,
// kind,visible,visible_both; m is normal_right of a crease and empty otherwise. Independent of the locale.
[[nodiscard]] std::string to_csv(std::span<const TruthSegment> segments);

// Writes edges.csv, bbox.txt and, where they are not empty, extra.csv and background.csv into `folder`, which is made.
// kUnavailable: a file cannot be written; the sentence names it.
[[nodiscard]] Outcome write_truth(const Truth& truth, const std::filesystem::path& folder);

}  // namespace accrete::hal
