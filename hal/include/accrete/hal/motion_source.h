// Where the given motion comes from.
#pragma once

#include "accrete/hal/stereo_source.h"
#include "accrete/motion.h"

namespace accrete::hal {

class MotionSource {
 public:
  virtual ~MotionSource() = default;
  MotionSource(const MotionSource&) = delete;
  MotionSource& operator=(const MotionSource&) = delete;

  // The motion at the time of a frame. kNotFound when no pose lies near enough in time: the frame cannot be used, and
  // whoever asks counts it.
  virtual Outcome at(Timestamp t, Motion& motion) = 0;

 protected:
  MotionSource() = default;
};

}  // namespace accrete::hal
