// The loops of extraction over all pixels of a row: plain loops, compiled once per instruction set (kernels/kernels.h).
#pragma once

#include <cstdint>

#include "math/isa.h"

namespace accrete::extract {

inline constexpr int kRadius = 4;  // of the kernels, px
inline constexpr int kTaps = 2 * kRadius + 1;

// Half of each symmetric kernel, centre first. The odd kernel is rank 1: derivative-like along one axis, smoothing
// along the other (leading singular vectors of the ideal kernel; residual energy 0.24 %), signed so that an intensity
// that grows along +x gives a negative response: phase -pi/2 (METHOD 1.1). tests/core/quadrature_test.cpp recomputes
// all of them.
struct Kernels {
  float gauss1[5], gauss2[5];  // sigma 1 and 2, sum 1 over 9 taps: the even kernel sums to zero
  float odd[5], smooth[5];     // odd[0] is 0
};
inline constexpr Kernels kKernels = {{0.398943469F, 0.241971446F, 0.0539911274F, 0.00443186162F, 0.000133830625F},
                                     {0.20416369F, 0.18017382F, 0.12383154F, 0.06628225F, 0.02763055F},
                                     {0.0F, -0.22167193F, -0.13051791F, -0.02132087F, 0.00958159F},
                                     {0.2607094F, 0.1736673F, 0.05048345F, 0.00366416F, -0.00356738F}};

// The four passes along a row, or along a column of them.
inline constexpr int kPasses = 4;
enum Pass : std::uint8_t { kGauss1, kGauss2, kOdd, kSmooth };

// Energies of three rows, the odd part of the middle one, and another channel's energy there.
struct MaximaRows {
  const float *above, *here, *below, *odd_x, *odd_y, *rival;
};
inline constexpr int kChunk = 32;  // pixels whose verdicts are computed at once, without branches

// Of the instruction set that this file is compiled for; a step takes those of the best one.
inline namespace ACCRETE_ISA {

// Grey levels of `width` pixels of one byte, or of three as their sum by `weights`.
void load_grey(const std::uint8_t* pixels, int width, float* out);
void load_colour(const std::uint8_t* pixels, int width, const float* weights, float* out);

// To the nearest whole grey level. Precondition: 0 <= in[x] < 255.5.
void round_to_bytes(const float* in, int width, std::uint8_t* out);

// The four passes along a row. Precondition: kRadius values are there on both sides of in[0 .. width).
void filter_along(const float* in, int width, float* const* out);

// The responses of the middle one of nine rows, and their energy, the sum of the three squares: rows[pass][i] is what
// filter_along() made of the row at i - kRadius. Nothing overlaps.
void filter_across(const float* const (*rows)[kTaps], int width, float* even, float* odd_x, float* odd_y,
                   float* energy);

// keep[i], i < kChunk, is 1 where pixel x + i is a maximum across the edge, above the threshold, and `rival` is below
// 1 / share of it; else 0. Returns whether there is one.
bool find_maxima(const MaximaRows& rows, int x, float min_energy, float share, std::int32_t* keep);

}  // namespace ACCRETE_ISA

// Those of one instruction set.
struct RowKernels {
  decltype(&extract::load_grey) load_grey;
  decltype(&extract::load_colour) load_colour;
  decltype(&extract::round_to_bytes) round_to_bytes;
  decltype(&extract::filter_along) filter_along;
  decltype(&extract::filter_across) filter_across;
  decltype(&extract::find_maxima) find_maxima;
};

}  // namespace accrete::extract
