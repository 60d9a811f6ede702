// Capacities, fixed at compile time: an Accumulator<Limits> owns every byte that it will ever use. Write a struct with
// the same members for other sizes. docs/memory.md tabulates what each profile costs.
#pragma once

#include <cstddef>

namespace accrete {

struct DefaultLimits {  // 1280 x 720
  static constexpr std::size_t kMaxImageWidth = 1280;
  static constexpr std::size_t kMaxImageHeight = 720;
  static constexpr std::size_t kMaxPrimitives2d = 8192;    // per image
  static constexpr std::size_t kMaxPrimitives3d = 16384;   // in the store
  static constexpr std::size_t kMaxStereoMatches = 16384;  // hypotheses per frame, rivals included
};

struct SmallLimits {  // 640 x 480
  static constexpr std::size_t kMaxImageWidth = 640;
  static constexpr std::size_t kMaxImageHeight = 480;
  static constexpr std::size_t kMaxPrimitives2d = 2048;
  static constexpr std::size_t kMaxPrimitives3d = 4096;
  static constexpr std::size_t kMaxStereoMatches = 4096;
};

struct LargeLimits {  // 1920 x 1200
  static constexpr std::size_t kMaxImageWidth = 1920;
  static constexpr std::size_t kMaxImageHeight = 1200;
  static constexpr std::size_t kMaxPrimitives2d = 16384;
  static constexpr std::size_t kMaxPrimitives3d = 65536;
  static constexpr std::size_t kMaxStereoMatches = 32768;
};

// The same, when it is known at run time.
struct Capacities {
  std::size_t image_width = 0, image_height = 0, primitives2d = 0, primitives3d = 0, stereo_matches = 0;

  friend bool operator==(const Capacities&, const Capacities&) = default;
};

// Contradictory limits do not compile, and the sentence says which. Instantiated by Accumulator<Limits>.
template <class Limits>
struct CheckedLimits {
  // 0 x 0: no images at all, only frames of 2D-primitives (observed_frame.h).
  static_assert((Limits::kMaxImageWidth >= 32 && Limits::kMaxImageHeight >= 32) ||
                    (Limits::kMaxImageWidth == 0 && Limits::kMaxImageHeight == 0),
                "Limits: an image needs at least 32 x 32 pixels, the band-pass kernel is 9 wide");
  static_assert(Limits::kMaxImageWidth <= 8192 && Limits::kMaxImageHeight <= 8192,
                "Limits: an image may have at most 8192 x 8192 pixels, positions are stored as float");
  static_assert(Limits::kMaxPrimitives2d >= 16 && Limits::kMaxPrimitives2d <= 65535,
                "Limits: kMaxPrimitives2d must lie in 16 .. 65535, observations are indexed by 16 bits");
  static_assert(Limits::kMaxPrimitives3d >= 16 && Limits::kMaxPrimitives3d % 16 == 0,
                "Limits: kMaxPrimitives3d must be a positive multiple of 16, the store is made of blocks of 16");
  static_assert(Limits::kMaxPrimitives3d <= (std::size_t{1} << 24),
                "Limits: kMaxPrimitives3d may be at most 2^24, the store is indexed by 32 bits with room for flags");
  static_assert(Limits::kMaxStereoMatches >= Limits::kMaxPrimitives2d,
                "Limits: kMaxStereoMatches must be at least kMaxPrimitives2d, every 2D-primitive may have a match");
};

}  // namespace accrete
