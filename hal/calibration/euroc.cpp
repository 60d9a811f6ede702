// EuRoC / ASL: one sensor.yaml a camera; T_BS maps the camera's coordinates to the body's.
#include <algorithm>

#include "calibration/calibration.h"
#include "calibration/yaml_file.h"
#include "text/sentence.h"

namespace accrete::hal {
namespace {

Outcome required(const YamlFile& file, const char* key, std::size_t n, std::vector<double>& values) {
  const YamlEntry* entry = file.find({key});
  if (entry == nullptr)
    return {Status::kNotFound, file.path().string() + " has no " + key + ": is it the sensor.yaml of a camera?"};
  if (Outcome o = file.numbers(*entry, values); !o.ok()) return o;
  if (values.size() != n)
    return {Status::kInvalidArgument,
            file.where(*entry) + " has " + count(values.size(), "value") + " instead of " + std::to_string(n)};
  return {};
}

Outcome read_pose(const YamlFile& file, Quaternion& rotation, Vec3& translation) {
  std::vector<double> m;
  if (Outcome o = required(file, "T_BS", 16, m); !o.ok()) return o;
  const std::string where = file.where(*file.find({"T_BS"}));
  if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
    return {Status::kInvalidArgument, where + " has a last row other than 0 0 0 1: write it row after row"};
  translation = {m[3], m[7], m[11]};
  return check_rotation({m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]}, where, rotation);
}

Outcome read_camera(const YamlFile& file, Camera& camera) {
  std::vector<double> values;
  if (const YamlEntry* model = file.find({"camera_model"}); model != nullptr)
    if (model->values.size() != 1 || model->values[0] != "pinhole")
      return {Status::kUnsupported, file.where(*model) + " must be 'pinhole': calibrate with that model"};
  if (Outcome o = required(file, "intrinsics", 4, values); !o.ok()) return o;
  camera = {};
  camera.fx_px = values[0];
  camera.fy_px = values[1];
  camera.cx_px = values[2];
  camera.cy_px = values[3];
  if (file.find({"resolution"}) != nullptr) {
    if (Outcome o = required(file, "resolution", 2, values); !o.ok()) return o;
    if (!(values[0] >= 1 && values[0] <= 1e6 && values[1] >= 1 && values[1] <= 1e6))
      return {Status::kInvalidArgument, file.where(*file.find({"resolution"})) + " is no image size: correct it"};
    camera.width_px = static_cast<int>(values[0]);
    camera.height_px = static_cast<int>(values[1]);
  }
  const YamlEntry* model = file.find({"distortion_model"});
  const YamlEntry* coefficients = file.find({"distortion_coefficients", "distortion_coeffs"});
  if (model == nullptr || model->values.size() != 1)
    return {Status::kNotFound,
            file.path().string() + " has no distortion_model: add radial-tangential, equidistant or none"};
  values.clear();
  if (coefficients != nullptr)
    if (Outcome o = file.numbers(*coefficients, values); !o.ok()) return o;
  return set_distortion(model->values[0], values, file.where(coefficients != nullptr ? *coefficients : *model), camera);
}

}  // namespace

Outcome read_euroc_pair(const std::filesystem::path& left, const std::filesystem::path& right,
                        Calibration& calibration) {
  calibration = {};
  Transform<Body, Left> T_b_l;
  Transform<Body, Right> T_b_r;
  YamlFile file;
  if (Outcome o = file.load(left); !o.ok()) return o;
  if (Outcome o = read_camera(file, calibration.rig.left); !o.ok()) return o;
  if (Outcome o = read_pose(file, T_b_l.rotation, T_b_l.translation); !o.ok()) return o;
  if (Outcome o = file.load(right); !o.ok()) return o;
  if (Outcome o = read_camera(file, calibration.rig.right); !o.ok()) return o;
  if (Outcome o = read_pose(file, T_b_r.rotation, T_b_r.translation); !o.ok()) return o;
  calibration.rig.T_r_l = T_b_r.inverse() * T_b_l;
  calibration.T_l_b = T_b_l.inverse();
  calibration.knows_body = true;
  calibration.source = left.string() + ", " + right.string();
  calibration.convention = "EuRoC: T_BS maps camera to body, T_r_l = T_BS1^-1 T_BS0, metres, not rectified";
  calibration.complete = true;
  return check_rig(calibration.rig, calibration.source);
}

}  // namespace accrete::hal
