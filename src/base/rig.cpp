// Two cameras: is the rig sane, and its virtual parallel twin.
#include "accrete/camera.h"

namespace accrete {
namespace {

constexpr double kMinBaseline_m = 1e-6;
// The right camera lies within 60 degrees of the left one's x axis: one above the other is another kind of rig, and a
// sign error or inverted extrinsics give 180 degrees less the true angle.
constexpr double kMinAcross = 0.5;

Vec3 right_centre_in_left(const StereoRig& rig) { return rig.T_r_l.inverse().translation; }
Vec3 right_axis_in_left(const StereoRig& rig) { return to_matrix(conjugate(rig.T_r_l.rotation)) * Vec3{0, 0, 1}; }

}  // namespace

Status validate(const StereoRig& rig) {
  if (validate(rig.left) != Status::kOk || validate(rig.right) != Status::kOk) return Status::kInvalidArgument;
  const Quaternion& q = rig.T_r_l.rotation;
  if (!(std::abs(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w - 1) <= 1e-6)) return Status::kInvalidArgument;
  const double b = rig.baseline_m();
  if (!std::isfinite(b) || b < kMinBaseline_m) return Status::kInvalidArgument;
  if (!(right_centre_in_left(rig)[0] >= kMinAcross * b)) return Status::kInvalidArgument;
  // Eyes that look at right angles share no usable image, and the baseline must be 30 degrees off the viewing
  // direction: otherwise align() has no depth axis.
  const Vec3 view = Vec3{0, 0, 1} + right_axis_in_left(rig);
  if (!(view[2] > 1)) return Status::kInvalidArgument;
  if (!(norm(cross(view, right_centre_in_left(rig))) >= 0.5 * norm(view) * b)) return Status::kInvalidArgument;
  return Status::kOk;
}

AlignedRig align(const StereoRig& rig) {
  const Vec3 c = right_centre_in_left(rig);
  const Vec3 x = (1 / norm(c)) * c;
  Vec3 z = Vec3{0, 0, 1} + right_axis_in_left(rig);
  z = z - dot(z, x) * x;
  z = (1 / norm(z)) * z;
  const Vec3 y = cross(z, x);
  AlignedRig aligned;
  aligned.focal_px = 0.25 * (rig.left.fx_px + rig.left.fy_px + rig.right.fx_px + rig.right.fy_px);
  aligned.baseline_m = norm(c);
  aligned.R_a_l = {x[0], x[1], x[2], y[0], y[1], y[2], z[0], z[1], z[2]};
  aligned.R_a_r = aligned.R_a_l * to_matrix(conjugate(rig.T_r_l.rotation));
  return aligned;
}

}  // namespace accrete
