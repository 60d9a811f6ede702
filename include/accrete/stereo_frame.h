// What a stereo source delivers: two images of one moment.
#pragma once

#include <cstdint>

#include "accrete/image.h"
#include "accrete/timestamp.h"

namespace accrete {

struct StereoFrame {
  ImageView left;
  ImageView right;
  Timestamp t_left;
  Timestamp t_right;
  std::uint64_t sequence = 0;  // of the source; gaps are dropped frames
};

}  // namespace accrete
