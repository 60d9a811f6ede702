// What one step did, in counts. Outcomes that the mathematics expects are counted here and are no errors.
#pragma once

#include <cstdint>

#include "accrete/status.h"

namespace accrete {

// In the order of the data; the observer is called at the beginning and at the end of each.
enum class Stage : std::uint8_t { kExtract, kStereo, kPredict, kAssociate, kFilter, kExistence, kStore };
inline constexpr int kStageCount = 7;

[[nodiscard]] constexpr const char* to_string(Stage stage) {  // "extract", "stereo", ...
  constexpr const char* kNames[kStageCount] = {"extract", "stereo",    "predict", "associate",
                                               "filter",  "existence", "store"};
  return kNames[static_cast<int>(stage)];
}

// The core reads no clock: whoever wants times gives a function that does.
struct StageObserver {
  void (*notify)(void* context, Stage stage, bool begins) = nullptr;
  void* context = nullptr;
};

struct ExtractCounts {
  std::uint32_t primitives = 0;
  std::uint32_t refused_fill = 0;        // kernel touches fill of exact zeros (border of a warped image)
  std::uint32_t refused_dimension = 0;   // homogeneous or junction
  std::uint32_t refused_capacity = 0;    // weaker than the budget allows
  std::uint32_t refused_distortion = 0;  // outside the domain of the camera model
};

struct StepReport {
  Status status = Status::kOk;  // not kOk: nothing has changed
  std::uint32_t frame = 0;      // 0, 1, ... frames that were used
  bool motion_covariance_is_default = false;

  ExtractCounts left, right;

  std::uint32_t stereo_matches = 0;           // hypotheses, rivals included
  std::uint32_t stereo_ambiguous = 0;         // left primitives with more than one hypothesis
  std::uint32_t stereo_refused_epipolar = 0;  // nearly parallel to the epipolar line
  std::uint32_t stereo_refused_capacity = 0;

  std::uint32_t predicted_visible = 0;
  std::uint32_t predicted_behind = 0;      // behind a camera or at its centre
  std::uint32_t predicted_degenerate = 0;  // in front, but the line has no image: it passes through a camera's centre
  std::uint32_t matched_stereo = 0;
  std::uint32_t matched_mono = 0;
  std::uint32_t missed = 0;     // visible, nothing in the gate
  std::uint32_t ambiguous = 0;  // two contours in the gate: treated as hidden
  std::uint32_t starved = 0;    // its observation went to a neighbour on the same contour
  std::uint32_t updated = 0;
  std::uint32_t not_novel = 0;              // the view had hardly changed: no update
  std::uint32_t not_positive_definite = 0;  // the pose would have been no Gaussian: not updated
  std::uint32_t update_behind = 0;          // came behind a camera or into its centre: not updated
  std::uint32_t roll_refused = 0;           // the same two outcomes of the roll about the tangent
  std::uint32_t appearance_refused = 0;     // the appearance would have been no Gaussian: not updated

  std::uint32_t born = 0;
  std::uint32_t birth_refused_degenerate = 0;  // planes nearly coincide, or the noise reaches infinity or the cameras
  std::uint32_t birth_refused_behind = 0;      // behind the cameras
  std::uint32_t birth_refused_range = 0;       // so far from the map's origin that float cannot hold the position
  std::uint32_t birth_refused_excluded = 0;    // inside an excluded box (gripper)
  std::uint32_t birth_refused_capacity = 0;    // the store is full of better ones
  std::uint32_t newly_confirmed = 0;
  std::uint32_t deleted_existence = 0;
  std::uint32_t deleted_undecided = 0;   // too old to stay undecided
  std::uint32_t deleted_background = 0;  // does not move with the given motion
  std::uint32_t merged = 0;
  std::uint32_t merge_refused = 0;  // duplicates whose fusion would have been no Gaussian
  std::uint32_t evicted = 0;        // the store was full

  std::uint32_t tentative = 0, confirmed = 0, preserved = 0;  // after the step
};

}  // namespace accrete
