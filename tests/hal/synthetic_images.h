// What the tests of the synthetic scene look at pictures with: frames copied out, light measured along a line.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "accrete/hal/synthetic.h"

namespace accrete::hal {

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;

  [[nodiscard]] std::uint8_t at(int x, int y, int c) const {
    return rgb[(static_cast<std::size_t>(y) * width + x) * 3 + c];
  }
};

struct Shot {
  Picture left, right;
  Timestamp t;
  Motion motion;
};

struct Film {
  StereoRig rig;
  std::vector<Shot> shots;
  Truth truth;
};

inline Picture copy(const ImageView& view) {
  Picture p{view.width_px, view.height_px, {}};
  for (int y = 0; y < view.height_px; ++y) p.rgb.insert(p.rgb.end(), view.row(y), view.row(y) + 3 * view.width_px);
  return p;
}

// Every `step`-th frame of a scene with its truth. Throws what the source says when it fails.
inline Film shoot(const std::string& name, const SyntheticOptions& options, int step = 1) {
  const auto must = [](const Outcome& o) {
    if (!o.ok()) throw std::runtime_error(o.message);
  };
  std::unique_ptr<StereoSource> stereo;
  std::unique_ptr<MotionSource> motion;
  must(open_synthetic(name, options, stereo, motion));
  must(stereo->configure());
  must(stereo->start());
  Film film;
  film.rig = stereo->rig();
  must(synthetic_truth(name, options, film.truth));
  StereoFrame frame;
  for (int i = 0; stereo->acquire(0, frame).ok(); ++i) {
    if (i % step == 0) {
      film.shots.push_back({copy(frame.left), copy(frame.right), frame.t_left, {}});
      must(motion->at(frame.t_left, film.shots.back().motion));
    }
    stereo->release();
  }
  return film;
}

inline double linear_light(double level) {  // inverse of sRGB, from grey levels
  const double e = level / 255;
  return e <= 0.04045 ? e / 12.92 : std::pow((e + 0.055) / 1.055, 2.4);
}

struct Eye {
  const Picture& picture;
  const Camera& camera;
  Transform<Right, Left> T_c_l;  // identity for the left one

  [[nodiscard]] Pixel project(const Vec3& p_l) const {
    const Vec3 p = T_c_l * p_l;
    return {camera.fx_px * p[0] / p[2] + camera.cx_px, camera.fy_px * p[1] / p[2] + camera.cy_px};
  }
  // Linear light of channel c, bilinear.
  [[nodiscard]] double light(double x, double y, int c) const {
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    const double a = x - x0, b = y - y0;
    const auto v = [&](int dx, int dy) { return linear_light(picture.at(x0 + dx, y0 + dy, c)); };
    return (1 - b) * ((1 - a) * v(0, 0) + a * v(1, 0)) + b * ((1 - a) * v(0, 1) + a * v(1, 1));
  }
  [[nodiscard]] bool inside(Pixel p, double margin) const {
    return p.x >= margin && p.y >= margin && p.x <= camera.width_px - 1 - margin &&
           p.y <= camera.height_px - 1 - margin;
  }
};

inline std::array<Eye, 2> eyes(const Film& film, const Shot& shot) {
  return {Eye{shot.left, film.rig.left, {}}, Eye{shot.right, film.rig.right, film.rig.T_r_l}};
}

struct Step {
  bool clean = true;                      // both sides are even: no other edge lies within reach
  double offset_px = 0;                   // of the step from where it should be, positive towards the right-hand side
  double length_px = 0;                   // of the projected segment
  std::array<double, 3> left{}, right{};  // sRGB 0..1 as found at +-kReach
};
// px: blur of 0.5 px, the pixel's own width and that of the bilinear sampling have ended, wholly and nearly.
inline constexpr double kReach = 2.5, kNear = 1.7;

// The step of light across the middle of a projected segment; nothing when it lies too near to the border.
inline std::optional<Step> measure(const Eye& eye, const Vec3& p0_l, const Vec3& p1_l) {
  const Pixel a = eye.project(p0_l), b = eye.project(p1_l), m = eye.project(0.5 * (p0_l + p1_l));
  if (!eye.inside(m, kReach + 2)) return std::nullopt;
  Step step;
  step.length_px = std::hypot(b.x - a.x, b.y - a.y);
  // The right of somebody who walks from a to b on a screen with y down.
  const Pixel nu{-(b.y - a.y) / step.length_px, (b.x - a.x) / step.length_px};
  std::array<double, 3> left{}, right{};
  double strongest = 0;
  for (int c = 0; c < 3; ++c) {
    left[c] = eye.light(m.x - kReach * nu.x, m.y - kReach * nu.y, c);
    right[c] = eye.light(m.x + kReach * nu.x, m.y + kReach * nu.y, c);
    const auto encode = [](double v) { return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055; };
    step.left[c] = encode(left[c]);
    step.right[c] = encode(right[c]);
    const double contrast = std::abs(left[c] - right[c]);
    if (contrast <= strongest) continue;
    strongest = contrast;
    const double near_left = eye.light(m.x - kNear * nu.x, m.y - kNear * nu.y, c),
                 near_right = eye.light(m.x + kNear * nu.x, m.y + kNear * nu.y, c);
    step.clean = std::abs(near_left - left[c]) < 0.05 * contrast && std::abs(near_right - right[c]) < 0.05 * contrast;
    // A step's place from the area under it: blind to any symmetric blur, bilinear sampling included.
    constexpr double kStep = 0.05;
    double area = 0;
    for (double s = -kReach + kStep / 2; s < kReach; s += kStep)
      area += kStep * (eye.light(m.x + s * nu.x, m.y + s * nu.y, c) - right[c]) / (left[c] - right[c]);
    step.offset_px = area - kReach;
  }
  return step;
}

}  // namespace accrete::hal
