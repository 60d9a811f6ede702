#include "motion/convention.h"

namespace accrete::hal {

void to_canonical(StampedPose& pose, MotionMode mode, bool inverse, const Transform<Left, Body>& T_l_f) {
  // As it stands: T_frame_object or T_world_frame.
  const Transform<Body, Object> raw{pose.rotation, pose.translation};
  const Transform<Body, Object> T = inverse ? retag<Body, Object>(raw.inverse()) : raw;
  if (mode == MotionMode::kObjectMoves) {
    const auto T_l_o = T_l_f * T;
    pose.rotation = T_l_o.rotation;
    pose.translation = T_l_o.translation;
  } else {
    const auto T_w_l = retag<World, Body>(T) * T_l_f.inverse();
    pose.rotation = T_w_l.rotation;
    pose.translation = T_w_l.translation;
  }
  if (const auto q = normalized(pose.rotation); q.ok()) pose.rotation = q.value();  // rounding only
}

}  // namespace accrete::hal
