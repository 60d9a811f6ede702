// Where the given motion comes from.
#pragma once

#include <cstdint>

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
  // The same, but a source whose poses are still to come waits at most `wait_ns` for them. The others never wait.
  virtual Outcome at_within(std::int64_t /*wait_ns*/, Timestamp t, Motion& motion) { return at(t, motion); }

 protected:
  MotionSource() = default;
};

}  // namespace accrete::hal
