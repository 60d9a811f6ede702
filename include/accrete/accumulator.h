// The pipeline: stereo images and a motion in, an accumulated model out. Owns all of its memory; `step` allocates
// nothing. One thread at a time may use one Accumulator; several are independent of each other.
#pragma once

#include <cstddef>
#include <span>

#include "accrete/camera.h"
#include "accrete/instruction_set.h"
#include "accrete/limits.h"
#include "accrete/model.h"
#include "accrete/motion.h"
#include "accrete/observed_frame.h"
#include "accrete/pair_runner.h"
#include "accrete/params.h"
#include "accrete/primitive.h"
#include "accrete/saved_model.h"
#include "accrete/step_report.h"
#include "accrete/stereo_frame.h"

namespace accrete {

// kInvalidArgument: what CheckedLimits does not let compile, a store with zero capacity for one.
[[nodiscard]] Status validate(const Capacities& capacities);

class Pipeline;  // src/accumulator

// Bytes that a pipeline needs, within 3 % (tests/memory/storage_test.cpp): what src/accumulator/workspace.cpp cuts,
// which this header does not show.
[[nodiscard]] constexpr std::size_t storage_bytes(const Capacities& c) {
  const std::size_t stride = (c.image_width + 15) / 16 * 16;  // of rows of floats: cache lines
  return 640 * 1024                                           // grids, row indices, the pipeline itself, alignment
         + stride * 1616 + c.image_width * 8                  // rows of filter responses and their cells, both eyes
         + c.image_width * c.image_height * 2                 // the previous grey images
         + c.primitives2d * 566 + c.primitives3d * 932 + c.stereo_matches * 20;
}

// Compiled once, whatever the capacities. `memory`: aligned to 64, at least storage_bytes(capacities). `set` must be
// available. Capacities that are not valid make a pipeline without any memory, whose configure() says so.
Pipeline* construct_pipeline(std::span<std::byte> memory, const Capacities& capacities,
                             InstructionSet set = InstructionSet::kBest);
Status configure(Pipeline& pipeline, const StereoRig& rig, const Params& params);
void reset(Pipeline& pipeline);
StepReport step(Pipeline& pipeline, const StereoFrame& frame, const Motion& motion);
StepReport step(Pipeline& pipeline, const ObservedFrame& frame, const Motion& motion);
std::size_t saved_bytes(const Pipeline& pipeline);
Status save(const Pipeline& pipeline, std::span<std::byte> to);
RestoreReport restore(Pipeline& pipeline, std::span<const std::byte> from, RestoredClock clock);
ModelView model(const Pipeline& pipeline);
std::span<const Primitive2d> left_primitives(const Pipeline& pipeline);
std::span<const Primitive2d> right_primitives(const Pipeline& pipeline);
std::span<const StereoMatch> stereo_matches(const Pipeline& pipeline);
void set_observer(Pipeline& pipeline, StageObserver observer);
void set_pair_runner(Pipeline& pipeline, PairRunner runner);

// Megabytes: put it into static storage or on the heap, not on the stack.
template <class Limits = DefaultLimits>
class Accumulator : private CheckedLimits<Limits> {
 public:
  static constexpr Capacities kCapacities{Limits::kMaxImageWidth, Limits::kMaxImageHeight, Limits::kMaxPrimitives2d,
                                          Limits::kMaxPrimitives3d, Limits::kMaxStereoMatches};

  // Precondition: is_available(set). Results of two sets differ in the last digits (but not in the preset
  // deterministic).
  explicit Accumulator(InstructionSet set = InstructionSet::kBest)
      : pipeline_(construct_pipeline(storage_, kCapacities, set)) {}
  Accumulator(const Accumulator&) = delete;
  Accumulator& operator=(const Accumulator&) = delete;

  // Sets rig and parameters and empties the model. Status: kInvalidArgument (rig, params: see their validate),
  // kCapacityExceeded (an image larger than Limits, unless these are 0 x 0). On failure the accumulator is unchanged.
  Status configure(const StereoRig& rig, const Params& params = {}) {
    return accrete::configure(*pipeline_, rig, params);
  }

  // Empties the model; rig and parameters stay.
  void reset() { accrete::reset(*pipeline_); }

  // The whole state between two steps, as a file that a later run takes up (saved_model.h). `to` must have
  // saved_bytes() bytes, which depend on how much the model holds. Status: kUnavailable (not configured),
  // kCapacityExceeded (`to` is too small).
  [[nodiscard]] std::size_t saved_bytes() const { return accrete::saved_bytes(*pipeline_); }
  Status save(std::span<std::byte> to) const { return accrete::save(*pipeline_, to); }

  // Goes on from a saved state: the same frames give the same bits as if nothing had been between. Rig and parameters
  // are those of configure(), which comes first. On failure nothing has changed; the report says why. Bytes from
  // anywhere may be given: what is no possible state is refused.
  RestoreReport restore(std::span<const std::byte> from, RestoredClock clock = RestoredClock::kGoesOn) {
    return accrete::restore(*pipeline_, from, clock);
  }

  // One frame. Status in the report: kUnavailable (not configured), kInvalidArgument (image size or view unlike the
  // rig, invalid motion, a time that runs backwards: the left image's must be after the previous one, the right image's
  // and the motion's not before): then nothing has changed.
  StepReport step(const StereoFrame& frame, const Motion& motion) { return accrete::step(*pipeline_, frame, motion); }

  // The same without images: everything but extraction. Elements outside the domain of the camera model are counted in
  // refused_distortion. Status: as above; kInvalidArgument also where a value is not finite, a position lies outside
  // the image or a deviation outside 1e-6 .. 1e6; kCapacityExceeded (more 2D-primitives than Limits).
  StepReport step(const ObservedFrame& frame, const Motion& motion) { return accrete::step(*pipeline_, frame, motion); }

  [[nodiscard]] ModelView model() const { return accrete::model(*pipeline_); }
  // Of the latest frame, valid until the next step.
  [[nodiscard]] std::span<const Primitive2d> left_primitives() const { return accrete::left_primitives(*pipeline_); }
  [[nodiscard]] std::span<const Primitive2d> right_primitives() const { return accrete::right_primitives(*pipeline_); }
  [[nodiscard]] std::span<const StereoMatch> stereo_matches() const { return accrete::stereo_matches(*pipeline_); }

  // Called at the beginning and at the end of every stage of a step; {} for none.
  void set_observer(StageObserver observer) { accrete::set_observer(*pipeline_, observer); }

  // Lends a step a second thread; {}: none, as at the beginning. Must outlive the steps that use it.
  void set_pair_runner(PairRunner runner) { accrete::set_pair_runner(*pipeline_, runner); }

 private:
  alignas(64) std::byte storage_[storage_bytes(kCapacities)];
  Pipeline* pipeline_;
};

}  // namespace accrete
