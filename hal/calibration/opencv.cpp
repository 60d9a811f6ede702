// OpenCV's stereo calibration: M1 D1 M2 D2 of the raw cameras, x_right = R x_left + T. The rectified R1 R2 P1 P2 Q that
// usually stand beside them are not used: images are never rectified.
#include <algorithm>
#include <cmath>
#include <optional>

#include "calibration/calibration.h"
#include "calibration/yaml_file.h"
#include "text/sentence.h"

namespace accrete::hal {
namespace {

using Names = std::initializer_list<std::string_view>;

struct Found {
  const YamlFile* file = nullptr;
  const YamlEntry* entry = nullptr;
  [[nodiscard]] std::string where() const { return file->where(*entry); }
};

struct Files {
  std::vector<YamlFile> files;

  [[nodiscard]] std::optional<Found> find(Names names) const {
    for (const YamlFile& file : files)
      if (const YamlEntry* entry = file.find(names); entry != nullptr) return Found{&file, entry};
    return std::nullopt;
  }
  [[nodiscard]] std::string text() const {
    std::string text;
    for (const YamlFile& file : files) text += (text.empty() ? "" : ", ") + file.path().string();
    return text;
  }
};

Outcome missing(const Files& files, Names names) {
  if (files.find({"cam0"}))
    return {Status::kUnsupported, files.text() +
                                      " looks like a Kalibr camchain, which is not understood: write M1 D1 M2 "
                                      "D2 R T as OpenCV does (docs/reference/recordings.md)"};
  return {Status::kNotFound, files.text() + " has no " + std::string(*names.begin()) +
                                 ": an OpenCV stereo calibration needs M1 D1 M2 D2 R T"};
}

// Exactly `n` values under the first of `names`.
Outcome values_of(const Files& files, Names names, std::size_t n, std::vector<double>& values, std::string& where) {
  const auto found = files.find(names);
  if (!found) return missing(files, names);
  where = found->where();
  if (Outcome o = found->file->numbers(*found->entry, values); !o.ok()) return o;
  if (values.size() != n)
    return {Status::kInvalidArgument, where + " has " + count(values.size(), "value") + " instead of " +
                                          std::to_string(n) + ": write the matrix row after row"};
  return {};
}

Outcome read_camera(const Files& files, Names m_names, Names d_names, const std::string& model, Camera& camera,
                    std::size_t& coefficient_count) {
  std::vector<double> m;
  std::string where;
  if (Outcome o = values_of(files, m_names, 9, m, where); !o.ok()) return o;
  if (m[3] != 0 || m[6] != 0 || m[7] != 0 || m[8] != 1)
    return {Status::kInvalidArgument, where + " is no camera matrix (fx 0 cx / 0 fy cy / 0 0 1): check its order"};
  if (std::abs(m[1]) > 1e-9 * std::abs(m[0]))
    return {Status::kUnsupported, where + " has a skew of " + number(m[1]) + " px: calibrate without skew"};
  camera.fx_px = m[0];
  camera.fy_px = m[4];
  camera.cx_px = m[2];
  camera.cy_px = m[5];
  const auto d = files.find(d_names);
  if (!d) {
    Outcome o = missing(files, d_names);
    if (o.status == Status::kNotFound) o.message += " (zeros where the images are free of distortion)";
    return o;
  }
  std::vector<double> k;
  if (Outcome o = d->file->numbers(*d->entry, k); !o.ok()) return o;
  coefficient_count = k.size();
  return set_distortion(model, k, d->where(), camera);
}

// `fisheye: 1` or the name of a model; empty when the file has neither.
std::string model_of(const Files& files) {
  if (const auto f = files.find({"fisheye"}); f && f->entry->values.size() == 1) {
    const std::string& v = f->entry->values[0];
    if (v == "1" || v == "true" || v == "True" || v == "yes") return "fisheye";
  }
  const auto m = files.find({"model", "distortion_model", "camera_model"});
  return m && m->entry->values.size() == 1 ? m->entry->values[0] : "";
}

Outcome read_size(const Files& files, StereoRig& rig, std::vector<std::string>& guesses) {
  std::vector<double> w, h;
  std::string where, where_w;
  if (files.find({"image_size", "imageSize", "img_size"})) {
    if (Outcome o = values_of(files, {"image_size", "imageSize", "img_size"}, 2, w, where); !o.ok()) return o;
    where_w = where;
    h = {w[1]};
  } else if (files.find({"image_width", "width", "imageWidth"})) {
    if (Outcome o = values_of(files, {"image_width", "width", "imageWidth"}, 1, w, where); !o.ok()) return o;
    where_w = where;
    if (Outcome o = values_of(files, {"image_height", "height", "imageHeight"}, 1, h, where); !o.ok()) return o;
  } else {
    guesses.push_back(files.text() + " states no image size: taken from the images (add image_width, image_height)");
    return {};
  }
  const auto is_size = [](double v) { return v >= 1 && v <= 1e6 && v == std::floor(v); };
  if (!is_size(w[0]))
    return {Status::kInvalidArgument, where_w + ": " + number(w[0]) + " is no image size: correct it"};
  if (!is_size(h[0])) return {Status::kInvalidArgument, where + ": " + number(h[0]) + " is no image size: correct it"};
  rig.left.width_px = rig.right.width_px = static_cast<int>(w[0]);
  rig.left.height_px = rig.right.height_px = static_cast<int>(h[0]);
  return {};
}

Outcome metres_of(const Files& files, double length, double& scale, std::vector<std::string>& guesses) {
  scale = 1;
  const auto found = files.find({"units", "unit"});
  if (!found) {
    // A stereo rig of more than 5 m is rare, one calibrated in the millimetres of its board is not.
    if (length > 5)
      return {Status::kInvalidArgument,
              files.text() + ": T has the length " + number(length) +
                  " and there is no unit. "
                  "Add 'units: mm' if it is in millimetres, 'units: m' if it really is metres"};
    guesses.push_back(files.text() + " states no unit: metres are assumed (add units: m, cm or mm)");
    return {};
  }
  const std::string unit = found->entry->values.size() == 1 ? found->entry->values[0] : "";
  const auto is = [&](std::initializer_list<const char*> names) {
    return std::any_of(names.begin(), names.end(), [&](const char* n) { return unit == n; });
  };
  if (is({"m", "metre", "metres", "meter", "meters"})) return {};
  if (is({"mm", "millimetre", "millimetres", "millimeter", "millimeters"})) {
    scale = 1e-3;
    return {};
  }
  if (is({"cm", "centimetre", "centimetres", "centimeter", "centimeters"})) {
    scale = 1e-2;
    return {};
  }
  return {Status::kUnsupported, found->where() + " " + in_quotes(unit) + " is not understood: write m, cm or mm"};
}

// `unit`: whether the length of T can be in the unit that is stated.
Outcome read_extrinsics(const Files& files, Calibration& calibration, Outcome& unit) {
  std::vector<double> r, t;
  std::string where;
  if (Outcome o = values_of(files, {"R"}, 9, r, where); !o.ok()) return o;
  Mat3 m{};
  std::copy(r.begin(), r.end(), m.begin());
  if (Outcome o = check_rotation(m, where, calibration.rig.T_r_l.rotation); !o.ok()) return o;
  if (Outcome o = values_of(files, {"T", "t"}, 3, t, where); !o.ok()) return o;
  double scale = 1;
  unit = metres_of(files, norm({t[0], t[1], t[2]}), scale, calibration.guesses);
  if (unit.status == Status::kUnsupported) return unit;
  calibration.rig.T_r_l.translation = scale * Vec3{t[0], t[1], t[2]};
  return {};
}

}  // namespace

Outcome read_opencv_stereo(std::span<const std::filesystem::path> paths, Calibration& calibration) {
  calibration = {};
  Files files;
  for (const auto& path : paths) {
    files.files.emplace_back();
    if (Outcome o = files.files.back().load(path); !o.ok()) return o;
  }
  StereoRig& rig = calibration.rig;
  const std::string model = model_of(files);
  std::size_t n1 = 0, n2 = 0;
  if (Outcome o =
          read_camera(files, {"M1", "K1", "cameraMatrix1", "camera_matrix_1", "camera_matrix1", "camera_matrix_left"},
                      {"D1", "distCoeffs1", "dist_coeffs_1", "dist_coeffs1", "dist_1", "dist1",
                       "distortion_coefficients_1", "distortion_coefficients_left"},
                      model, rig.left, n1);
      !o.ok())
    return o;
  if (Outcome o =
          read_camera(files, {"M2", "K2", "cameraMatrix2", "camera_matrix_2", "camera_matrix2", "camera_matrix_right"},
                      {"D2", "distCoeffs2", "dist_coeffs_2", "dist_coeffs2", "dist_2", "dist2",
                       "distortion_coefficients_2", "distortion_coefficients_right"},
                      model, rig.right, n2);
      !o.ok())
    return o;
  if (Outcome o = read_size(files, rig, calibration.guesses); !o.ok()) return o;
  Outcome unit;
  if (Outcome o = read_extrinsics(files, calibration, unit); !o.ok()) return o;
  const bool distorted = rig.left.distortion != Distortion::kNone || rig.right.distortion != Distortion::kNone;
  if (model.empty() && distorted && (n1 == 4 || n2 == 4))
    calibration.guesses.push_back(files.text() +
                                  " has 4 coefficients and names no model: read as k1 k2 p1 p2 of "
                                  "Brown-Conrady (add model: fisheye if they are a fisheye's)");
  calibration.source = files.text();
  calibration.convention = "OpenCV stereo: x_right = R x_left + T, raw images, R1 R2 P1 P2 Q not used";
  calibration.complete = true;
  if (!unit.ok()) return unit;
  return check_rig(rig, calibration.source);
}

}  // namespace accrete::hal
