// New 3D-primitives from stereo pairs that nothing explains yet (METHOD 3, 6.5).
#pragma once

#include "accrete/params.h"
#include "accrete/step_report.h"
#include "associate/associate.h"
#include "math/aligned.h"
#include "store/store.h"

namespace accrete {

struct BirthInput {
  std::span<const Primitive2d> left, right;
  std::span<const StereoMatch> matches;
  std::span<const std::int32_t> left_owner, right_owner;  // kNone where no primitive was matched
  std::span<const associate::Explained> explained;
  AlignedPose pose;
  AlignedOptics optics;
  std::uint32_t frame;
};

// Makes room by eviction of undecided primitives where needed. Existence begins at the match's probability.
void give_birth(const BirthInput& in, const Params& params, Store& store, StepReport& report);

}  // namespace accrete
