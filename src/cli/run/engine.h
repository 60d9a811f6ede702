// One Accumulator behind an interface that does not depend on its capacity, chosen when the image size is known.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "accrete/accumulator.h"
#include "cli/run/options.h"

namespace accrete::cli {

class Engine {
 public:
  virtual ~Engine() = default;
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  virtual Status configure(const StereoRig& rig, const Params& params) = 0;
  virtual void reset() = 0;
  virtual StepReport step(const StereoFrame& frame, const Motion& motion) = 0;
  [[nodiscard]] virtual std::size_t saved_bytes() const = 0;
  virtual Status save(std::span<std::byte> to) const = 0;
  virtual RestoreReport restore(std::span<const std::byte> from, RestoredClock clock) = 0;
  [[nodiscard]] virtual ModelView model() const = 0;
  [[nodiscard]] virtual std::span<const Primitive2d> left_primitives() const = 0;
  [[nodiscard]] virtual std::span<const Primitive2d> right_primitives() const = 0;
  [[nodiscard]] virtual std::span<const StereoMatch> stereo_matches() const = 0;
  virtual void set_observer(StageObserver observer) = 0;
  virtual void set_pair_runner(PairRunner runner) = 0;
  [[nodiscard]] virtual Capacity capacity() const = 0;
  [[nodiscard]] virtual std::size_t bytes() const = 0;
  [[nodiscard]] virtual std::size_t max_primitives() const = 0;

 protected:
  Engine() = default;
};

// An engine for the rig, configured. Throws Failure(kInput): a rig that cannot be right, images larger than the largest
// profile; Failure(kUsage): images larger than the profile that was asked for. Precondition: is_available(set).
[[nodiscard]] std::unique_ptr<Engine> make_engine(const StereoRig& rig, const Params& params, Capacity capacity,
                                                  InstructionSet set = InstructionSet::kBest);

}  // namespace accrete::cli
