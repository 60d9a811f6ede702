// The members that a saved model consists of, named once.
#pragma once

#include "accrete/timestamp.h"
#include "accumulator/archive.h"
#include "existence/track.h"

namespace accrete {

// What is neither a primitive nor an image.
struct SavedHead {
  std::uint32_t frame = 0;
  bool has_last = false;
  float typical_misfit = 1;
  Timestamp last_left, last_right, last_motion;
  std::array<std::array<float, 3>, 2> last_centres{};
  std::uint32_t width_px[2] = {0, 0}, height_px[2] = {0, 0};  // previous images, 0: none
  std::uint32_t free_count = 0;
};

template <class Archive>
void fields(Archive& a, SavedHead& h) {
  members(a, h.frame, h.has_last, h.typical_misfit, h.last_left.ns, h.last_right.ns, h.last_motion.ns, h.last_centres,
          h.width_px[0], h.height_px[0], h.width_px[1], h.height_px[1], h.free_count);
}

template <class Archive>
void fields(Archive& a, View& v) {
  members(a, v.x_l, v.y_l, v.c_l, v.s_l, v.x_r, v.y_r, v.c_r, v.s_r);
}
template <class Archive>
void fields(Archive& a, HiddenSides& h) {
  members(a, h.left, h.right);
}
template <class Archive>
void fields(Archive& a, SeenDirections& s) {
  members(a, s.hits, s.visits);
}
template <class Archive>
void fields(Archive& a, Reliability& r) {
  members(a, r.excess);
}
template <class Archive>
void fields(Archive& a, Appearance& p) {
  members(a, p.phase, p.left, p.right);
}
template <class Archive>
void fields(Archive& a, Geometry& g) {
  members(a, g.position, g.quaternion, g.covariance);
}
template <class Archive>
void fields(Archive& a, AppearanceState& s) {
  members(a, s.mean, s.covariance);
}

// One primitive. Its generation is written for every slot, used or not, and not here.
struct SavedPrimitive {
  Track track;
  Geometry geometry;
  AppearanceState appearance;
};

template <class Archive>
void fields(Archive& a, SavedPrimitive& p) {
  Track& t = p.track;
  members(a, t.state, t.log_odds, t.motion_log_odds, t.visible, t.observations, t.novel_matches, t.misses_in_row,
          t.first_frame, t.last_frame, t.misfit, t.pitch_m, t.birth, t.counted, t.used, t.viewer, t.hidden, t.seen,
          t.reliability, p.geometry, p.appearance);
}

}  // namespace accrete
