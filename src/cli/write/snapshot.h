// The model copied out of the store: what the writers, the overlays and the scorer work on.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "accrete/model.h"
#include "accrete/motion.h"

namespace accrete::cli {

// Every primitive of the model, tentative ones included, in the order of the slots. `frame_numbers` maps the frames
// that the accumulator counted to frames of the recording (the two differ where frames could not be used); a frame that
// it does not hold stays as it is.
[[nodiscard]] std::vector<Primitive3d> snapshot(const ModelView& model, std::span<const std::uint64_t> frame_numbers);

// Those that belong to the model: confirmed or preserved, and at least this probable.
[[nodiscard]] std::vector<Primitive3d> accepted(std::span<const Primitive3d> primitives, float min_existence);

// "slot-generation", unique in a run.
[[nodiscard]] std::string id_text(PrimitiveId id);
// "tentative", "confirmed", "preserved".
[[nodiscard]] const char* state_text(State state);
// "object" or "world": the frame in which the edges stand still.
[[nodiscard]] inline const char* frame_text(MotionMode mode) {
  return mode == MotionMode::kObjectMoves ? "object" : "world";
}

// Half the length (m) of the piece of edge that a primitive stands for: its sampled point lies anywhere on the pitch of
// the sampling grid, and the slide along the tangent stays unobserved, so the pitch is sqrt(12) times that sigma.
[[nodiscard]] std::vector<float> half_lengths_m(std::span<const Primitive3d> primitives);

}  // namespace accrete::cli
