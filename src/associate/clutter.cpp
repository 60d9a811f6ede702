#include "associate/clutter.h"

#include <algorithm>
#include <cmath>

#include "associate/gate_kernel.h"
#include "base/angles.h"
#include "base/elementary.h"

namespace accrete::associate {
namespace {

int bin(float value, float span, int bins) {
  return std::clamp(static_cast<int>(value / span * static_cast<float>(bins)), 0, bins - 1);
}

float undirected(const LineElement& e) {
  float a = atan2_of(e.s, e.c);
  if (a < 0) a += kPi;
  return a >= kPi ? a - kPi : a;
}

}  // namespace

void Clutter::measure(std::span<const Primitive2d> primitives, const Grid& grid, float gate_length_px) {
  // Histograms start with one count in each bin: an orientation that was not seen is rare, not impossible.
  phase_density.fill(1);
  angle_density.fill(1);
  std::array<double, 3> sum{};
  std::array<double, 6> sum2{};  // rr rg rb gg gb bb
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const Primitive2d& p = primitives[i];
    ++phase_density[static_cast<std::size_t>(bin(p.appearance.phase + kPi, 2 * kPi, kPhaseBins))];
    const int angle = bin(undirected(p.aligned), kPi, kAngleBins);
    ++angle_density[static_cast<std::size_t>(angle)];
    density[i] = static_cast<float>(angle);  // until the densities are known
    for (const auto* side : {&p.appearance.left, &p.appearance.right})
      for (std::size_t c = 0, k = 0; c < 3; ++c) {
        sum[c] += (*side)[c];
        for (std::size_t d = c; d < 3; ++d, ++k) sum2[k] += (*side)[c] * (*side)[d];
      }
  }
  const auto n = static_cast<float>(primitives.size());
  for (float& v : phase_density) v *= kPhaseBins / (2 * kPi * (n + kPhaseBins));
  for (float& v : angle_density) v *= kAngleBins / (kPi * (n + kAngleBins));
  // Reversing an edge negates its phase: both bins describe the same structure.
  for (std::size_t k = 0; k < log_phase.size(); ++k)
    log_phase[k] = log_of(0.5F * (phase_density[kPhaseBins / 2 + k] + phase_density[kPhaseBins / 2 - 1 - k]));

  const double m = std::max(1.0, 2.0 * n);
  std::array<double, 6> cov{};
  for (std::size_t c = 0, k = 0; c < 3; ++c)
    for (std::size_t d = c; d < 3; ++d, ++k) cov[k] = sum2[k] / m - sum[c] / m * (sum[d] / m);
  for (std::size_t c = 0; c < 3; ++c) mean[c] = static_cast<float>(sum[c] / m);
  // 0.1^2: an image of one colour says little about the next edge in it.
  variance = {static_cast<float>(cov[0]) + 0.01F, static_cast<float>(cov[3]) + 0.01F,
              static_cast<float>(cov[5]) + 0.01F};
  log_colour_height = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    half_precision[c] = 0.5F / variance[c];
    log_colour_height -= log_of(2 * kPi * variance[c]);
  }
  // Participation ratio of the colour covariance, tr(C)^2 / tr(C^2): 1 when the channels are copies of each other.
  const double trace = cov[0] + cov[3] + cov[5];
  const double squares =
      cov[0] * cov[0] + cov[3] * cov[3] + cov[5] * cov[5] + 2 * (cov[1] * cov[1] + cov[2] * cov[2] + cov[4] * cov[4]);
  independent_channels = squares > 1e-12 ? static_cast<float>(std::clamp(trace * trace / squares, 1.0, 3.0)) : 1.0F;

  // Local density: primitives in the 5 x 5 cells around (60 px, METHOD 6.2 says 64), times the gate's length.
  constexpr float kArea = 25 * Grid::kCell * Grid::kCell;
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const int cx = Grid::cell(primitives[i].aligned.x_px), cy = Grid::cell(primitives[i].aligned.y_px);
    const int x0 = std::max(cx - 2, 0), x1 = std::min(cx + 2, Grid::kSide - 1);
    std::uint32_t count = 0;
    for (int y = std::max(cy - 2, 0); y <= std::min(cy + 2, Grid::kSide - 1); ++y) {
      const auto row = static_cast<std::size_t>(y) * Grid::kSide;
      count += grid.begin[row + static_cast<std::size_t>(x1) + 1] - grid.begin[row + static_cast<std::size_t>(x0)];
    }
    density[i] =
        static_cast<float>(count) / kArea * gate_length_px * angle_density[static_cast<std::size_t>(density[i])];
  }
}

float Clutter::log_geometry(std::size_t i) const { return log_of(density[i]); }

float Clutter::log_appearance(const Appearance& a) const {
  const float look[7] = {a.phase, a.left[0], a.left[1], a.left[2], a.right[0], a.right[1], a.right[2]};
  return clutter_log_appearance(*this, look);
}

}  // namespace accrete::associate
