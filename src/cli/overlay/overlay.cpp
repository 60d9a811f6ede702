#include "cli/overlay/overlay.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cli/project.h"
#include "cli/score/statistics.h"

namespace accrete::cli {
namespace {

constexpr float kStrokePx = 4.5F;   // image pixels: shorter than the sampling pitch (6), so that neighbours stay apart
constexpr float kSidePx = 2.2F;     // where the colour of a side is shown, about where it was sampled
constexpr int kGapPx = 8;           // between the two images
constexpr int kPanelPx = 1280;      // an image is enlarged by whole factors to about this width
constexpr int kSteps = 40;          // of brightness in the image behind: makes the files half as large
constexpr int kSmallPanelPx = 640;  // the same for the overview, which is shown in pages

int scale_of(const ImageView& image, int panel_px = kPanelPx) {
  return std::clamp(panel_px / std::max(1, image.width_px), 1, 4);
}

Canvas beside(const Canvas& left, const Canvas& right) {
  Canvas both(left.width_px() + kGapPx + right.width_px(), std::max(left.height_px(), right.height_px()));
  both.paste(left, 0, 0);
  both.paste(right, left.width_px() + kGapPx, 0);
  return both;
}

// An image coordinate on a canvas that is `scale` times as large.
float on_canvas(float image_px, int scale) {
  const auto s = static_cast<float>(scale);
  return s * image_px + (s - 1) / 2;
}

void stroke(Canvas& canvas, float x, float y, float direction, float half, float width, Colour colour, float alpha) {
  const float dx = half * std::cos(direction), dy = half * std::sin(direction);
  canvas.line(x - dx, y - dy, x + dx, y + dy, width, colour, alpha);
}

Canvas eye_with_primitives(const ImageView& image, int scale, std::span<const Primitive2d> primitives) {
  const auto s = static_cast<float>(scale);
  Canvas canvas(image, scale, 0.8F, 0.65F, kSteps);
  for (const Primitive2d& p : primitives) {
    const float x = on_canvas(p.x_px, scale), y = on_canvas(p.y_px, scale);
    stroke(canvas, x, y, p.theta, s * kStrokePx / 2, 1.2F * s, {}, 0.55F);
    stroke(canvas, x, y, p.theta, s * kStrokePx / 2, 0.8F * s, hue(p.theta / std::numbers::pi_v<float>), 1);
    const float nx = -std::sin(p.theta) * s * kSidePx, ny = std::cos(p.theta) * s * kSidePx;
    const auto& l = p.appearance.left;
    const auto& r = p.appearance.right;
    for (const auto& [side, c] :
         {std::pair{-1.0F, Colour{l[0], l[1], l[2]}}, std::pair{1.0F, Colour{r[0], r[1], r[2]}}}) {
      canvas.disc(x + side * nx, y + side * ny, 0.8F * s, {}, 0.6F);
      canvas.disc(x + side * nx, y + side * ny, 0.6F * s, c);
    }
  }
  return canvas;
}

// Values between the 5th and the 95th percentile are spread over 0..1.
struct Spread {
  double low = 0, high = 1;

  explicit Spread(const std::vector<double>& values) {
    if (values.empty()) return;
    low = percentile(values, 5);
    high = std::max(percentile(values, 95), low + 1e-12);
  }
  [[nodiscard]] float operator()(double v) const { return static_cast<float>((v - low) / (high - low)); }
};

// Standard deviation across the edge (m): mean of the two local directions, y and z.
double across_sigma_m(const Primitive3d& p) {
  const auto& c = p.geometry.covariance;
  const auto& t = p.tangent;
  double trace = 0, along = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    trace += c[packed_index(6, i, i)];
    for (std::size_t j = 0; j < 3; ++j) along += t[i] * t[j] * c[packed_index(6, std::min(i, j), std::max(i, j))];
  }
  return std::sqrt(std::max(0.0, (trace - along) / 2));
}

Canvas eye_with_model(const ImageView& image, int scale, const Camera& camera, const Viewpoint& view,
                      std::span<const Primitive3d> model) {
  const auto s = static_cast<float>(scale);
  std::vector<double> sigmas;
  for (const Primitive3d& p : model)
    if (p.state == State::kConfirmed) sigmas.push_back(std::log(across_sigma_m(p) + 1e-9));
  const Spread spread(sigmas);
  Canvas canvas(image, scale, 0.25F, 0.55F, kSteps);
  for (const State state : {State::kPreserved, State::kConfirmed})  // confirmed ones on top
    for (const Primitive3d& p : model) {
      if (p.state != state) continue;
      const auto seen = project(p, view, camera);
      if (!seen || !inside(camera, seen->x_px, seen->y_px, 0) || seen->facing > std::numbers::pi / 2) continue;
      const float x = on_canvas(static_cast<float>(seen->x_px), scale),
                  y = on_canvas(static_cast<float>(seen->y_px), scale);
      const auto direction = static_cast<float>(seen->direction);
      const bool confirmed = state == State::kConfirmed;
      const Colour colour = confirmed ? ramp(spread(std::log(across_sigma_m(p) + 1e-9))) : Colour{0.85F, 0.85F, 0.9F};
      if (confirmed) stroke(canvas, x, y, direction, s * kStrokePx / 2, 2.2F * s, {}, 0.5F);
      stroke(canvas, x, y, direction, s * kStrokePx / 2, confirmed ? 1.5F * s : 0.8F * s, colour, confirmed ? 1 : 0.4F);
    }
  return canvas;
}

}  // namespace

Canvas draw_primitives(const OverlayScene& scene) {
  return beside(eye_with_primitives(scene.frame.left, scale_of(scene.frame.left), scene.left),
                eye_with_primitives(scene.frame.right, scale_of(scene.frame.right), scene.right));
}

Canvas draw_matches(const OverlayScene& scene) {
  const int scale = scale_of(scene.frame.left);
  const auto s = static_cast<float>(scale);
  Canvas canvas = beside(Canvas(scene.frame.left, scale, 0.25F, 0.45F, kSteps),
                         Canvas(scene.frame.right, scale_of(scene.frame.right), 0.25F, 0.45F, kSteps));
  const auto offset = static_cast<float>(scene.frame.left.width_px * scale + kGapPx);
  std::vector<double> disparities;
  for (const StereoMatch& m : scene.matches) disparities.push_back(m.disparity_px);
  const Spread spread(disparities);
  constexpr std::size_t kJoined = 80;  // more lines hide the images
  const std::size_t every = std::max<std::size_t>(1, scene.matches.size() / kJoined);
  for (std::size_t i = 0; i < scene.matches.size(); ++i) {
    const StereoMatch& m = scene.matches[i];
    if (m.left >= scene.left.size() || m.right >= scene.right.size()) continue;
    const Primitive2d& l = scene.left[m.left];
    const Primitive2d& r = scene.right[m.right];
    const Colour colour = ramp(spread(m.disparity_px));
    const float xl = on_canvas(l.x_px, scale), yl = on_canvas(l.y_px, scale);
    const float xr = offset + on_canvas(r.x_px, scale), yr = on_canvas(r.y_px, scale);
    if (i % every == 0) canvas.line(xl, yl, xr, yr, 0.4F * s, colour, 0.35F);
    stroke(canvas, xl, yl, l.theta, s * kStrokePx / 2, 1.1F * s, colour, 1);
    stroke(canvas, xr, yr, r.theta, s * kStrokePx / 2, 1.1F * s, colour, 1);
  }
  return canvas;
}

Canvas draw_model(const OverlayScene& scene) {
  const ImageView &left = scene.frame.left, &right = scene.frame.right;
  const Transform<Right, Map> T_r_m = scene.rig.T_r_l * scene.motion.T_l_m;
  return beside(eye_with_model(left, scale_of(left), scene.rig.left, Viewpoint::of(scene.motion.T_l_m), scene.model),
                eye_with_model(right, scale_of(right), scene.rig.right, Viewpoint::of(T_r_m), scene.model));
}

Canvas draw_overview(const OverlayScene& scene) {
  const ImageView& left = scene.frame.left;
  const int scale = scale_of(left, kSmallPanelPx);
  return beside(eye_with_primitives(left, scale, scene.left),
                eye_with_model(left, scale, scene.rig.left, Viewpoint::of(scene.motion.T_l_m), scene.model));
}

}  // namespace accrete::cli
