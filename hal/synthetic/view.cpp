#include "synthetic/view.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace accrete::hal::synthetic {
namespace {

constexpr double kNear = 0.02;  // m: nothing nearer is drawn

// Two lamps far away, and light from everywhere; the sum on a face towards the key lamp stays below 1.
constexpr double kAmbient = 0.38, kKey = 0.46, kFill = 0.2;
const Vec3 kKeyDirection = (1 / norm(Vec3{-0.45, -0.75, -0.6})) * Vec3{-0.45, -0.75, -0.6};
const Vec3 kFillDirection = (1 / norm(Vec3{0.8, -0.1, -0.5})) * Vec3{0.8, -0.1, -0.5};

// The part of a polygon in front of the camera.
std::vector<Vec3> clip_near(const std::vector<Vec3>& polygon) {
  std::vector<Vec3> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    if (p[2] >= kNear) result.push_back(p);
    if ((p[2] >= kNear) != (q[2] >= kNear)) result.push_back(p + ((kNear - p[2]) / (q[2] - p[2])) * (q - p));
  }
  return result;
}

}  // namespace

View::View(const Scene& scene, const Stage& stage, const Camera& camera, const Transform<Right, Left>& T_c_l)
    : scene_(scene), camera_(camera) {
  const Transform<World, Left> T_scene_l = stage.T_l_scene.inverse();
  seen_.reserve(scene.solids.size());
  for (const Solid& solid : scene.solids) {
    const Transform<Left, Map> T_l_s = solid.carrier == Carrier::kObject ? retag<Left, Map>(stage.T_l_object)
                                       : solid.carrier == Carrier::kBar  ? retag<Left, Map>(stage.T_l_bar)
                                                                         : retag<Left, Map>(stage.T_l_scene);
    const Transform<Right, Map> T_c_s = T_c_l * T_l_s;
    Seen seen{to_matrix(T_c_s.rotation),
              T_c_s.translation,
              to_matrix((T_scene_l * T_l_s).rotation),
              T_c_s.inverse().translation,
              {},
              {}};
    std::vector<Pixel> corners;
    for (const Face& face : solid.faces) {
      seen.towards.push_back(dot(face.normal, seen.eye - face.base.corners[0]) > 0);
      if (!seen.towards.back()) continue;
      const Convex polygon = outline(seen, face.base.corners);
      corners.insert(corners.end(), polygon.begin(), polygon.end());
    }
    seen.silhouette = convex_hull(std::move(corners));
    seen_.push_back(std::move(seen));
  }
}

Convex View::outline(const Seen& seen, const std::vector<Vec3>& corners) const {
  std::vector<Vec3> in_camera;
  in_camera.reserve(corners.size());
  for (const Vec3& p : corners) in_camera.push_back(seen.R_c_s * p + seen.t_c_s);
  Convex result;
  for (const Vec3& p : clip_near(in_camera))
    result.push_back({camera_.fx_px * p[0] / p[2] + camera_.cx_px, camera_.fy_px * p[1] / p[2] + camera_.cy_px});
  if (area(result) < 0) std::reverse(result.begin(), result.end());
  return result;
}

// Whether `a` can stand before `b`: the smaller layer, or the one on the camera's side of a plane between the two.
bool View::hides(std::size_t a, std::size_t b) const {
  if (a == b) return false;
  const Solid &A = scene_.solids[a], &B = scene_.solids[b];
  if (A.layer != B.layer) return A.layer < B.layer;
  double widest = -1e9;
  bool result = false;
  for (std::size_t k = 0; k < 3; ++k) {
    const double below = B.extent.min[k] - A.extent.max[k], above = A.extent.min[k] - B.extent.max[k];
    if (std::max(below, above) <= widest) continue;
    widest = std::max(below, above);
    result = below > above ? seen_[a].eye[k] < A.extent.max[k] + 0.5 * below
                           : seen_[a].eye[k] > A.extent.min[k] - 0.5 * above;
  }
  return result;
}

void View::draw_patch(Canvas& canvas, std::size_t solid, const Patch& patch, const Colour& colour) const {
  std::vector<Convex> pieces, next;
  pieces.push_back(outline(seen_[solid], patch.corners));
  for (std::size_t other = 0; other < seen_.size(); ++other) {
    if (!hides(other, solid)) continue;
    next.clear();
    for (const Convex& piece : pieces) subtract(piece, seen_[other].silhouette, next);
    std::swap(pieces, next);
  }
  for (const Convex& piece : pieces) canvas.add(piece, colour);
}

void View::draw(Canvas& canvas) const {
  for (std::size_t s = 0; s < seen_.size(); ++s) {
    const Solid& solid = scene_.solids[s];
    for (std::size_t f = 0; f < solid.faces.size(); ++f) {
      if (!seen_[s].towards[f]) continue;
      const Face& face = solid.faces[f];
      const Colour base = light(s, f, face.base.albedo);
      draw_patch(canvas, s, face.base, base);
      for (const Patch& patch : face.paint) {  // what it adds to the base below it
        const Colour paint = light(s, f, patch.albedo);
        draw_patch(canvas, s, patch, {paint[0] - base[0], paint[1] - base[1], paint[2] - base[2]});
      }
    }
  }
}

std::optional<Pixel> View::project(std::size_t solid, const Vec3& p) const {
  const Vec3 q = seen_[solid].R_c_s * p + seen_[solid].t_c_s;
  if (q[2] < kNear) return std::nullopt;
  const Pixel pixel{camera_.fx_px * q[0] / q[2] + camera_.cx_px, camera_.fy_px * q[1] / q[2] + camera_.cy_px};
  const bool inside =
      pixel.x >= 0 && pixel.y >= 0 && pixel.x <= camera_.width_px - 1 && pixel.y <= camera_.height_px - 1;
  return inside ? std::optional(pixel) : std::nullopt;
}

bool View::faces_camera(std::size_t solid, std::size_t face) const { return seen_[solid].towards[face]; }

bool View::unhidden(std::size_t solid, Pixel p) const {
  for (std::size_t other = 0; other < seen_.size(); ++other)
    if (hides(other, solid) && contains(seen_[other].silhouette, p)) return false;
  return true;
}

bool View::sees(const SceneEdge& edge) const {
  if (!faces_camera(edge.solid, edge.face_left) && !faces_camera(edge.solid, edge.face_right)) return false;
  const std::optional<Pixel> p = project(edge.solid, 0.5 * (edge.p0 + edge.p1));
  return p.has_value() && unhidden(edge.solid, *p);
}

Colour View::light(std::size_t solid, std::size_t face, const Colour& albedo) const {
  const Vec3 n = seen_[solid].R_scene_s * scene_.solids[solid].faces[face].normal;
  const double lamps =
      kAmbient + kKey * std::max(0.0, dot(n, kKeyDirection)) + kFill * std::max(0.0, dot(n, kFillDirection));
  Colour out{lamps * albedo[0], lamps * albedo[1], lamps * albedo[2]};
  const Face& f = scene_.solids[solid].faces[face];
  if (f.shimmer > 0) {
    // One and a half periods over a half turn of the viewer about the face, red, green and blue a third apart.
    const Vec3 d = seen_[solid].eye - f.base.corners[0];
    const double along =
        dot(d, f.base.corners[1] - f.base.corners[0]) / (norm(d) * norm(f.base.corners[1] - f.base.corners[0]));
    for (std::size_t c = 0; c < 3; ++c)
      out[c] *= 1 + f.shimmer * std::sin(2 * 3.14159265358979 * (1.5 * along + static_cast<double>(c) / 3));
  }
  return out;
}

}  // namespace accrete::hal::synthetic
