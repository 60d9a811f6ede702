// The fixed-capacity store of 3D-primitives: slots in blocks of 16, ids with generations, and who goes when it is full.
#pragma once

#include <span>

#include "accrete/primitive.h"
#include "existence/track.h"

namespace accrete {

struct Store {
  std::span<GeometryBlock> geometry;
  std::span<AppearanceBlock> appearance;
  std::span<Track> tracks;              // one per slot; a multiple of 16
  std::span<std::uint32_t> free_slots;  // ring of free slots, first in first out: one slot is not hammered
  std::span<std::uint32_t> scratch;     // as many as slots
  std::size_t free_begin = 0, free_count = 0;

  // Empties it. Generations go on, so that ids from before stay stale.
  void clear();
  [[nodiscard]] std::size_t size() const { return tracks.size() - free_count; }

  // A slot for a new primitive, its track reset but for the generation; the caller fills in the blocks and the rest.
  // Precondition: free_count > 0 (make_room).
  [[nodiscard]] std::uint32_t take();
  void release(std::uint32_t slot);

  // Evicts the least valuable primitives (lowest existence, then oldest) until `wanted` slots are free, but none whose
  // log-odds reach `keep`. Returns how many went.
  std::uint32_t make_room(std::size_t wanted, float keep);
};

}  // namespace accrete
