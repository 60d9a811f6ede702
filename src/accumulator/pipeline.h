// The stages joined: one object per Accumulator, living in its memory.
#pragma once

#include "accumulator/workspace.h"
#include "existence/repeated_view.h"
#include "kernels/kernels.h"
#include "math/aligned.h"

namespace accrete {

struct SavedHead;  // saved_state.h

class Pipeline {
 public:
  Pipeline(const Capacities& capacities, const Kernels& kernels) : capacities_(capacities), kernels_(kernels) {}

  Workspace& workspace() { return w_; }
  void bind_store();

  Status configure(const StereoRig& rig, const Params& params);
  void reset();
  StepReport step(const StereoFrame& frame, const Motion& motion);
  StepReport step(const ObservedFrame& frame, const Motion& motion);  // observed.cpp

  // saved_model.cpp
  [[nodiscard]] std::size_t saved_bytes() const;
  Status save(std::span<std::byte> to) const;
  RestoreReport restore(std::span<const std::byte> from, RestoredClock clock);

  [[nodiscard]] ModelView model() const;
  [[nodiscard]] std::span<const Primitive2d> primitives(int eye) const {
    return w_.eye[eye].primitives.first(count_[eye]);
  }
  [[nodiscard]] std::span<const StereoMatch> matches() const { return w_.matches.first(match_count_); }
  void set_observer(StageObserver observer) { observer_ = observer; }
  void set_pair_runner(PairRunner runner) { runner_ = runner; }

 private:
  [[nodiscard]] SavedHead saved_head() const;
  [[nodiscard]] Status check(Timestamp t_left, Timestamp t_right, const Motion& motion) const;
  // From the 2D-primitives on.
  void proceed(Timestamp t_left, Timestamp t_right, const Motion& motion, StepReport& report);
  void extract(const StereoFrame& frame, StepReport& report);
  void extract(const StereoFrame& frame, int eye, StepReport& report);
  void match(StepReport& report);
  void predict(const Motion& motion, StepReport& report);
  void expect(std::size_t live_index, const Motion& motion, StepReport& report);
  void associate();
  void filter(StepReport& report);
  void judge(StepReport& report);
  void renew(StepReport& report);
  [[nodiscard]] associate::EyeView eye_view(int eye) const;

  Capacities capacities_;
  const Kernels& kernels_;
  Workspace w_;
  Store store_;
  StageObserver observer_;
  PairRunner runner_;

  bool configured_ = false;
  StereoRig rig_;
  AlignedRig aligned_;
  AlignedOptics optics_;
  Params params_;

  std::uint32_t frame_ = 0;
  bool has_last_ = false;
  float typical_misfit_ = 1;  // running mean over all used matches of d2 per degree of freedom
  Timestamp last_left_, last_right_, last_motion_;
  existence::EyeCentres last_centres_{};

  // Of the current frame.
  bool has_previous_[2] = {false, false};
  std::size_t count_[2] = {0, 0};
  std::size_t match_count_ = 0, live_count_ = 0, expected_count_ = 0;
  AlignedPose pose_;
  existence::EyeCentres centres_{};
  associate::Grid grid_[2];
  associate::Clutter clutter_[2];
};

}  // namespace accrete
