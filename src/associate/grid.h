// A uniform grid over the 2D-primitives of one aligned image: who is near this point?
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "accrete/primitive.h"

namespace accrete::associate {

struct Grid {
  static constexpr int kSide = 256;      // cells
  static constexpr float kCell = 12.0F;  // px: two pitches, about a gate's width; the grid spans 3072 px
  static constexpr std::size_t kCells = static_cast<std::size_t>(kSide) * kSide;

  std::span<std::uint32_t> begin;  // kCells + 1
  std::span<std::uint16_t> order;  // as many as primitives

  void build(std::span<const Primitive2d> primitives);

  // Points beyond the grid share its border cells.
  [[nodiscard]] static int cell(float v_px) {
    return static_cast<int>(std::clamp(std::floor(v_px / kCell) + kSide / 2, 0.0F, static_cast<float>(kSide - 1)));
  }
  // Calls visit(index) for every primitive in the cells that touch the square of half side `radius_px` around the
  // point.
  template <class Visit>
  void near(float x_px, float y_px, float radius_px, Visit visit) const {
    const int x0 = cell(x_px - radius_px), x1 = cell(x_px + radius_px);
    const int y0 = cell(y_px - radius_px), y1 = cell(y_px + radius_px);
    for (int y = y0; y <= y1; ++y) {
      const auto row = static_cast<std::size_t>(y) * kSide;
      const std::uint32_t a = begin[row + static_cast<std::size_t>(x0)],
                          b = begin[row + static_cast<std::size_t>(x1) + 1];
      for (std::uint32_t i = a; i < b; ++i) visit(order[i]);
    }
  }
};

}  // namespace accrete::associate
