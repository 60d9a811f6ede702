// The functions behind Accumulator<Limits>, and the cutting of its memory.
#include <new>

#include "accrete/contract.h"
#include "accumulator/pipeline.h"

namespace accrete {

Status validate(const Capacities& c) {
  const bool none = c.image_width == 0 && c.image_height == 0;
  const bool images =
      none || (c.image_width >= 32 && c.image_height >= 32 && c.image_width <= 8192 && c.image_height <= 8192);
  const bool store = c.primitives3d >= 16 && c.primitives3d % 16 == 0 && c.primitives3d <= (std::size_t{1} << 24);
  return images && store && c.primitives2d >= 16 && c.primitives2d <= 65535 && c.stereo_matches >= c.primitives2d
             ? Status::kOk
             : Status::kInvalidArgument;
}

Pipeline* construct_pipeline(std::span<std::byte> memory, const Capacities& wanted, InstructionSet set) {
  const Capacities capacities = validate(wanted) == Status::kOk ? wanted : Capacities{};
  constexpr std::size_t kHead = (sizeof(Pipeline) + 63) / 64 * 64;
  Workspace counted;
  ACCRETE_EXPECTS(kHead + cut(nullptr, capacities, counted) <= memory.size());
  auto* pipeline = new (memory.data()) Pipeline(capacities, kernels(set));  // in place: nothing is allocated
  cut(memory.data() + kHead, capacities, pipeline->workspace());
  pipeline->bind_store();
  return pipeline;
}

Status configure(Pipeline& pipeline, const StereoRig& rig, const Params& params) {
  return pipeline.configure(rig, params);
}
void reset(Pipeline& pipeline) { pipeline.reset(); }
StepReport step(Pipeline& pipeline, const StereoFrame& frame, const Motion& motion) {
  return pipeline.step(frame, motion);
}
StepReport step(Pipeline& pipeline, const ObservedFrame& frame, const Motion& motion) {
  return pipeline.step(frame, motion);
}
std::size_t saved_bytes(const Pipeline& pipeline) { return pipeline.saved_bytes(); }
Status save(const Pipeline& pipeline, std::span<std::byte> to) { return pipeline.save(to); }
RestoreReport restore(Pipeline& pipeline, std::span<const std::byte> from, RestoredClock clock) {
  return pipeline.restore(from, clock);
}
ModelView model(const Pipeline& pipeline) { return pipeline.model(); }
std::span<const Primitive2d> left_primitives(const Pipeline& pipeline) { return pipeline.primitives(0); }
std::span<const Primitive2d> right_primitives(const Pipeline& pipeline) { return pipeline.primitives(1); }
std::span<const StereoMatch> stereo_matches(const Pipeline& pipeline) { return pipeline.matches(); }
void set_observer(Pipeline& pipeline, StageObserver observer) { pipeline.set_observer(observer); }
void set_pair_runner(Pipeline& pipeline, PairRunner runner) { pipeline.set_pair_runner(runner); }

}  // namespace accrete
