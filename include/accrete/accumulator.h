// The pipeline: stereo images and a motion in, an accumulated model out. Owns all of its memory; `step` allocates
// nothing. One thread at a time may use one Accumulator; several are independent of each other.
#pragma once

#include <memory>
#include <span>

#include "accrete/camera.h"
#include "accrete/limits.h"
#include "accrete/model.h"
#include "accrete/motion.h"
#include "accrete/params.h"
#include "accrete/primitive.h"
#include "accrete/step_report.h"
#include "accrete/stereo_frame.h"

namespace accrete {

// TO BE FILLED IN: storage. The interface stands.
template <class Limits = DefaultLimits>
class Accumulator {
 public:
  Accumulator();
  Accumulator(const Accumulator&) = delete;
  Accumulator& operator=(const Accumulator&) = delete;

  // Sets rig and parameters and empties the model. Status: kInvalidArgument (rig or params: see their validate),
  // kCapacityExceeded (an image larger than Limits). On failure the accumulator is unchanged.
  Status configure(const StereoRig& rig, const Params& params = {});

  // Empties the model; rig and parameters stay.
  void reset();

  // One frame. Status in the report: kUnavailable (not configured), kInvalidArgument (image size or view unlike the rig,
  // invalid motion, time not after the previous frame's): then nothing in the store has changed.
  StepReport step(const StereoFrame& frame, const Motion& motion);

  [[nodiscard]] ModelView model() const;
  // Of the latest frame, valid until the next step.
  [[nodiscard]] std::span<const Primitive2d> left_primitives() const;
  [[nodiscard]] std::span<const Primitive2d> right_primitives() const;
  [[nodiscard]] std::span<const StereoMatch> stereo_matches() const;

  void set_observer(StageObserver observer);
};

}  // namespace accrete
