// edges.csv: one row per primitive. docs/reference/results.md describes the columns.
#pragma once

#include <span>
#include <string>

#include "accrete/model.h"
#include "cli/write/linear_light.h"

namespace accrete::cli {

// The whole file. The same primitives give the same bytes on every machine: numbers are the shortest text that reads
// back to the same float. `full_covariance` appends cg_00 .. cg_55 and ca_00 .. ca_66. Colours are written in linear
// light: `encoding` is that of the images.
[[nodiscard]] std::string edges_csv(std::span<const Primitive3d> primitives, bool full_covariance, Encoding encoding);

}  // namespace accrete::cli
