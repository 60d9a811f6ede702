// Does one eye look later than the other? Seen in the images, whatever the stamps say. docs/math/rig_checks.md
#pragma once

#include "cli/doctor/diagnosis.h"

namespace accrete::cli {

// How the rows of moving points follow their vertical motion: 0 when the eyes look at the same time, +1 when the right
// eye is a frame late, -1 when the left one is.
struct Lag {
  std::size_t points = 0;
  double frames = 0;
  double gain = 1;           // cost of the best lag over that of none
  double row_motion_px = 0;  // median of the vertical motion of the points that were used

  [[nodiscard]] bool clear() const;
};
[[nodiscard]] Lag lag_of(const Patient& patient);

}  // namespace accrete::cli
