// 2D-primitives of one image ordered by rows of the aligned image: epipolar lines are rows there.
#pragma once

#include <cstdint>
#include <span>

#include "accrete/primitive.h"

namespace accrete::stereo {

inline constexpr int kRowHeight = 2;  // px
// Rows of the index: the aligned image is taller than the raw one where a lens bends it; rows beyond share the last.
inline constexpr int kRows = 2048;

struct RowIndex {
  std::span<std::uint16_t> order;  // as many as primitives
  std::span<std::uint32_t> begin;  // kRows + 1

  // Row of an aligned y; the principal point is in the middle.
  [[nodiscard]] static int row(float y_px);
  void build(std::span<const Primitive2d> primitives);
  // Indices of the primitives in rows row(y_low) .. row(y_high).
  [[nodiscard]] std::span<const std::uint16_t> between(float y_low, float y_high) const;
};

}  // namespace accrete::stereo
