// How densely an image is filled with primitives that could be taken for an expected one (METHOD 6.2).
#pragma once

#include <array>
#include <span>

#include "accrete/primitive.h"
#include "associate/grid.h"

namespace accrete::associate {

// The distribution of appearance in one image: a histogram of phase, and a Gaussian of the side colours.
struct Clutter {
  static constexpr int kPhaseBins = 8, kAngleBins = 12;
  std::array<float, kPhaseBins> phase_density{};  // per rad
  std::array<float, kAngleBins> angle_density{};  // per rad, of undirected orientations
  std::array<float, 3> mean{}, variance{};        // of a side's RGB, 0..1
  float independent_channels = 1;                 // 1 for grey .. 3: how much three channels say
  // Per primitive: density of chance observations there, in (normal offset px) x (angle rad): primitives per px of
  // normal offset in a gate, times the density of its angle.
  std::span<float> density;

  // Of log_appearance, what is the same for all: 1 / (2 variance), the log of the Gaussians' height, and the log of the
  // phase's density, symmetrised, in equal parts of |phase|.
  std::array<float, 3> half_precision{};
  float log_colour_height = 0;
  std::array<float, kPhaseBins / 2> log_phase{};

  // `gate_length_px`: the length along the edge in which a primitive is accepted.
  void measure(std::span<const Primitive2d> primitives, const Grid& grid, float gate_length_px);

  // log of density[i]: geometry alone.
  [[nodiscard]] float log_geometry(std::size_t i) const;
  // log density of chance appearances `a` in (phase) x (left RGB) x (right RGB), colours scaled to the independent
  // channels: the counterpart of log_appearance_likelihood (gate.h).
  [[nodiscard]] float log_appearance(const Appearance& a) const;
};

}  // namespace accrete::associate
