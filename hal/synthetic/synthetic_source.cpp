#include <algorithm>
#include <string>
#include <vector>

#include "synthetic/recording.h"

namespace accrete::hal {
namespace synthetic {
namespace {

class SyntheticStereo final : public StereoSource {
 public:
  explicit SyntheticStereo(Recording recording) : recording_(std::move(recording)) {}

  [[nodiscard]] std::uint64_t size() const override { return static_cast<std::uint64_t>(recording_.options().frames); }

 private:
  Outcome do_configure() override {
    rig_ = recording_.rig();
    return {};
  }
  Outcome do_start() override {
    next_ = 0;
    return {};
  }
  Outcome do_acquire(std::int64_t /*timeout_ns*/, StereoFrame& frame) override {
    if (next_ >= recording_.options().frames) return {Status::kEndOfStream, "the synthetic recording has ended"};
    frame.left = picture(recording_.left_view(next_), NoiseStream::kLeftImage, left_);
    frame.right = picture(recording_.right_view(next_), NoiseStream::kRightImage, right_);
    frame.t_left = frame.t_right = {next_ * kPeriodNs};
    frame.sequence = static_cast<std::uint64_t>(next_++);
    return {};
  }

  ImageView picture(const View& view, NoiseStream stream, std::vector<std::uint8_t>& pixels) {
    const SyntheticOptions& options = recording_.options();
    const int width = recording_.rig().left.width_px, height = recording_.rig().left.height_px;
    pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
    canvas_.clear();
    view.draw(canvas_);
    const std::uint64_t noise_seed =
        mix(options.seed) ^ ((static_cast<std::uint64_t>(stream) << 32) + static_cast<unsigned>(next_));
    canvas_.develop(options.noise_levels, noise_seed, pixels.data());
    return {pixels.data(), width, height, static_cast<std::ptrdiff_t>(width) * 3, PixelFormat::kRgb8};
  }

  Recording recording_;
  Canvas canvas_{recording_.rig().left.width_px, recording_.rig().left.height_px};
  std::vector<std::uint8_t> left_, right_;
  int next_ = 0;
};

class SyntheticMotion final : public MotionSource {
 public:
  explicit SyntheticMotion(Recording recording) : recording_(std::move(recording)) {}

  Outcome at(Timestamp t, Motion& motion) override {
    constexpr std::int64_t kTolerance = 1'000'000;  // ns: poses belong to frames, nothing is interpolated
    const std::int64_t nearest = t.ns < 0 ? 0 : t.ns / kPeriodNs + (t.ns % kPeriodNs > kPeriodNs / 2 ? 1 : 0);
    const std::int64_t frame = std::min<std::int64_t>(nearest, recording_.options().frames - 1);
    const std::int64_t away = t.ns - frame * kPeriodNs;
    if (away > kTolerance || away < -kTolerance)
      return {Status::kNotFound, "synthetic motion: no pose within 1 ms of " + std::to_string(t.ns) +
                                     " ns; it has one for each of its own frames"};
    motion = recording_.reported_motion(static_cast<int>(frame));
    return {};
  }

 private:
  Recording recording_;
};

}  // namespace
}  // namespace synthetic

Outcome open_synthetic(std::string_view name, const SyntheticOptions& options, std::unique_ptr<StereoSource>& stereo,
                       std::unique_ptr<MotionSource>& motion) {
  synthetic::Recording recording;
  if (Outcome outcome = synthetic::Recording::make(name, options, recording); !outcome.ok()) return outcome;
  stereo = std::make_unique<synthetic::SyntheticStereo>(recording);
  motion = std::make_unique<synthetic::SyntheticMotion>(std::move(recording));
  return {};
}

Outcome synthetic_truth(std::string_view name, const SyntheticOptions& options, Truth& truth) {
  synthetic::Recording recording;
  if (Outcome outcome = synthetic::Recording::make(name, options, recording); !outcome.ok()) return outcome;
  truth = recording.truth();
  return {};
}

}  // namespace accrete::hal
