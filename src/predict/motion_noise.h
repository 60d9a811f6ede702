// A root of the covariance of a small motion, in the map.
#pragma once

#include "accrete/geometry.h"
#include "accrete/motion.h"

namespace accrete {

// The covariance is the sum of the squares of six independent errors. The k-th moves a point p by
// translation[k] + rotation[k] x (p - centre), and turns everything by rotation[k]. Map frame, m and rad.
struct MotionNoise {
  float translation[6][3] = {};
  float rotation[6][3] = {};
  float centre[3] = {};
};

// `covariance`: translation, then rotation vector, in the frame of the left camera whose pose is T_m_l. It may be
// semi-definite: an error that is zero, or a combination of others, contributes nothing.
[[nodiscard]] MotionNoise motion_noise_in_map(const Transform<Map, Left>& T_m_l, const PoseCovariance& covariance);

}  // namespace accrete
