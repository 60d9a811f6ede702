#include "stereo/row_index.h"

#include <algorithm>
#include <cmath>

namespace accrete::stereo {

int RowIndex::row(float y_px) {
  const float r = std::floor(y_px / kRowHeight) + kRows / 2;
  return static_cast<int>(std::clamp(r, 0.0F, static_cast<float>(kRows - 1)));
}

void RowIndex::build(std::span<const Primitive2d> primitives) {
  std::fill(begin.begin(), begin.end(), 0U);
  for (const Primitive2d& p : primitives) ++begin[static_cast<std::size_t>(row(p.aligned.y_px)) + 1];
  for (std::size_t r = 0; r < kRows; ++r) begin[r + 1] += begin[r];
  // Filling moves each row's begin to its end; shifting by one row afterwards restores them.
  for (std::size_t i = 0; i < primitives.size(); ++i)
    order[begin[static_cast<std::size_t>(row(primitives[i].aligned.y_px))]++] = static_cast<std::uint16_t>(i);
  for (std::size_t r = kRows; r > 0; --r) begin[r] = begin[r - 1];
  begin[0] = 0;
}

std::span<const std::uint16_t> RowIndex::between(float y_low, float y_high) const {
  const std::uint32_t a = begin[static_cast<std::size_t>(row(y_low))];
  const std::uint32_t b = begin[static_cast<std::size_t>(row(y_high)) + 1];
  return std::span<const std::uint16_t>(order).subspan(a, b - a);
}

}  // namespace accrete::stereo
