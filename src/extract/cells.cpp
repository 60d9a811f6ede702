#include "extract/cells.h"

#include <algorithm>
#include <cstring>

namespace accrete::extract {
namespace {

static_assert(kChunk <= kPadding);  // the last chunk reads beyond the row

constexpr float kChromaOverLuma = 4.0F;  // ratio of energies: twice the amplitude

// Along an edge the energy hardly changes: without a preference for the middle of the cell noise would choose, and
// every second choice would lie so near to its neighbour's that one of them is suppressed (measured: 0.56 instead of
// 0.7 primitives a pitch). A parabola that costs 60 % in a cell's corners still lets a clearly stronger edge win.
constexpr float kOffCentre = 0.6F / 10.25F;  // per px^2; a corner lies sqrt(10.25) px from the middle

MaximaRows rows_of(const QuadratureFilter& f, int y, const QuadratureFilter& rival) {
  return {f.energy(y - 1), f.energy(y), f.energy(y + 1), f.odd_x(y), f.odd_y(y), rival.energy(y)};
}

bool apart(const CellWinner& a, const CellWinner& b) {
  const int dx = a.x - b.x, dy = a.y - b.y;
  return 4 * (dx * dx + dy * dy) >= kPitch * kPitch;
}

void offer(const CellWinner& candidate, Cell& cell) {
  if (candidate.score > cell.first.score) {
    if (apart(cell.first, candidate))
      cell.second = cell.first;
    else if (!apart(cell.second, candidate))
      cell.second = {};
    cell.first = candidate;
  } else if (candidate.score > cell.second.score && apart(candidate, cell.first)) {
    cell.second = candidate;
  }
}

// Of a channel, where `rival` is at most 1 / share of it.
void offer(const QuadratureFilter& filter, Channel channel, int y, int width, float min_energy,
           const QuadratureFilter& rival, float share, std::span<Cell> cells) {
  const MaximaRows r = rows_of(filter, y, rival);
  const int band = y / kBand, offset = (band & 1) != 0 ? kPitch / 2 : 0;
  const float dy = static_cast<float>(y - band * kBand) - 0.5F * (kBand - 1);
  const auto take = [&](int x) {
    const int index = (x + offset) / kPitch;
    const float dx = static_cast<float>(x + offset - index * kPitch) - 0.5F * (kPitch - 1);
    const float score = r.here[x] * (1 - kOffCentre * (dx * dx + dy * dy));
    offer({score, static_cast<std::int16_t>(x), static_cast<std::int16_t>(y), channel},
          cells[static_cast<std::size_t>(index)]);
  };
  std::int32_t keep[kChunk];
  const int end = width - kMargin;
  for (int x = kMargin; x < end; x += kChunk) {
    // The last chunk reads into the row's padding; what it finds there is not taken.
    if (!filter.kernels().find_maxima(r, x, min_energy, share, keep)) continue;
    const int n = std::min(kChunk, end - x);
    for (int i = 0; i < n; i += 4) {
      std::int64_t four[2];
      std::memcpy(four, keep + i, sizeof(four));
      if ((four[0] | four[1]) == 0) continue;
      for (int k = i; k < std::min(i + 4, n); ++k)
        if (keep[k] != 0) take(x + k);
    }
  }
}

}  // namespace

void offer_row(const QuadratureFilter& luma, const QuadratureFilter* chroma, int y, int width, float min_energy,
               std::span<Cell> cells) {
  if (chroma == nullptr) {
    offer(luma, Channel::kLuma, y, width, min_energy, luma, 0, cells);
    return;
  }
  offer(luma, Channel::kLuma, y, width, min_energy, *chroma, 1 / kChromaOverLuma, cells);
  offer(*chroma, Channel::kChroma, y, width, min_energy, luma, kChromaOverLuma, cells);
}

}  // namespace accrete::extract
