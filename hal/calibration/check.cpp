#include <algorithm>
#include <cmath>

#include "calibration/calibration.h"
#include "text/sentence.h"

namespace accrete::hal {
namespace {

Outcome check_camera(const Camera& camera, const std::string& which) {
  if (camera.fx_px > 0 && camera.fy_px > 0) return {};
  return {Status::kInvalidArgument, which + " has the focal lengths " + number(camera.fx_px) + " and " +
                                        number(camera.fy_px) + " px; both must be positive: calibrate again"};
}

double deviation_from_rotation(const Mat3& m) {
  const Mat3 g = m * transposed(m);
  double worst = 0;
  for (int i = 0; i < 9; ++i) worst = std::max(worst, std::abs(g[i] - (i % 4 == 0 ? 1.0 : 0.0)));
  return worst;
}

}  // namespace

Outcome check_rotation(const Mat3& m, const std::string& where, Quaternion& rotation) {
  const auto q = to_quaternion(m);
  if (q.ok()) {
    rotation = q.value();
    return {};
  }
  const double worst = deviation_from_rotation(m);
  const std::string why =
      worst > 1e-3 ? "R Rt differs from the identity by " + number(worst, 3) : "its determinant is -1: it mirrors";
  return {Status::kInvalidArgument,
          where + " is no rotation (" + why + "): check the order of its values, or calibrate again"};
}

Outcome check_rig(const StereoRig& rig, const std::string& source) {
  if (Outcome o = check_camera(rig.left, source + ": the left camera"); !o.ok()) return o;
  if (Outcome o = check_camera(rig.right, source + ": the right camera"); !o.ok()) return o;
  const double b = rig.baseline_m();
  if (!std::isfinite(b) || b < 1e-6)
    return {Status::kInvalidArgument, source + ": the baseline is " + number(b) +
                                          " m, so no depth can be measured: check the translation (T, P1 or T_BS)"};
  const Vec3 c = rig.T_r_l.inverse().translation;  // the right camera, seen from the left one
  if (c[0] < 0 && -c[0] >= std::max(std::abs(c[1]), std::abs(c[2])))
    return {
        Status::kInvalidArgument,
        source + ": the baseline is negative: the right camera lies " + number(-c[0]) +
            " m to the LEFT of the left one. Swap the eyes, or invert R and T: x_right = R x_left + T needs T[0] < 0"};
  Camera left = rig.left, right = rig.right;
  for (Camera* camera : {&left, &right})
    if (camera->width_px == 0) camera->width_px = camera->height_px = 1;
  if (validate(StereoRig{left, right, rig.T_r_l}) != Status::kOk)
    return {Status::kInvalidArgument,
            source + ": no rig that works: the right camera lies at (" + number(c[0]) + ", " + number(c[1]) + ", " +
                number(c[2]) +
                ") m, seen from the left one (x right, y down, z forward). It must lie to the right "
                "and look the same way: check R and T, and which camera is which"};
  return {};
}

}  // namespace accrete::hal
