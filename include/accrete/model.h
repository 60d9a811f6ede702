// The accumulated model, read-only: what the store holds, one primitive at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "accrete/primitive.h"
#include "accrete/status.h"

namespace accrete {

// Bookkeeping of one slot of the store (existence, visibility, history); defined in src/store.
struct Track;

// A 3D-primitive as users see it: metres, radians, colours 0..1, in the map frame (object or world).
struct Primitive3d {
  PrimitiveId id;
  State state = State::kFree;
  float existence = 0;  // probability, 0..1
  // Covariance of position errors in the map frame and rotation errors in the own one, with the consider bias included
  // (docs/conventions.md, docs/math/association.md).
  Geometry geometry;
  std::array<float, 3> tangent{};  // local x axis
  AppearanceState appearance;      // variances with what was learned of their invariance included (docs/math/filter.md)
  std::uint32_t observations = 0;  // frames in which it was matched
  float misfit = 0;                // running mean of the squared innovations per degree of freedom; 1 is honest
  std::uint32_t first_frame = 0, last_frame = 0;  // born, last matched
  SeenDirections seen;                            // from where it was seen, and looked for in vain
};

// Probability that the surface at the primitive faces a viewer at `viewer_m` (map frame): what was seen from about
// there, and where nobody looked, the angle to the mean viewing direction (METHOD 7.3). Things in front are not known.
[[nodiscard]] float face_probability(const Primitive3d& primitive, const std::array<float, 3>& viewer_m);

// Borrowed: valid until the next call of a non-const member of the Accumulator.
class ModelView {
 public:
  ModelView() = default;
  ModelView(std::span<const GeometryBlock> geometry, std::span<const AppearanceBlock> appearance,
            std::span<const Track> tracks, float bias_per_pitch, float typical_misfit)
      : geometry_(geometry),
        appearance_(appearance),
        tracks_(tracks),
        typical_misfit_(typical_misfit),
        bias_per_pitch_(bias_per_pitch) {}

  // Number of slots, used and free; slots never move while a primitive lives.
  [[nodiscard]] std::size_t slots() const { return tracks_.size(); }
  // The state of slot `i`, kFree for an empty one. Precondition: i < slots().
  [[nodiscard]] State state(std::size_t i) const;
  // A copy of slot `i`. Precondition: i < slots() and state(i) != kFree.
  [[nodiscard]] Primitive3d at(std::size_t i) const;
  // kNotFound when the id is null, stale, or of another store.
  [[nodiscard]] Status find(PrimitiveId id, Primitive3d& out) const;
  // Confirmed and preserved primitives: the model.
  [[nodiscard]] std::size_t size() const;

 private:
  std::span<const GeometryBlock> geometry_;
  std::span<const AppearanceBlock> appearance_;
  std::span<const Track> tracks_;
  float typical_misfit_ = 1;  // of all primitives: what a misfit is measured against
  float bias_per_pitch_ = 0;  // consider bias in units of a sampling pitch on the object
};

}  // namespace accrete
