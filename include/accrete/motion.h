// The given motion of one frame: where the map (object or world) is, seen from the left camera.
#pragma once

#include <array>
#include <cstdint>

#include "accrete/geometry.h"
#include "accrete/timestamp.h"

namespace accrete {

enum class MotionMode : std::uint8_t {
  kObjectMoves,  // the cameras stand; Map is the object's frame
  kCameraMoves,  // the scene stands; Map is the world's frame
};

enum class PoseError : std::uint8_t {
  kAbsolute,     // encoders, motion capture: bounded, independent of the past: measurement noise
  kIncremental,  // odometry: the error of each increment adds up: process noise
};

// 6 x 6 row-major: translation (m), then rotation vector (rad), along the left camera's axes. The rotation is about the
// map's origin where the error is absolute (a robot holds the object there), about the camera where it is incremental.
using PoseCovariance = std::array<double, 36>;

[[nodiscard]] constexpr PoseCovariance diagonal_pose_covariance(double sigma_m, double sigma_rad) {  // of every axis
  PoseCovariance c{};
  for (int i = 0; i < 3; ++i) c[7 * i] = sigma_m * sigma_m;
  for (int i = 3; i < 6; ++i) c[7 * i] = sigma_rad * sigma_rad;
  return c;
}

struct Motion {
  Timestamp t;
  MotionMode mode = MotionMode::kObjectMoves;
  PoseError error = PoseError::kAbsolute;
  Transform<Left, Map> T_l_m;
  // Of T_l_m (absolute), or of the increment since the previous frame (incremental). Zero: exactly known.
  PoseCovariance covariance{};
  bool covariance_is_default = false;  // the source had none; said in the report

  [[nodiscard]] static Motion object(Timestamp t, const Transform<Left, Object>& T_l_o) {  // errors do not add up
    Motion m;
    m.t = t;
    m.T_l_m = retag<Left, Map>(T_l_o);
    return m;
  }
  [[nodiscard]] static Motion camera(Timestamp t, const Transform<World, Left>& T_w_l) {  // errors add up
    Motion m;
    m.t = t;
    m.mode = MotionMode::kCameraMoves;
    m.error = PoseError::kIncremental;
    m.T_l_m = retag<Left, Map>(T_w_l.inverse());
    return m;
  }
};

// kInvalidArgument: not finite, the quaternion not of unit length within 1e-6, or a covariance that is neither zero nor
// symmetric and positive definite (the smallest eigenvalue of the correlations above 1e-9). A singular one claims that
// some combination of the errors is exactly zero, which nobody measures: give that direction a small variance instead.
[[nodiscard]] Status validate(const Motion& motion);

}  // namespace accrete
