// Which observation belongs to which predicted primitive: one to one, by geometry and appearance (METHOD 6).
#pragma once

#include <span>

#include "associate/candidates.h"

namespace accrete::associate {

enum class AssociateOutcome : std::uint8_t {
  kMissed,     // nothing in its gate
  kStereo,     // both eyes
  kMono,       // one eye
  kAmbiguous,  // two contours fit about equally well: no evidence either way
  kStarved,    // its observation belongs to a neighbour on the same contour: no evidence either way
};

struct Association {
  AssociateOutcome outcome = AssociateOutcome::kMissed;
  std::int32_t left = kNone, right = kNone;
  bool left_reversed = false, right_reversed = false;
  float log_likelihood_ratio = 0;  // IPDA bracket of METHOD 7.2 for both eyes; not clipped
  float d2 = 0;                    // squared geometric innovation of a match: 4 degrees of freedom, 2 of one eye
};

struct Scratch {
  std::span<Hypothesis> hypotheses;    // room for kPerExpected per expected primitive
  std::span<std::int32_t> left_owner;  // per left primitive: index of the expected one, or kNone
  std::span<std::int32_t> right_owner;
  std::span<Explained> explained;  // per left primitive
  GatingRoom* room;
};

// out.size() == expected.size().
void associate(std::span<const Expected> expected, const EyeView& left, const EyeView& right, const GateKernels& gate,
               Scratch& scratch, std::span<Association> out);

}  // namespace accrete::associate
