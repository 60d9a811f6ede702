// What poses mean where that differs from our own convention.
#pragma once

#include "accrete/motion.h"
#include "motion/pose_table.h"

namespace accrete::hal {

// From T_frame_object or T_world_frame (`inverse`: the other way round) to T_left_object or T_world_left; `T_l_f` is
// where the frame is, seen from the left camera.
void to_canonical(StampedPose& pose, MotionMode mode, bool inverse, const Transform<Left, Body>& T_l_f);

}  // namespace accrete::hal
