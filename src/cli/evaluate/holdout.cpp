#include "cli/evaluate/holdout.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cli/evaluate/hull.h"

namespace accrete::cli {
namespace {

using nlohmann::ordered_json;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kMarginPx = 12;  // two sampling pitches, as the visibility model of the filter has it
constexpr double kMaxFacing = 80 * kDegree;
constexpr float kMinFace = 0.7F;  // of facing the camera: below, a miss says nothing against the model

bool all_zero(const ImageView& image, int x0, int y0, int cell) {
  for (int y = y0; y < std::min(y0 + cell, image.height_px); ++y) {
    const std::uint8_t* row = image.row(y);
    const int n = channels(image.format);
    for (int i = n * x0; i < n * std::min(x0 + cell, image.width_px); ++i)
      if (row[i] != 0) return false;
  }
  return true;
}

// The projection and the 2D-primitive are the same edge.
bool same_edge(const Projection& p, const Primitive2d& q, const HoldOutTolerance& tolerance) {
  const double dx = q.x_px - p.x_px, dy = q.y_px - p.y_px;
  const double c = std::cos(p.direction), s = std::sin(p.direction);
  if (std::abs(c * dx + s * dy) > tolerance.along_px || std::abs(c * dy - s * dx) > tolerance.across_px) return false;
  const double sine = std::sin(q.theta - p.direction);  // directions are compared modulo pi
  return std::abs(sine) <= std::sin(tolerance.angle_deg * kDegree);
}

ordered_json share(std::size_t part, std::size_t whole) {
  return whole > 0 ? ordered_json(static_cast<double>(part) / static_cast<double>(whole)) : ordered_json(nullptr);
}

// The outline of the box in the image; empty when a corner lies behind the camera.
std::vector<Pixel> outline(const Box& box, const Viewpoint& view, const Camera& camera) {
  std::vector<Pixel> corners;
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner{i & 1 ? box.max[0] : box.min[0], i & 2 ? box.max[1] : box.min[1],
                      i & 4 ? box.max[2] : box.min[2]};
    const Vec3 p = view.rotation * corner + view.translation;
    if (!(p[2] > 1e-3)) return {};
    const Result<Pixel> pixel = project(camera, {p[0] / p[2], p[1] / p[2]});
    if (!pixel.ok()) return {};
    corners.push_back(pixel.value());
  }
  return convex_hull(std::move(corners));
}

}  // namespace

bool HeldOutFrame::is_fill(double x_px, double y_px) const {
  const int column = static_cast<int>(x_px) / kCellPx, row = static_cast<int>(y_px) / kCellPx;
  if (column < 0 || row < 0 || column >= columns || row >= rows) return true;
  return fill[static_cast<std::size_t>(row) * columns + column];
}

HeldOutFrame held_out_frame(std::uint64_t number, const StereoFrame& frame, const Motion& motion,
                            std::span<const Primitive2d> left) {
  HeldOutFrame out;
  out.number = number;
  out.view = Viewpoint::of(motion.T_l_m);
  out.primitives.assign(left.begin(), left.end());
  constexpr int kCell = HeldOutFrame::kCellPx;
  out.columns = (frame.left.width_px + kCell - 1) / kCell;
  out.rows = (frame.left.height_px + kCell - 1) / kCell;
  for (int row = 0; row < out.rows; ++row)
    for (int column = 0; column < out.columns; ++column)
      out.fill.push_back(all_zero(frame.left, column * kCell, row * kCell, kCell));
  return out;
}

std::vector<Projection> predict_visible(std::span<const Primitive3d> model, const HeldOutFrame& frame,
                                        const Camera& camera) {
  std::vector<Projection> visible;
  for (const Primitive3d& p : model) {
    const auto seen = project(p, frame.view, camera);
    if (!seen || !inside(camera, seen->x_px, seen->y_px, kMarginPx) || seen->facing >= kMaxFacing) continue;
    // The kernel that would find it must not touch fill: one cell all round.
    bool free = true;
    for (const double dx : {-1.0, 0.0, 1.0})
      for (const double dy : {-1.0, 0.0, 1.0})
        free = free && !frame.is_fill(seen->x_px + dx * HeldOutFrame::kCellPx, seen->y_px + dy * HeldOutFrame::kCellPx);
    // What the model itself says of this direction: hidden by the object's own shape where it was looked for in vain.
    const Vec3 centre = -1.0 * (transposed(frame.view.rotation) * frame.view.translation);
    const std::array<float, 3> viewer = {static_cast<float>(centre[0]), static_cast<float>(centre[1]),
                                         static_cast<float>(centre[2])};
    if (free && face_probability(p, viewer) >= kMinFace) visible.push_back(*seen);
  }
  return visible;
}

ordered_json score_hold_out(std::span<const Primitive3d> model, std::span<const HeldOutFrame> frames,
                            const Camera& camera, const std::optional<Box>& bbox, const HoldOutTolerance& tolerance) {
  std::size_t predicted = 0, found = 0, on_object = 0, explained = 0;
  ordered_json rows = ordered_json::array();
  for (const HeldOutFrame& frame : frames) {
    const std::vector<Projection> visible = predict_visible(model, frame, camera);
    const std::vector<Pixel> hull = bbox ? outline(*bbox, frame.view, camera) : std::vector<Pixel>{};
    std::vector<bool> is_explained(frame.primitives.size(), false);
    std::size_t found_here = 0, on_object_here = 0, explained_here = 0;
    for (const Projection& p : visible) {
      bool any = false;
      for (std::size_t i = 0; i < frame.primitives.size(); ++i) {
        if (!same_edge(p, frame.primitives[i], tolerance)) continue;
        any = true;
        is_explained[i] = true;
      }
      found_here += any ? 1 : 0;
    }
    for (std::size_t i = 0; i < frame.primitives.size(); ++i) {
      if (!in_hull(hull, {frame.primitives[i].x_px, frame.primitives[i].y_px})) continue;
      ++on_object_here;
      explained_here += is_explained[i] ? 1 : 0;
    }
    rows.push_back({{"frame", frame.number},
                    {"predicted_visible", visible.size()},
                    {"found", found_here},
                    {"found_rate", share(found_here, visible.size())},
                    {"on_object", on_object_here},
                    {"explained", explained_here},
                    {"explained_rate", share(explained_here, on_object_here)}});
    predicted += visible.size(), found += found_here, on_object += on_object_here, explained += explained_here;
  }
  return {{"frames", frames.size()},
          {"predicted_visible", predicted},
          {"found", found},
          {"found_rate", share(found, predicted)},
          {"on_object", on_object},
          {"explained", explained},
          {"explained_rate", share(explained, on_object)},
          {"per_frame", rows}};
}

}  // namespace accrete::cli
