// How large the golden replay is. The short form is for tests and for emulated microcontrollers.
#pragma once

#include "accrete/limits.h"

namespace accrete::determinism {

// No images. Too few places for all the edges and what clutter gives birth to: some are evicted.
struct LongForm {
  static constexpr int kEdges = 1200, kSteps = 2000;
  static constexpr std::size_t kMaxImageWidth = 0, kMaxImageHeight = 0;
  static constexpr std::size_t kMaxPrimitives2d = 1024;
  static constexpr std::size_t kMaxPrimitives3d = 1040;
  static constexpr std::size_t kMaxStereoMatches = 2048;
};
struct ShortForm {
  static constexpr int kEdges = 150, kSteps = 120;
  static constexpr std::size_t kMaxImageWidth = 0, kMaxImageHeight = 0;
  static constexpr std::size_t kMaxPrimitives2d = 128;
  static constexpr std::size_t kMaxPrimitives3d = 48;
  static constexpr std::size_t kMaxStereoMatches = 256;
};

}  // namespace accrete::determinism
