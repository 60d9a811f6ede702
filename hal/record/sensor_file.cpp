#include "record/sensor_file.h"

#include <algorithm>
#include <charconv>

namespace accrete::hal {
namespace {

std::string exact(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value);
  return {text, end.ptr};
}

// As many as the model needs: others read four.
std::string coefficients(const Camera& camera) {
  std::size_t n = 4;
  if (camera.distortion == Distortion::kBrownConrady)
    for (const std::size_t more : {5U, 8U, 12U})
      if (std::any_of(camera.coefficients.begin() + static_cast<std::ptrdiff_t>(n), camera.coefficients.end(),
                      [](double k) { return k != 0; }))
        n = more;
  std::string out;
  for (std::size_t i = 0; i < n; ++i)
    out += (i > 0 ? ", " : "") + exact(camera.distortion == Distortion::kNone ? 0 : camera.coefficients[i]);
  return out;
}

// What the motion says in the files' convention: T_left_object, or T_world_left.
void pose_of(const Motion& motion, Quaternion& q, Vec3& t) {
  if (motion.mode == MotionMode::kObjectMoves) {
    q = motion.T_l_m.rotation;
    t = motion.T_l_m.translation;
  } else {
    const Transform<Map, Left> T_m_l = motion.T_l_m.inverse();
    q = T_m_l.rotation;
    t = T_m_l.translation;
  }
}

}  // namespace

std::string camera_yaml(const Camera& camera, const Quaternion& R_b_s, const Vec3& t_b_s, double rate_hz) {
  const Mat3 R = to_matrix(R_b_s);
  std::string text =
      "# Written by accrete record. T_BS maps the camera's coordinates to the body's: the left camera's.\n";
  text += "sensor_type: camera\ncomment: recorded by accrete\nT_BS:\n  cols: 4\n  rows: 4\n  data: [";
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) text += exact(R[3 * i + j]) + ", ";
    text += exact(t_b_s[i]) + ",\n         ";
  }
  text += "0, 0, 0, 1]\n";
  if (rate_hz > 0) text += "rate_hz: " + exact(rate_hz) + "\n";
  text += "resolution: [" + std::to_string(camera.width_px) + ", " + std::to_string(camera.height_px) + "]\n";
  text += "camera_model: pinhole\nintrinsics: [" + exact(camera.fx_px) + ", " + exact(camera.fy_px) + ", " +
          exact(camera.cx_px) + ", " + exact(camera.cy_px) + "]\n";
  text += std::string("distortion_model: ") +
          (camera.distortion == Distortion::kKannalaBrandt ? "equidistant" : "radial-tangential") + "\n";
  text += "distortion_coefficients: [" + coefficients(camera) + "]\n";
  return text;
}

std::string poses_yaml(const Motion& motion) {
  const bool object = motion.mode == MotionMode::kObjectMoves;
  return std::string("# Written by accrete record.\nsensor_type: pose\ncomment: ") +
         (object ? "T_left_object, the cameras stand" : "T_world_left, the body is the left camera") +
         "\npose_error: " + (motion.error == PoseError::kAbsolute ? "absolute" : "incremental") + "\n";
}

std::string pose_header(const Motion& motion) {
  const std::string frame = motion.mode == MotionMode::kObjectMoves ? "LO_L" : "RS_R";
  std::string text = "#timestamp [ns]";
  for (const char* axis : {"x", "y", "z"}) text += ", p_" + frame + "_" + axis + " [m]";
  for (const char* part : {"w", "x", "y", "z"}) text += ", q_" + frame.substr(0, 2) + "_" + part + " []";
  if (!motion.covariance_is_default) text += ", then the covariance's upper triangle: position [m], rotation [rad]";
  return text + "\n";
}

std::string pose_row(Timestamp t, const Motion& motion) {
  Quaternion q;
  Vec3 p{};
  pose_of(motion, q, p);
  std::string text = std::to_string(t.ns);
  for (const double v : {p[0], p[1], p[2], q.w, q.x, q.y, q.z}) text += "," + exact(v);
  if (!motion.covariance_is_default)
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t j = i; j < 6; ++j) text += "," + exact(motion.covariance[6 * i + j]);
  return text + "\n";
}

}  // namespace accrete::hal
