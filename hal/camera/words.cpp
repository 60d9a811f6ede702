// The words of the interface.
#include "accrete/hal/live_source.h"

namespace accrete::hal {

const char* to_string(StereoLayout layout) {
  switch (layout) {
    case StereoLayout::kTwoDevices:
      return "two";
    case StereoLayout::kSideBySide:
      return "sbs";
    case StereoLayout::kSideBySideSwapped:
      return "sbs-swap";
    case StereoLayout::kTopBottom:
      return "tb";
    case StereoLayout::kInterleaved:
      return "y8i";
  }
  return "unknown";
}

const char* to_string(LiveState state) {
  switch (state) {
    case LiveState::kStopped:
      return "stopped";
    case LiveState::kWarmingUp:
      return "warming up";
    case LiveState::kStreaming:
      return "streaming";
    case LiveState::kReconnecting:
      return "reconnecting";
    case LiveState::kLost:
      return "lost";
  }
  return "unknown";
}

const char* to_string(LiveClock clock) {
  switch (clock) {
    case LiveClock::kUnknown:
      return "unknown";
    case LiveClock::kStartOfExposure:
      return "start of exposure";
    case LiveClock::kEndOfFrame:
      return "end of frame";
    case LiveClock::kArrival:
      return "arrival";
  }
  return "unknown";
}

}  // namespace accrete::hal
