#include "extract/cells.h"

#include <algorithm>
#include <cstring>

namespace accrete::extract {
namespace {

constexpr int kChunk = 32;  // pixels whose verdicts are computed at once, without branches; at most a row's padding

static_assert(kChunk <= kPadding);

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
// Both neighbours are loaded before one is chosen, and verdicts are as wide as pixels: compilers vectorise this form.
void find_maxima(const Rows& r, int x, float min_energy, const float* rival, float share,
                 std::int32_t* __restrict keep) {
  const float *here = r.here + x, *above = r.above + x, *below = r.below + x, *ox = r.odd_x + x, *oy = r.odd_y + x;
  const float* other = rival + x;
  for (int i = 0; i < kChunk; ++i) {
    const float e = here[i], left = here[i - 1], right = here[i + 1], up = above[i], down = below[i];
    // On the ridge of a line both odd parts vanish: there the pair of neighbours that is lower lies across it.
    const float xx = ox[i] * ox[i], yy = oy[i] * oy[i];
    const bool along_x = (xx > yy) | ((xx == yy) & (left + right <= up + down));
    const float p = along_x ? left : up, q = along_x ? right : down;
    keep[i] = static_cast<std::int32_t>((e > min_energy) & (e > p) & (e >= q) & (other[i] * share <= e));
  }
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

void offer(const Rows& r, Channel channel, int y, int width, float min_energy, const float* rival, float share,
           std::span<Cell> cells) {
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
    find_maxima(r, x, min_energy, rival, share, keep);
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
