// The model for viewers, as binary little-endian PLY. docs/reference/results.md describes the properties.
#pragma once

#include <span>
#include <string>

#include "accrete/model.h"
#include "accrete/motion.h"

namespace accrete::cli {

// Points: position, tangent as normal, mean colour of both sides, existence, phase, observations, 13 sigmas.
[[nodiscard]] std::string edges_ply(std::span<const Primitive3d> primitives, MotionMode mode);
// Pairs of vertices joined by edges, in the mean colour.
[[nodiscard]] std::string lines_ply(std::span<const Primitive3d> primitives, MotionMode mode);
// A thin quad each, its left half in the left colour and its right half in the right one; the front faces the viewer.
[[nodiscard]] std::string ribbons_ply(std::span<const Primitive3d> primitives, MotionMode mode);

}  // namespace accrete::cli
