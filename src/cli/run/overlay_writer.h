// Pictures of every N-th frame into the folder of the results, while the run goes on.
#pragma once

#include <optional>

#include "cli/failure.h"
#include "cli/run/accumulate.h"
#include "cli/write/result_folder.h"

namespace accrete::cli {

inline constexpr const char* kOverlayFolder = "overlay";  // among the results

class OverlayWriter {
 public:
  // `every`: 0 writes nothing.
  OverlayWriter(const ResultFolder& folder, const StereoRig& rig, int every)
      : folder_(folder), rig_(rig), every_(every) {}

  // overlay/NNNNNN_overview.png, _primitives.png, _matches.png and _model.png when the frame's number is a multiple of
  // N. The first failure ends the pictures, not the run.
  void frame(const FrameContext& context);

  [[nodiscard]] const std::optional<Failure>& failure() const { return failure_; }

 private:
  const ResultFolder& folder_;
  const StereoRig& rig_;
  int every_;
  std::optional<Failure> failure_;
};

}  // namespace accrete::cli
