// The small text files of a EuRoC folder: what a camera is, and rows of poses.
#pragma once

#include <string>

#include "accrete/camera.h"
#include "accrete/motion.h"

namespace accrete::hal {

// The sensor.yaml of a camera; the body is the left camera. `rate_hz` 0: not known (yet).
[[nodiscard]] std::string camera_yaml(const Camera& camera, const Quaternion& R_b_s, const Vec3& t_b_s, double rate_hz);
// The sensor.yaml beside the poses.
[[nodiscard]] std::string poses_yaml(const Motion& motion);
// The header of poses like this one, and one row: 8 columns, or 29 where a covariance is stated. Numbers are the
// shortest that give the same double again.
[[nodiscard]] std::string pose_header(const Motion& motion);
[[nodiscard]] std::string pose_row(Timestamp t, const Motion& motion);

}  // namespace accrete::hal
