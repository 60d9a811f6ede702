// One camera's view of the scene at one moment: what is where in the image and what hides what.
#pragma once

#include <optional>
#include <vector>

#include "accrete/camera.h"
#include "synthetic/canvas.h"
#include "synthetic/scene.h"

namespace accrete::hal::synthetic {

// Where the carriers stand, seen from the left camera, and the lamps, which stand still in the scene.
struct Stage {
  Transform<Left, World> T_l_scene;
  Transform<Left, Object> T_l_object;
  Transform<Left, World> T_l_bar;
};

class View {
 public:
  // `T_c_l` brings the left camera's coordinates to this camera's. `scene` must outlive the view.
  View(const Scene& scene, const Stage& stage, const Camera& camera, const Transform<Right, Left>& T_c_l);

  // Adds the light of everything visible.
  void draw(Canvas& canvas) const;

  // The pixel where a point of a solid (in its carrier's frame) appears; nothing outside the picture or behind it.
  [[nodiscard]] std::optional<Pixel> project(std::size_t solid, const Vec3& p) const;
  [[nodiscard]] bool faces_camera(std::size_t solid, std::size_t face) const;
  // True when no other solid hides the pixel of a point on `solid`.
  [[nodiscard]] bool unhidden(std::size_t solid, Pixel p) const;
  // Of a midpoint: in the picture, on a face turned to the camera, hidden by nothing.
  [[nodiscard]] bool sees(const SceneEdge& edge) const;
  // Linear light that leaves a paint of this face.
  [[nodiscard]] Colour light(std::size_t solid, std::size_t face, const Colour& albedo) const;

 private:
  struct Seen {
    Mat3 R_c_s{};  // carrier's frame to camera
    Vec3 t_c_s{};
    Mat3 R_scene_s{};
    Vec3 eye{};                 // the camera's centre in the carrier's frame
    std::vector<bool> towards;  // per face
    Convex silhouette;
  };

  [[nodiscard]] Convex outline(const Seen& seen, const std::vector<Vec3>& corners) const;
  [[nodiscard]] bool hides(std::size_t a, std::size_t b) const;
  void draw_patch(Canvas& canvas, std::size_t solid, const Patch& patch, const Colour& colour) const;

  const Scene& scene_;
  Camera camera_;
  std::vector<Seen> seen_;
};

}  // namespace accrete::hal::synthetic
