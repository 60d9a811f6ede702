// The words of the interface, wherever there is V4L2 or not.
#include "accrete/hal/v4l2.h"

namespace accrete::hal {

const char* to_string(V4l2Layout layout) {
  switch (layout) {
    case V4l2Layout::kTwoDevices:
      return "two";
    case V4l2Layout::kSideBySide:
      return "sbs";
    case V4l2Layout::kSideBySideSwapped:
      return "sbs-swap";
    case V4l2Layout::kTopBottom:
      return "tb";
    case V4l2Layout::kInterleaved:
      return "y8i";
  }
  return "unknown";
}

const char* to_string(V4l2State state) {
  switch (state) {
    case V4l2State::kStopped:
      return "stopped";
    case V4l2State::kWarmingUp:
      return "warming up";
    case V4l2State::kStreaming:
      return "streaming";
    case V4l2State::kReconnecting:
      return "reconnecting";
    case V4l2State::kLost:
      return "lost";
  }
  return "unknown";
}

const char* to_string(V4l2Clock clock) {
  switch (clock) {
    case V4l2Clock::kUnknown:
      return "unknown";
    case V4l2Clock::kStartOfExposure:
      return "start of exposure";
    case V4l2Clock::kEndOfFrame:
      return "end of frame";
    case V4l2Clock::kArrival:
      return "arrival";
  }
  return "unknown";
}

}  // namespace accrete::hal
