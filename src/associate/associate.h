// Which observation belongs to which predicted primitive: one to one, by geometry and appearance (METHOD 6).
#pragma once

#include <span>

#include "associate/candidates.h"

namespace accrete::associate {

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
