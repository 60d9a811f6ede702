// Edges in space, a verged rig, and the 2D-primitives that its cameras would deliver.
#pragma once

#include <gtest/gtest.h>

#include "base/angles.h"
#include "core/picture.h"
#include "extract/undistort.h"
#include "math/aligned.h"

namespace accrete::test {

// In the left camera's frame; appearance in the sense of the tangent, seen from the cameras.
struct Edge {
  Vec3 p{};
  Vec3 t{1, 0, 0};
  Appearance look;
};

struct Rig {
  StereoRig rig;
  AlignedRig aligned;
  AlignedOptics optics;

  explicit Rig(bool verged = true, int width = 640, int height = 480) {
    rig.left = plain_camera(width, height, 600);
    rig.right = plain_camera(width, height, 620);
    rig.right.cx_px += 7;
    rig.right.cy_px -= 4;
    double angle = 0;
    if (verged) {
      angle = 0.12;  // rad, the right camera looks to the left
      rig.left.distortion = rig.right.distortion = Distortion::kBrownConrady;
      rig.left.coefficients = {-0.15, 0.03, 0.0005, -0.0004};
      rig.right.coefficients = {-0.14, 0.02, -0.0003, 0.0006};
    }
    // The right camera stands at (0.12, 0.004, 0.002) in the left one's frame.
    rig.T_r_l.rotation = {0, std::sin(angle / 2), 0, std::cos(angle / 2)};
    rig.T_r_l.translation = -1.0 * (to_matrix(rig.T_r_l.rotation) * Vec3{0.12, verged ? 0.004 : 0, verged ? 0.002 : 0});
    EXPECT_EQ(validate(rig), Status::kOk);
    aligned = align(rig);
    optics = {static_cast<float>(aligned.focal_px), static_cast<float>(aligned.baseline_m)};
  }

  // Left camera frame to the aligned left frame.
  [[nodiscard]] AlignedPose pose() const {
    AlignedPose pose;
    for (std::size_t i = 0; i < 9; ++i) pose.R[i] = static_cast<float>(aligned.R_a_l[i]);
    return pose;
  }

  // The primitive of `edge` in one eye, moved along itself by `slide_px`; false outside the image.
  [[nodiscard]] bool see(const Edge& edge, int eye, double slide_px, Primitive2d& out) const {
    const Camera& camera = eye == 0 ? rig.left : rig.right;
    const auto pixel = [&](const Vec3& q) {
      const Vec3 c = eye == 0 ? q : rig.T_r_l * q;
      return project(camera, {c[0] / c[2], c[1] / c[2]});
    };
    constexpr double h = 1e-5;
    const auto a = pixel(edge.p - h * edge.t), b = pixel(edge.p + h * edge.t);
    if (!a.ok() || !b.ok()) return false;
    const double dx = b.value().x - a.value().x, dy = b.value().y - a.value().y, n = std::hypot(dx, dy);
    const auto m = pixel(edge.p + (slide_px * 2 * h / n) * edge.t);
    if (!m.ok()) return false;
    const double x = m.value().x, y = m.value().y;
    if (x < 8 || y < 8 || x > camera.width_px - 9 || y > camera.height_px - 9) return false;
    out = {};
    out.x_px = static_cast<float>(x);
    out.y_px = static_cast<float>(y);
    double theta = std::atan2(dy, dx);
    out.appearance = edge.look;
    if (theta < 0 || theta >= double{kPi}) {  // extraction's range: the other description
      theta += theta < 0 ? double{kPi} : -double{kPi};
      out.appearance = reversed(edge.look);
    }
    out.theta = static_cast<float>(theta);
    out.amplitude = 30;
    out.confidence_i1d = 0.9F;
    out.confidence_i0d = out.confidence_i2d = 0.05F;
    out.sigma_n_px = 0.2F;
    out.sigma_theta = 0.02F;
    out.sigma_phase = 0.25F;
    out.sigma_colour = 0.02F;
    return extract::undistort(camera, eye == 0 ? aligned.R_a_l : aligned.R_a_r, aligned.focal_px, out);
  }
};

inline Appearance random_look(Dice& dice) {
  Appearance a;
  a.phase = static_cast<float>(dice.uniform(-3.1, 3.1));
  for (auto* side : {&a.left, &a.right})
    for (float& c : *side) c = static_cast<float>(dice.uniform());
  return a;
}
inline Vec3 unit(const Vec3& v) { return (1 / norm(v)) * v; }

// In front of both cameras, 0.5 to 1.2 m away, tangent in any direction but along the rays.
inline Edge random_edge(Dice& dice) {
  const double z = dice.uniform(0.5, 1.2);
  Edge e;
  e.p = {dice.uniform(-0.35, 0.45) * z, dice.uniform(-0.33, 0.33) * z, z};
  const double angle = dice.uniform(0, 2 * double{kPi});
  e.t = unit({std::cos(angle), std::sin(angle), dice.uniform(-0.5, 0.5)});
  e.look = random_look(dice);
  return e;
}

}  // namespace accrete::test
