// The records: 2D-primitives of one image, and the blocks in which 3D-primitives live.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace accrete {

// A line element in the aligned image (AlignedRig): undistorted, principal point at zero, direction not canonical.
struct LineElement {
  float x_px = 0, y_px = 0;
  float c = 1, s = 0;     // unit direction u = (c, s); the normal to its right is nu = (-s, c)
  float sigma_n_px = 0;   // across the edge
  float sigma_theta = 0;  // rad
};

// Appearance: local phase and the colours on both sides, in the order in which they are filtered.
struct Appearance {
  float phase = 0;  // rad, (-pi, pi], relative to the right-hand normal: +pi/2 is bright on the left (METHOD 1.1)
  std::array<float, 3> left{};  // RGB, 0..1, on the left of a traveller along the direction
  std::array<float, 3> right{};
};

// The other description of the same edge: direction reversed = sides swapped, phase negated (METHOD 1.2). This is the
// one place of that symmetry; whoever turns a direction by pi calls it.
[[nodiscard]] constexpr Appearance reversed(const Appearance& a) { return {-a.phase, a.right, a.left}; }
[[nodiscard]] constexpr LineElement reversed(const LineElement& e) {
  LineElement r = e;
  r.c = -e.c;
  r.s = -e.s;
  return r;
}

// One oriented edge feature of an image.
struct Primitive2d {
  float x_px = 0, y_px = 0;  // raw image, sub-pixel across the edge; along it only a sampling choice
  float theta = 0;           // rad, [0, pi), from +x towards +y
  float amplitude = 0;       // sqrt(even^2 + odd^2), grey levels
  float confidence_i0d = 0, confidence_i1d = 0, confidence_i2d = 0;  // homogeneous, edge, junction; sum 1
  float flow_px = 0;  // normal optic flow since the previous image, along (-sin theta, cos theta)
  bool has_flow = false;
  Appearance appearance;
  float sigma_n_px = 0;    // raw image, across the edge
  float sigma_theta = 0;   // rad
  float sigma_phase = 0;   // rad
  float sigma_colour = 0;  // 0..1
  LineElement aligned;     // the same element in the aligned image
};

// A stereo pair of 2D-primitives; rivals share a left or right index.
struct StereoMatch {
  std::uint16_t left = 0;
  std::uint16_t right = 0;
  bool right_reversed = false;    // the right element is described in the opposite direction
  bool group_consistent = false;  // supported by a neighbour along the contour
  float disparity_px = 0;
  float similarity = 0;   // 0..1, multi-modal (METHOD 2.2)
  float probability = 0;  // prior existence, shared among rivals
};

// A slot of the store and how often it has been used; zero is null. Never dangling: a stale id is refused.
struct PrimitiveId {
  std::uint32_t index1 = 0;  // index + 1
  std::uint32_t generation = 0;

  [[nodiscard]] constexpr bool is_null() const { return index1 == 0; }
  friend constexpr bool operator==(const PrimitiveId&, const PrimitiveId&) = default;
};

enum class State : std::uint8_t {
  kFree,       // an empty slot
  kTentative,  // undecided
  kConfirmed,  // accepted, and expected to be seen now
  kPreserved,  // accepted, and hidden now
};

inline constexpr std::size_t kBlockLanes = 16;

// Index of element (i, j), i <= j, in a packed upper triangle of an n x n matrix, row after row (as cg_00 .. cg_55).
[[nodiscard]] constexpr std::size_t packed_index(std::size_t n, std::size_t i, std::size_t j) {
  return i * n - i * (i + 1) / 2 + j;
}

// Geometry of 16 primitives, structure of arrays. Position in the map frame (m); quaternion x y z w, from the
// primitive's own frame to the map; covariance of the errors in the primitive's own frame: position along the tangent,
// local y and local z (m), roll about the tangent, then about local y, then about local z (rad). Layout is the same on
// every machine.
struct alignas(64) GeometryBlock {
  static constexpr std::size_t kPosition = 0, kQuaternion = 3, kCovariance = 7, kRows = 28;
  float row[kRows][kBlockLanes];
};

// Appearance of 16 primitives: phase, left RGB, right RGB; packed 7 x 7 covariance.
struct alignas(64) AppearanceBlock {
  static constexpr std::size_t kMean = 0, kCovariance = 7, kRows = 35;
  float row[kRows][kBlockLanes];
};

// From which directions an edge has been seen, and looked for, in the map frame: 42 directions, the vertices of an
// icosahedron and the middles of its edges, about 30 degrees apart. Directions of the map, because the primitive's own
// frame turns about the tangent while it is learnt.
struct SeenDirections {
  static constexpr std::size_t kBins = 42;
  std::array<std::uint8_t, kBins> hits{};
  std::array<std::uint8_t, kBins> visits{};

  // `toward_viewer`: unit vector from the edge to the camera, map frame. Counts are halved when they overflow, so that
  // recent views weigh more.
  void count(const std::array<float, 3>& toward_viewer, bool hit);
};

// One 3D-primitive copied out of the blocks. In a Primitive3d (model.h) position errors are in the map frame instead.
struct Geometry {
  std::array<float, 3> position{};
  std::array<float, 4> quaternion{0, 0, 0, 1};
  std::array<float, 21> covariance{};
};
struct AppearanceState {
  Appearance mean;
  std::array<float, 28> covariance{};
};

// The same edge described in the opposite direction, with its covariance: half a turn about local z (METHOD 3.2). Of a
// geometry as it is in the blocks: errors in the own frame.
[[nodiscard]] Geometry reversed(const Geometry& geometry);
[[nodiscard]] AppearanceState reversed(const AppearanceState& appearance);

[[nodiscard]] Geometry load(const GeometryBlock& block, std::size_t lane);     // out of a block, lane < 16
void store(const Geometry& geometry, GeometryBlock& block, std::size_t lane);  // into it
[[nodiscard]] AppearanceState load(const AppearanceBlock& block, std::size_t lane);
void store(const AppearanceState& appearance, AppearanceBlock& block, std::size_t lane);

}  // namespace accrete
