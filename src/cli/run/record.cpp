#include "cli/run/record.h"

#include <algorithm>

namespace accrete::cli {

const char* to_string(FrameFate fate) {
  switch (fate) {
    case FrameFate::kUsed:
      return "used";
    case FrameFate::kUnreadable:
      return "unreadable";
    case FrameFate::kNoPose:
      return "without_pose";
    case FrameFate::kRefused:
      return "refused";
    case FrameFate::kHeldOut:
      return "held_out";
  }
  return "unknown";
}

std::size_t RunRecord::count(FrameFate fate) const {
  return static_cast<std::size_t>(
      std::count_if(frames.begin(), frames.end(), [fate](const FrameRecord& f) { return f.fate == fate; }));
}

}  // namespace accrete::cli
