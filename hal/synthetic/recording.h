// A scene with its rig and motion: everything about a synthetic recording but its pixels.
#pragma once

#include <cstdint>
#include <string_view>

#include "accrete/hal/synthetic.h"
#include "accrete/motion.h"
#include "synthetic/scene.h"
#include "synthetic/view.h"

namespace accrete::hal::synthetic {

inline constexpr std::int64_t kPeriodNs = 33'333'333;  // 30 Hz

// The streams of noise that hang on the seed.
enum class NoiseStream : std::uint64_t { kLeftImage = 11, kRightImage = 12, kPose = 13 };

class Recording {
 public:
  // Statuses of open_synthetic.
  [[nodiscard]] static Outcome make(std::string_view name, const SyntheticOptions& options, Recording& out);

  [[nodiscard]] const SyntheticOptions& options() const { return options_; }
  [[nodiscard]] const StereoRig& rig() const { return rig_; }
  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] MotionMode mode() const { return mode_; }

  // Precondition of these: 0 <= frame < options().frames.
  [[nodiscard]] Stage stage(int frame) const;
  [[nodiscard]] View left_view(int frame) const;
  [[nodiscard]] View right_view(int frame) const;
  [[nodiscard]] Motion reported_motion(int frame) const;

  [[nodiscard]] Truth truth() const;

 private:
  SyntheticOptions options_;
  MotionMode mode_ = MotionMode::kObjectMoves;
  StereoRig rig_;
  Scene scene_;
};

}  // namespace accrete::hal::synthetic
