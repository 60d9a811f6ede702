// All memory of one Accumulator, cut out of one array: what it needs for given capacities, and the cutting.
#pragma once

#include <cstddef>
#include <span>

#include "accrete/accumulator.h"
#include "associate/associate.h"
#include "extract/extract.h"
#include "filter/update.h"
#include "stereo/match.h"
#include "store/store.h"

namespace accrete {

struct EyeMemory {
  std::span<Primitive2d> primitives;
  std::span<float> rows;
  std::span<extract::Cell> cells;
  std::span<std::uint8_t> previous;
  std::span<std::uint32_t> grid_begin;
  std::span<std::uint16_t> grid_order;
  std::span<float> density;
  std::span<std::uint16_t> row_order;
  std::span<std::uint32_t> row_begin;
  std::span<std::int32_t> owner;
};

// Gathered input of the filter, one entry per matched primitive.
struct UpdateBatch {
  std::span<std::uint32_t> slots;
  std::span<LineElement> left, right;
  std::span<Eye> eyes;
  std::span<float> slide_cap;
  std::span<Appearance> appearance;
  std::span<float> sigma_phase, sigma_left, sigma_right, q_phase, q_colour;
  std::span<UpdateOutcome> outcomes;
};

struct Workspace {
  EyeMemory eye[2];
  std::span<stereo::Candidates> candidates;
  std::span<float> best_of_right;
  std::span<StereoMatch> matches;
  std::span<GeometryBlock> geometry;
  std::span<AppearanceBlock> appearance;
  std::span<Track> tracks;
  std::span<std::uint32_t> free_slots, slot_scratch;
  std::span<std::uint32_t> live;              // slots in use
  std::span<PredictedObservation> predicted;  // of the live ones
  std::span<std::uint32_t> expected_slots;    // those that should be seen
  std::span<associate::Expected> expected;
  std::span<associate::Association> associations;
  std::span<associate::Hypothesis> hypotheses;
  std::span<associate::Explained> explained;
  std::span<associate::GatingRoom> gating;  // one
  UpdateBatch batch;
};

// Cuts `memory` into the spans; a null memory only counts. Returns the bytes needed. Elements are value-initialised.
std::size_t cut(std::byte* memory, const Capacities& capacities, Workspace& out);

}  // namespace accrete
