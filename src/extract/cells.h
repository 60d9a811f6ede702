// Sparse sampling: the lattice of cells, and which pixel of a row each cell would take (METHOD 1.4).
#pragma once

#include <cstdint>
#include <span>

#include "extract/quadrature.h"

namespace accrete::extract {

// Bricks, which tile like hexagons. 6 px is nearly twice the distance of 3.4 px at which the band-pass
// tells two edges from a line; 5 rows is 6 sin 60 degrees.
inline constexpr int kPitch = 6;
inline constexpr int kBand = 5;
inline constexpr int kMargin = 7;  // px at the border in which nothing is extracted: kernel, sampling and colour reach

struct CellWinner {
  float score = 0;  // energy, less off the middle of the cell; 0: none
  std::int16_t x = 0, y = 0;
  Channel channel = Channel::kLuma;
};

// The best candidate, and a good one at least half a pitch away from it: for another edge in the cell, and for where
// the first turns out to be none. One pass: of what lay beside an earlier best one may be forgotten, which is along its
// edge.
struct Cell {
  CellWinner first, second;
};

[[nodiscard]] constexpr std::size_t cells_per_band(std::size_t width) { return width / kPitch + 2; }

// Offers the maxima of row `y` across the dominant axis of the odd part to the cells of its band. Precondition: the
// rows y - 1 .. y + 1 are in the rings. `chroma` may be null. Where both channels respond, chroma is taken only where
// it has more than twice the luma's amplitude: one edge should be the same structure in every view.
void offer_row(const QuadratureFilter& luma, const QuadratureFilter* chroma, int y, int width, float min_energy,
               std::span<Cell> cells);

}  // namespace accrete::extract
