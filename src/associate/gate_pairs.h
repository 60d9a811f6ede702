// Candidate pairs, an expected primitive and what one eye or both saw, gated on lanes.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "accrete/primitive.h"
#include "associate/clutter.h"
#include "associate/gate.h"
#include "associate/grid.h"
#include "math/isa.h"
#include "predict/predict.h"

namespace accrete::associate {

// A primitive that should be seen now.
struct Expected {
  PredictedObservation predicted;
  Appearance mean;
  float variance[7];  // of appearance, predicted
  float visible;      // P_vis
  float detection;    // p_d of one eye
  Noise noise;
};

// One image of the pair.
struct EyeView {
  std::span<const Primitive2d> primitives;
  const Grid* grid;
  const Clutter* clutter;
};

// Pairs that wait to be gated together, and what came out. No pair sees another.
struct PairBatch {
  static constexpr std::size_t kCapacity = 64;  // a multiple of all lanes: what lies beyond `count` may be overwritten

  std::size_t count = 0;
  std::array<std::uint32_t, kCapacity> expected;  // indices
  std::array<std::uint16_t, kCapacity> left, right;

  std::array<float, kCapacity> d2;              // of the geometry alone; infinity where its covariance is none
  std::array<float, kCapacity> log_likelihood;  // IPDA bracket of METHOD 7.2; -infinity where a gate is closed
  // Not zero where the element is described in the opposite direction.
  std::array<std::int32_t, kCapacity> left_reversed, right_reversed;
};

// Of the instruction set that this file is compiled for; a step takes those of the best one from kernels/kernels.h.
inline namespace ACCRETE_ISA {

// Both eyes: gates of 4 and 11 degrees of freedom. Appearance is that of both eyes together, against the left image's
// clutter. Preconditions: indices lie inside the spans; pairs.count <= kCapacity.
void gate_both_eyes(std::span<const Expected> expected, const EyeView& left, const EyeView& right, PairBatch& pairs);

// Eye 0 with batch.left, or 1 with batch.right: gates of 2 and 9 degrees of freedom.
void gate_one_eye(std::span<const Expected> expected, const EyeView& view, int eye, PairBatch& pairs);

}  // namespace ACCRETE_ISA

// The two of one instruction set.
struct GateKernels {
  decltype(&associate::gate_both_eyes) both_eyes;
  decltype(&associate::gate_one_eye) one_eye;
};

}  // namespace accrete::associate
