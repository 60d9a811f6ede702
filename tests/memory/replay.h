// A whole synthetic recording through an accumulator, for tests that watch the core from outside.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "accrete/accumulator.h"
#include "accrete/hal/synthetic.h"

namespace accrete::test {

// Calls step(rig, frame, motion) for every frame.
template <class Step>
void replay(const char* scene, int frames, Step&& step) {
  std::unique_ptr<hal::StereoSource> stereo;
  std::unique_ptr<hal::MotionSource> motion;
  hal::SyntheticOptions options;
  options.frames = frames;
  ASSERT_TRUE(hal::open_synthetic(scene, options, stereo, motion).ok());
  ASSERT_TRUE(stereo->configure().ok());
  ASSERT_TRUE(stereo->start().ok());
  StereoFrame frame;
  Motion given;
  int seen = 0;
  for (; stereo->acquire(0, frame).ok(); ++seen) {
    ASSERT_TRUE(motion->at(frame.t_left, given).ok());
    step(stereo->rig(), frame, given);
    stereo->release();
  }
  ASSERT_EQ(seen, frames);
}

// Too small for what the scenes show: budgets, refusals and evictions all happen.
struct TightLimits {
  static constexpr std::size_t kMaxImageWidth = 640;
  static constexpr std::size_t kMaxImageHeight = 480;
  static constexpr std::size_t kMaxPrimitives2d = 256;
  static constexpr std::size_t kMaxPrimitives3d = 128;
  static constexpr std::size_t kMaxStereoMatches = 256;
};

}  // namespace accrete::test
