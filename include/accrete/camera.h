// Camera models. Camera frame: x right, y down, z forward; pixel centres at integers. Images are never rectified: the
// few thousand 2D-primitives are undistorted instead (DESIGN: frames, motion and what is moving).
#pragma once

#include <array>
#include <cstdint>

#include "accrete/geometry.h"

namespace accrete {

enum class Distortion : std::uint8_t {
  kNone,
  kBrownConrady,   // OpenCV order k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4]]]; absent coefficients are zero
  kKannalaBrandt,  // OpenCV fisheye / Kalibr equidistant: k1 k2 k3 k4
};

struct Camera {  // in pixels of the raw image
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0, fy_px = 0, cx_px = 0, cy_px = 0;
  Distortion distortion = Distortion::kNone;
  std::array<double, 12> coefficients{};
};

// A point of the image plane at z = 1.
struct Normalized {
  double x = 0, y = 0;
};
struct Pixel {
  double x = 0, y = 0;
};

// Distorts and scales. The polynomial models fold back far outside the image: kInvalidArgument where the radius lies
// beyond the last one at which the model is monotonic, or where the result is not finite.
[[nodiscard]] Result<Pixel> project(const Camera& camera, Normalized p);
// Inverse of project, by Newton's method in double; kInvalidArgument when it does not converge to 1e-9.
[[nodiscard]] Result<Normalized> unproject(const Camera& camera, Pixel p);
// d(pixel)/d(normalized), row-major 2 x 2, at `p`.
[[nodiscard]] std::array<double, 4> project_jacobian(const Camera& camera, Normalized p);
// kInvalidArgument: not finite, size or focal length not positive.
[[nodiscard]] Status validate(const Camera& camera);

struct StereoRig {
  Camera left;
  Camera right;
  Transform<Right, Left> T_r_l;  // p_r = T_r_l * p_l; OpenCV's R and T

  [[nodiscard]] double baseline_m() const { return norm(T_r_l.translation); }  // between the two centres
};

// kInvalidArgument: an invalid camera, a translation that is not finite or shorter than a micrometre, or a right
// camera that does not lie to the right of the left one, within 60 degrees of its x axis (eyes swapped, extrinsics
// inverted, one above the other), or viewing directions at right angles to each other or within 30 degrees of the
// baseline.
[[nodiscard]] Status validate(const StereoRig& rig);

// The same rig seen from two virtual parallel cameras with one focal length and the principal point at zero: rays
// turned, no pixel touched. Corresponding points have equal y and disparity x_l - x_r = f b / z > 0. Stereo and filter
// work here.
struct AlignedRig {
  double focal_px = 0;
  double baseline_m = 0;
  Mat3 R_a_l{};  // left camera frame to aligned frame
  Mat3 R_a_r{};  // right camera frame to aligned frame
};

// Precondition: validate(rig) is kOk. The common viewing direction is the mean of the two, made normal to the baseline;
// focal_px is the mean of the four focal lengths.
[[nodiscard]] AlignedRig align(const StereoRig& rig);

}  // namespace accrete
