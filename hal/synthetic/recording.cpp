#include "synthetic/recording.h"

#include <array>
#include <cmath>
#include <string>

namespace accrete::hal::synthetic {
namespace {

constexpr double kRadians = 3.14159265358979323846 / 180;
constexpr double kArcDegrees = 40;                   // of the room, in all
constexpr double kMaxArcDegrees = 50;                // further out the wall no longer fills the picture
constexpr double kBarStart = -0.03, kBarEnd = 0.15;  // m: passes before the object, first in the left picture
// The axis of the turn is tilted, and the box stands askew on it: then each of its six faces is seen.
constexpr Vec3 kAxis{0.1, 0.96, -0.22};

constexpr std::array<SyntheticScene, 6> kScenes{{
    {"box", "a painted box in a gripper, turned before wall and table behind a passing bar"},
    {"box-plain", "the box alone before wall and table"},
    {"box-gripper", "the box in the gripper, without the bar"},
    {"box-occluded", "the box behind the passing bar, without the gripper"},
    {"box-shimmer", "the box alone, the colours of one face change with the viewing angle"},
    {"room", "nothing moves but the cameras; the right one is turned and has another focal length"},
}};

Quaternion rotation(const Vec3& vector) {  // of a rotation vector, rad
  const double angle = norm(vector);
  const double s = angle < 1e-9 ? 0.5 : std::sin(0.5 * angle) / angle;
  return {s * vector[0], s * vector[1], s * vector[2], std::cos(0.5 * angle)};
}

Quaternion unit(const Quaternion& q) {  // products drift by a rounding or two
  const double s = 1 / std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  return {s * q.x, s * q.y, s * q.z, s * q.w};
}

Camera pinhole(double f, double cx, double cy) {
  Camera camera;
  camera.width_px = 640;
  camera.height_px = 480;
  camera.fx_px = camera.fy_px = f;
  camera.cx_px = cx;
  camera.cy_px = cy;
  return camera;
}

StereoRig ideal_rig() {
  StereoRig rig;
  rig.left = rig.right = pinhole(800, 321.3, 238.6);  // off centre: a mistake of half a picture would show
  rig.T_r_l.translation = {-0.12, 0, 0};
  return rig;
}

StereoRig askew_rig() {
  StereoRig rig = ideal_rig();
  rig.right = pinhole(790, 316.2, 243.1);
  rig.T_r_l.rotation = rotation({0.012, 0.07, -0.008});  // looks inwards, a little up, rolled
  rig.T_r_l.translation = to_matrix(rig.T_r_l.rotation) * Vec3{-0.12, 0.001, -0.002};
  return rig;
}

Outcome invalid(std::string message) { return {Status::kInvalidArgument, std::move(message)}; }

// False for NaN too.
bool within(double value, double low, double high) { return value >= low && value <= high; }

Outcome check(std::string_view name, const SyntheticOptions& o) {
  const bool room = name == "room";
  if (!within(o.frames, 1, 100000))
    return invalid("synthetic scene: " + std::to_string(o.frames) + " frames asked for; give 1 .. 100000");
  if (!within(o.noise_levels, 0, 64)) return invalid("synthetic scene: image noise must lie in 0 .. 64 grey levels");
  if (!within(o.pose_noise_m, 0, 0.1) || !within(o.pose_noise_rad, 0, 0.1))
    return invalid("synthetic scene: pose noise must lie in 0 .. 0.1 m and 0 .. 0.1 rad");
  if ((o.pose_noise_m > 0) != (o.pose_noise_rad > 0))
    return invalid("synthetic scene: pose noise of position and rotation must both be zero or both above it");
  if (!within(o.degrees_per_frame, -360, 360))
    return invalid("synthetic scene: degrees a frame must lie in -360 .. 360");
  if (room && std::abs(o.degrees_per_frame) * (o.frames - 1) > kMaxArcDegrees)
    return invalid("synthetic:room: an arc of " + std::to_string(std::abs(o.degrees_per_frame) * (o.frames - 1)) +
                   " degrees leaves the scene; give at most 50 / (frames - 1) degrees a frame");
  if (room && (o.gripper.value_or(false) || o.occluder.value_or(false)))
    return invalid("synthetic:room has neither gripper nor occluder; take synthetic:box for these");
  return {};
}

}  // namespace

Outcome Recording::make(std::string_view name, const SyntheticOptions& options, Recording& out) {
  std::string known;
  bool found = false;
  for (const SyntheticScene& scene : kScenes) {
    found = found || name == scene.name;
    known += std::string(known.empty() ? "" : ", ") + scene.name;
  }
  if (!found) return {Status::kNotFound, "no synthetic scene '" + std::string(name) + "'; there are " + known};
  if (Outcome outcome = check(name, options); !outcome.ok()) return outcome;

  out.options_ = options;
  const bool room = name == "room";
  out.mode_ = room ? MotionMode::kCameraMoves : MotionMode::kObjectMoves;
  out.rig_ = room ? askew_rig() : ideal_rig();
  if (options.degrees_per_frame == 0)
    out.options_.degrees_per_frame = room ? kArcDegrees / std::max(1, options.frames - 1) : 360.0 / options.frames;
  const bool all = name == "box";
  out.scene_ = make_scene(options.seed, options.gripper.value_or(all || name == "box-gripper"),
                          options.occluder.value_or(all || name == "box-occluded"), name == "box-shimmer");
  return {};
}

Stage Recording::stage(int frame) const {
  static const Quaternion askew = rotation({0.62, 0, 0}) * rotation({0, 0.3, 0}) * rotation({0, 0, 0.5});
  const Vec3 axis = (1 / norm(kAxis)) * kAxis;
  Stage s;
  if (mode_ == MotionMode::kCameraMoves) {
    // Round the vertical through the object's centre; the middle of the arc is the world's frame.
    const double angle = (frame - 0.5 * (options_.frames - 1)) * options_.degrees_per_frame * kRadians;
    const Vec3 pivot{kObjectPosition[0], 0, kObjectPosition[2]};
    const Quaternion turn = rotation({0, angle, 0});
    s.T_l_scene = Transform<World, Left>{turn, pivot - to_matrix(turn) * pivot}.inverse();
    s.T_l_object = s.T_l_scene * Transform<World, Object>{unit(askew), kObjectPosition};
    s.T_l_bar = s.T_l_scene;
    return s;
  }
  const double angle = frame * options_.degrees_per_frame * kRadians;
  s.T_l_object = {unit(rotation(angle * axis) * askew), kObjectPosition};
  const double progress = options_.frames > 1 ? static_cast<double>(frame) / (options_.frames - 1) : 0.5;
  s.T_l_bar.translation = {kBarStart + progress * (kBarEnd - kBarStart), 0, 0};
  return s;
}

View Recording::left_view(int frame) const { return {scene_, stage(frame), rig_.left, {}}; }

View Recording::right_view(int frame) const { return {scene_, stage(frame), rig_.right, rig_.T_r_l}; }

Motion Recording::reported_motion(int frame) const {
  static const NormalTable normal;
  const Stage s = stage(frame);
  Motion motion;
  motion.t = {frame * kPeriodNs};
  motion.mode = mode_;
  motion.error = PoseError::kAbsolute;
  motion.T_l_m = mode_ == MotionMode::kCameraMoves ? retag<Left, Map>(s.T_l_scene) : retag<Left, Map>(s.T_l_object);
  motion.covariance = diagonal_pose_covariance(options_.pose_noise_m, options_.pose_noise_rad);
  Random random(options_.seed, (static_cast<std::uint64_t>(NoiseStream::kPose) << 32) + static_cast<unsigned>(frame));
  Vec3 shift{}, turn{};
  for (double& x : shift) x = options_.pose_noise_m * normal(random.bits());
  for (double& x : turn) x = options_.pose_noise_rad * normal(random.bits());
  motion.T_l_m.translation = motion.T_l_m.translation + shift;
  motion.T_l_m.rotation = unit(rotation(turn) * motion.T_l_m.rotation);
  return motion;
}

}  // namespace accrete::hal::synthetic

namespace accrete::hal {

std::span<const SyntheticScene> synthetic_scenes() { return synthetic::kScenes; }

}  // namespace accrete::hal
