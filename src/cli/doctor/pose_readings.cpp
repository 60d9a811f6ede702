#include "cli/doctor/pose_readings.h"

#include <fmt/format.h>

namespace accrete::cli {
namespace {

using Pose = Transform<Left, Map>;

Pose inverse_of(const Pose& p) { return retag<Left, Map>(p.inverse()); }

Pose scaled(Pose p, double s) {
  p.translation = s * p.translation;
  return p;
}

// A change of every pose.
template <class Change>
PoseReading each(Change change) {
  return [change](const Sample& a, const Sample& b) -> std::optional<PoseStep> {
    if (!a.motion || !b.motion) return std::nullopt;
    return PoseStep{change(a.motion->T_l_m), change(b.motion->T_l_m)};
  };
}

struct Axes {
  const char* name;
  Quaternion left_from_theirs;
};

// Camera axes in use elsewhere, as rotations that bring them to x right, y down, z forward.
constexpr Axes kAxes[] = {
    {"x right, y up, z backward (OpenGL, Blender)", {1, 0, 0, 0}},
    {"x forward, y left, z up (robotics, ROS body)", {0.5, -0.5, 0.5, 0.5}},
    {"x right, y forward, z up", {0.70710678118654752, 0, 0, 0.70710678118654752}},
    {"x left, y up, z forward", {0, 0, 1, 0}},
    {"x left, y down, z backward", {0, 1, 0, 0}},
    {"x down, y right, z backward or the like (images turned by 90 degrees)",
     {0, 0, 0.70710678118654752, 0.70710678118654752}},
    {"turned by 90 degrees the other way", {0, 0, -0.70710678118654752, 0.70710678118654752}},
};

// Quaternions are written x y z w by some and w x y z by others. As read: x y z w.
Quaternion first_is_w(const Quaternion& q) { return {q.y, q.z, q.w, q.x}; }
Quaternion last_is_w(const Quaternion& q) { return {q.w, q.x, q.y, q.z}; }

}  // namespace

std::optional<PoseStep> as_given(const Sample& first, const Sample& second) {
  return each([](const Pose& p) { return p; })(first, second);
}

std::vector<NamedReading> pose_readings(const Patient& patient) {
  const bool object = patient.mode == MotionMode::kObjectMoves;
  const char* other = object ? "--pose-dir object_from_left" : "--pose-dir left_from_world";
  std::vector<NamedReading> list;
  list.push_back({"poses_inverse",
                  object ? "The poses are the wrong way round: they are T_object_left and are read as T_left_object "
                           "(or the cameras move, and not the object)."
                         : "The poses are the wrong way round: they are T_left_world and are read as T_world_left (or "
                           "the object moves, and not the cameras).",
                  fmt::format("Say {} (or --motion {}); or invert every pose in the file. The other direction: {}.",
                              other, object ? "camera" : "object", object ? "left_from_object" : "world_from_left"),
                  each(inverse_of)});
  list.push_back({"poses_late", "The poses are a frame late: that of a frame is in the line after it.",
                  "Shift the times of the poses back by one frame.",
                  [](const Sample& a, const Sample& b) -> std::optional<PoseStep> {
                    if (!b.motion || !b.motion_after) return std::nullopt;
                    return PoseStep{a.motion_after ? a.motion_after->T_l_m : b.motion->T_l_m, b.motion_after->T_l_m};
                  }});
  list.push_back({"poses_early", "The poses are a frame early: that of a frame is in the line before it.",
                  "Shift the times of the poses forward by one frame.",
                  [](const Sample& a, const Sample& b) -> std::optional<PoseStep> {
                    if (!a.motion_before || !a.motion) return std::nullopt;
                    return PoseStep{a.motion_before->T_l_m, b.motion_before ? b.motion_before->T_l_m : a.motion->T_l_m};
                  }});
  for (const double s : {1e-3, 1e3, 1e-2, 1e2})
    list.push_back(
        {s < 1 ? "poses_millimetres" : "poses_scale",
         s == 1e-3   ? "The poses are in millimetres and are read as metres."
         : s == 1e-2 ? "The poses are in centimetres and are read as metres."
                     : fmt::format("The translations of the poses are {:g} times too small for this baseline.", s),
         s < 1 ? fmt::format("Multiply the translations in the file of poses by {:g}.", s)
               : fmt::format("Multiply the translations in the file of poses by {:g}, or divide T of the calibration "
                             "by it: one of them has another unit.",
                             s),
         each([s](const Pose& p) { return scaled(p, s); })});
  const auto& T_r_l = patient.rig.T_r_l;
  list.push_back({"poses_of_right_eye", "The poses are those of the right camera.", "Say --pose-frame right.",
                  each([T_r_l](const Pose& p) { return retag<Left, Map>(T_r_l.inverse() * retag<Right, Map>(p)); })});
  // In the file stands T_left_object or T_world_left: the quaternion is that of the inverse where the cameras move.
  for (const bool w_first : {true, false})
    list.push_back({"poses_quaternion",
                    w_first ? "The quaternions of the poses have w first, and are read as x y z w."
                            : "The quaternions of the poses have w last, and are read as w x y z.",
                    "Write the numbers in the order that docs/reference/recordings.md gives for this kind of file.",
                    each([object, w_first](const Pose& p) {
                      Pose file = object ? p : inverse_of(p);
                      file.rotation = w_first ? first_is_w(file.rotation) : last_is_w(file.rotation);
                      return object ? file : inverse_of(file);
                    })});
  for (const Axes& axes : kAxes)
    for (const bool inverse : {false, true})
      list.push_back({"poses_axes",
                      fmt::format("The poses have other camera axes: {} instead of x right, y down, z forward{}.",
                                  axes.name, inverse ? "; and they are the wrong way round" : ""),
                      inverse ? fmt::format("Turn the poses into x right, y down, z forward, and say {}.", other)
                              : "Turn the poses into x right, y down, z forward.",
                      each([q = axes.left_from_theirs, inverse](const Pose& p) {
                        const Pose right_way = inverse ? inverse_of(p) : p;
                        return Pose{q * right_way.rotation, to_matrix(q) * right_way.translation};
                      })});
  return list;
}

}  // namespace accrete::cli
