// Faults of a rig as transformations that undo them. docs/math/rig_checks.md
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/doctor/diagnosis.h"

namespace accrete::cli {

struct Hypothesis {
  std::string fault;
  StereoRig rig;       // as it would be without the fault
  ImageChange change;  // of the images, likewise
  std::string what, advice;
  bool fitted = false;  // has a parameter that was fitted to the evidence: must explain more
  RigEvidence evidence;
};

// Of the eyes and how the images lie: they need pairs found in mirrored images too.
[[nodiscard]] std::vector<Hypothesis> image_hypotheses(const StereoRig& rig);
// Of R and T, the intrinsics and the lenses.
[[nodiscard]] std::vector<Hypothesis> rig_hypotheses(const StereoRig& rig, const RigView& view,
                                                     const std::vector<std::vector<Pair>>& stereo);

// Of the lenses alone.
[[nodiscard]] std::vector<Hypothesis> lens_hypotheses(const StereoRig& rig,
                                                      const std::vector<std::vector<Pair>>& stereo);

// The pairs that are found once one image is mirrored as `change` says, in pixels of the images as they lie on disk.
[[nodiscard]] std::vector<std::vector<Pair>> pair_mirrored(const Samples& samples, bool columns, bool rows);

}  // namespace accrete::cli
