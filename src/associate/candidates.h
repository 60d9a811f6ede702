// What could be an expected primitive's observation: the elements near it, gated, and the best hypotheses from them.
#pragma once

#include <array>

#include "associate/gate_pairs.h"
#include "associate/one_to_one.h"

namespace accrete::associate {

inline constexpr float kSlideGate = 4.5F;  // px along the edge: three quarters of a pitch (METHOD 5.2)

// For every left primitive, up to a few right ones with which it is already explained by some expected primitive,
// matched or not: no births there (METHOD 6.5).
struct Explained {
  static constexpr std::size_t kMax = 6;
  std::array<std::uint16_t, kMax> right;
  std::uint8_t count = 0;
};

// An element of one eye that is inside the gate of its geometry.
struct Candidate {
  float d2, log_likelihood;
  std::uint16_t index;
  bool reversed;
};
using CandidateList = NearestList<Candidate>;

// Memory for the expected primitives whose candidates are gated together: one pair alone would waste the lanes.
struct GatingRoom {
  static constexpr std::size_t kGroup = 16;
  PairBatch pairs;
  CandidateList candidates[2][kGroup];
  HypothesisList hypotheses[kGroup];
};

// log likelihood of a miss (METHOD 7.2).
[[nodiscard]] float log_miss(const Expected& e);

// room.hypotheses[k]: those of expected[first + k], k < count <= kGroup.
void find_hypotheses(std::span<const Expected> expected, std::size_t first, std::size_t count, const EyeView& left,
                     const EyeView& right, const GateKernels& gate, std::span<Explained> explained, GatingRoom& room);

}  // namespace accrete::associate
