// The golden replay: so many steps with so many simulated edges, and one hash of everything that came of it.
#pragma once

#include "accrete/accumulator.h"
#include "determinism/world.h"

namespace accrete::determinism {

// Reports of all steps, added up.
struct Totals {
  std::uint32_t observed = 0, born = 0, updated = 0, stereo = 0, mono = 0, missed = 0, ambiguous = 0, starved = 0,
                confirmed = 0, preserved = 0, deleted_existence = 0, deleted_undecided = 0, deleted_background = 0,
                merged = 0, evicted = 0;
};

struct Outcome {
  std::uint64_t measurements = 0;  // hash of what went in
  std::uint64_t state = 0;         // hash of every report, of the whole store every tenth step and at the end
  std::uint32_t primitives = 0;    // in the store at the end
  Totals totals;
};

struct Replay {
  std::span<Edge> edges;
  std::span<Primitive2d> left, right;  // room for the measurements of one step
  int steps = 0;
  void (*progress)(int step, std::uint64_t state) = nullptr;        // after every tenth step
  void (*disturb)(int step, std::span<Primitive2d> eye) = nullptr;  // may change the measurements of one eye
};

// Precondition: nothing was stepped before; capacities without images will do.
Outcome run(Pipeline& pipeline, const Replay& replay);

}  // namespace accrete::determinism
