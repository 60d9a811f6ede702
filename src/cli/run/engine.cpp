#include "cli/run/engine.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/failure.h"

namespace accrete::cli {
namespace {

template <class Limits, Capacity kWhich>
class EngineOf final : public Engine {
 public:
  explicit EngineOf(InstructionSet set) : accumulator_(set) {}
  Status configure(const StereoRig& rig, const Params& params) override { return accumulator_.configure(rig, params); }
  void reset() override { accumulator_.reset(); }
  StepReport step(const StereoFrame& frame, const Motion& motion) override { return accumulator_.step(frame, motion); }
  [[nodiscard]] std::size_t saved_bytes() const override { return accumulator_.saved_bytes(); }
  Status save(std::span<std::byte> to) const override { return accumulator_.save(to); }
  RestoreReport restore(std::span<const std::byte> from, RestoredClock clock) override {
    return accumulator_.restore(from, clock);
  }
  [[nodiscard]] ModelView model() const override { return accumulator_.model(); }
  [[nodiscard]] std::span<const Primitive2d> left_primitives() const override { return accumulator_.left_primitives(); }
  [[nodiscard]] std::span<const Primitive2d> right_primitives() const override {
    return accumulator_.right_primitives();
  }
  [[nodiscard]] std::span<const StereoMatch> stereo_matches() const override { return accumulator_.stereo_matches(); }
  void set_observer(StageObserver observer) override { accumulator_.set_observer(observer); }
  void set_pair_runner(PairRunner runner) override { accumulator_.set_pair_runner(runner); }
  [[nodiscard]] Capacity capacity() const override { return kWhich; }
  [[nodiscard]] std::size_t bytes() const override { return sizeof accumulator_; }
  [[nodiscard]] std::size_t max_primitives() const override { return Limits::kMaxPrimitives3d; }

 private:
  Accumulator<Limits> accumulator_;
};

template <class Limits>
bool fits(int width_px, int height_px) {
  return width_px <= static_cast<int>(Limits::kMaxImageWidth) && height_px <= static_cast<int>(Limits::kMaxImageHeight);
}

std::unique_ptr<Engine> make_unconfigured(int width_px, int height_px, Capacity capacity, InstructionSet set) {
  if (capacity == Capacity::kAuto)
    capacity = fits<DefaultLimits>(width_px, height_px) ? Capacity::kDefault : Capacity::kLarge;
  const auto refuse = [=](ExitStatus status, std::size_t width, std::size_t height, const char* advice) {
    throw Failure(status, fmt::format("the images have {} x {} pixels, capacity {} holds {} x {}: {}", width_px,
                                      height_px, to_string(capacity), width, height, advice));
  };
  switch (capacity) {
    case Capacity::kSmall:
      if (!fits<SmallLimits>(width_px, height_px))
        refuse(ExitStatus::kUsage, SmallLimits::kMaxImageWidth, SmallLimits::kMaxImageHeight, "choose --capacity auto");
      return std::make_unique<EngineOf<SmallLimits, Capacity::kSmall>>(set);
    case Capacity::kDefault:
      if (!fits<DefaultLimits>(width_px, height_px))
        refuse(ExitStatus::kUsage, DefaultLimits::kMaxImageWidth, DefaultLimits::kMaxImageHeight,
               "choose --capacity auto");
      return std::make_unique<EngineOf<DefaultLimits, Capacity::kDefault>>(set);
    default:
      if (!fits<LargeLimits>(width_px, height_px))
        refuse(ExitStatus::kInput, LargeLimits::kMaxImageWidth, LargeLimits::kMaxImageHeight,
               "make the images smaller");
      return std::make_unique<EngineOf<LargeLimits, Capacity::kLarge>>(set);
  }
}

}  // namespace

std::unique_ptr<Engine> make_engine(const StereoRig& rig, const Params& params, Capacity capacity, InstructionSet set) {
  if (validate(rig) != Status::kOk)
    throw Failure(
        ExitStatus::kInput,
        "the calibration cannot be right: a focal length that is not positive, a baseline of zero, or a right "
        "camera that is not on the right (left and right swapped, or the extrinsics inverted)");
  auto engine = make_unconfigured(std::max(rig.left.width_px, rig.right.width_px),
                                  std::max(rig.left.height_px, rig.right.height_px), capacity, set);
  if (const Status status = engine->configure(rig, params); status != Status::kOk)
    throw Failure(ExitStatus::kInput, fmt::format("the accumulator refuses rig or parameters: {}", to_string(status)));
  return engine;
}

}  // namespace accrete::cli
