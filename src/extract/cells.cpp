#include "extract/cells.h"

#include <algorithm>
#include <cstring>

namespace accrete::extract {
namespace {

constexpr int kChunk = 64;  // pixels whose verdicts are computed at once, without branches

constexpr float kChromaOverLuma = 4.0F;  // ratio of energies: twice the amplitude

// Along an edge the energy hardly changes: without a preference for the middle of the cell noise would choose, and
// every second choice would lie so near to its neighbour's that one of them is suppressed (measured: 0.56 instead of
// 0.7 primitives a pitch). A parabola that costs 60 % in a cell's corners still lets a clearly stronger edge win.
constexpr float kOffCentre = 0.6F / 10.25F;  // per px^2; a corner lies sqrt(10.25) px from the middle

struct Rows {
  const float *above, *here, *below, *odd_x, *odd_y;
};

Rows rows_of(const QuadratureFilter& f, int y) {
  return {f.energy(y - 1), f.energy(y), f.energy(y + 1), f.odd_x(y), f.odd_y(y)};
}

// keep[i] is 1 where pixel x + i is a maximum across the edge, above the threshold, and `rival` is below `share` of it.
void find_maxima(const Rows& r, int x, float min_energy, const float* rival, float share, std::uint8_t* keep) {
  for (int i = 0; i < kChunk; ++i) {
    const float e = r.here[x + i];
    const float ax = r.odd_x[x + i] * r.odd_x[x + i], ay = r.odd_y[x + i] * r.odd_y[x + i];
    const float p = ax >= ay ? r.here[x + i - 1] : r.above[x + i];
    const float q = ax >= ay ? r.here[x + i + 1] : r.below[x + i];
    keep[i] = static_cast<std::uint8_t>((e > min_energy) & (e > p) & (e >= q) & (rival[x + i] * share <= e));
  }
}

void offer(const Rows& r, Channel channel, int y, int width, float min_energy, const float* rival, float share,
           std::span<CellWinner> cells) {
  const int band = y / kBand, offset = (band & 1) != 0 ? kPitch / 2 : 0;
  const float dy = static_cast<float>(y - band * kBand) - 0.5F * (kBand - 1);
  const auto take = [&](int x) {
    const int index = (x + offset) / kPitch;
    const float dx = static_cast<float>(x + offset - index * kPitch) - 0.5F * (kPitch - 1);
    const float score = r.here[x] * (1 - kOffCentre * (dx * dx + dy * dy));
    CellWinner& cell = cells[static_cast<std::size_t>(index)];
    if (score > cell.score) cell = {score, static_cast<std::int16_t>(x), static_cast<std::int16_t>(y), channel};
  };
  std::uint8_t keep[kChunk];
  const int end = width - kMargin;
  for (int x = kMargin; x < end; x += kChunk) {
    // The last chunk reads into the row's padding; what it finds there is not taken.
    find_maxima(r, x, min_energy, rival, share, keep);
    const int n = std::min(kChunk, end - x);
    for (int i = 0; i < n; i += 8) {
      std::uint64_t eight;
      std::memcpy(&eight, keep + i, 8);
      if (eight == 0) continue;
      for (int k = i; k < std::min(i + 8, n); ++k)
        if (keep[k] != 0) take(x + k);
    }
  }
}

}  // namespace

void offer_row(const QuadratureFilter& luma, const QuadratureFilter* chroma, int y, int width, float min_energy,
               std::span<CellWinner> cells) {
  const Rows l = rows_of(luma, y);
  if (chroma == nullptr) {
    offer(l, Channel::kLuma, y, width, min_energy, l.here, 0, cells);
    return;
  }
  const Rows c = rows_of(*chroma, y);
  offer(l, Channel::kLuma, y, width, min_energy, c.here, 1 / kChromaOverLuma, cells);
  offer(c, Channel::kChroma, y, width, min_energy, l.here, kChromaOverLuma, cells);
}

}  // namespace accrete::extract
