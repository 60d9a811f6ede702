#include "associate/grid.h"

namespace accrete::associate {
namespace {

std::size_t cell_of(const Primitive2d& p) {
  return static_cast<std::size_t>(Grid::cell(p.aligned.y_px)) * Grid::kSide +
         static_cast<std::size_t>(Grid::cell(p.aligned.x_px));
}

}  // namespace

void Grid::build(std::span<const Primitive2d> primitives) {
  // Counting sort. Filling moves each begin to its end; shifting by one cell afterwards restores them.
  std::fill(begin.begin(), begin.end(), 0U);
  for (const Primitive2d& p : primitives) ++begin[cell_of(p) + 1];
  for (std::size_t c = 0; c < kCells; ++c) begin[c + 1] += begin[c];
  for (std::size_t i = 0; i < primitives.size(); ++i)
    order[begin[cell_of(primitives[i])]++] = static_cast<std::uint16_t>(i);
  for (std::size_t c = kCells; c > 0; --c) begin[c] = begin[c - 1];
  begin[0] = 0;
}

}  // namespace accrete::associate
