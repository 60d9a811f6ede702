// Bookkeeping of one 3D-primitive: existence, visibility and history. Geometry and appearance live in their own blocks.
#pragma once

#include <cstdint>

#include "accrete/primitive.h"
#include "filter/reliability.h"
#include "filter/view_change.h"
#include "predict/visibility.h"

namespace accrete {

// What both eyes saw, or should see: enough to say how far a view has moved.
struct View {
  float x_l = 0, y_l = 0, c_l = 1, s_l = 0;
  float x_r = 0, y_r = 0, c_r = 1, s_r = 0;
};

struct Track {
  std::uint32_t generation = 0;
  State state = State::kFree;
  float log_odds = 0;         // of existence
  float motion_log_odds = 0;  // of moving with the given motion, against standing still in the image (METHOD 8)
  float visible = 1;          // probability that it can be seen, carried from frame to frame once confirmed
  std::uint32_t observations = 0, novel_matches = 0, misses_in_row = 0;
  std::uint32_t first_frame = 0, last_frame = 0;
  float misfit = 0;   // running mean of d2 per degree of freedom: 1 for an honest covariance
  float pitch_m = 0;  // length of one sampling pitch on the object
  View birth;         // as observed; what a static edge would still show
  View counted;       // when evidence was last counted
  View used;          // when an observation last corrected the state
  std::array<float, 3>
      viewer{};  // unit, map frame, edge to camera at the last update: how far appearance may have changed
  HiddenSides hidden;
  SeenDirections seen;
  Reliability reliability;
};

}  // namespace accrete
