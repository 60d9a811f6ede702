// The canvas, the PNG that it writes, the projection, and what an overlay shows.
#include "cli/overlay/overlay.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "cli/project.h"

namespace accrete::cli {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(canvas, a_line_covers_its_width_and_nothing_else) {
  Canvas canvas(20, 10);
  canvas.line(2, 5, 17, 5, 3, {1, 0, 0});
  EXPECT_EQ(canvas.at(10, 5).r, 1);
  EXPECT_EQ(canvas.at(10, 4).r, 1);
  EXPECT_EQ(canvas.at(10, 7).r, 0);
  EXPECT_EQ(canvas.at(10, 5).g, 0);
}

TEST(canvas, borders_are_anti_aliased_to_the_covered_share) {
  Canvas canvas(20, 10);
  canvas.line(2, 5.25F, 17, 5.25F, 2,
              {1, 1, 1});  // covers 4.25 .. 6.25: pixel 4 from 4.25 to 4.5, pixel 6 from 5.5 to 6.25
  EXPECT_NEAR(canvas.at(10, 4).r, 0.25F, 0.01F);
  EXPECT_NEAR(canvas.at(10, 5).r, 1, 0.01F);
  EXPECT_NEAR(canvas.at(10, 6).r, 0.75F, 0.01F);
}

TEST(canvas, drawing_outside_or_with_nonsense_coordinates_is_cut_off) {
  Canvas canvas(8, 8);
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
  canvas.line(-100, -100, -50, -50, 5, {1, 1, 1});
  canvas.line(kNan, 0, 5, 5, 5, {1, 1, 1});
  canvas.line(0, 0, kInf, 5, 5, {1, 1, 1});
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) EXPECT_EQ(canvas.at(x, y).r, 0);
  canvas.line(-1e9F, 4, 1e9F, 4, 1, {1, 1, 1});  // ends in bounded time
  EXPECT_EQ(canvas.at(3, 4).r, 1);
  canvas.paste(Canvas(20, 20), -5, -5);
  EXPECT_EQ(canvas.at(3, 4).r, 0);
}

TEST(canvas, enlarging_keeps_pixel_centres) {
  const std::uint8_t pixels[4] = {0, 100, 200, 255};
  const Canvas canvas({pixels, 2, 2, 2, PixelFormat::kGrey8}, 2, 1, 1);
  EXPECT_EQ(canvas.width_px(), 4);
  EXPECT_NEAR(canvas.at(0, 0).r * 255, 0, 1);   // beyond the centre of pixel 0: its value
  EXPECT_NEAR(canvas.at(1, 0).r * 255, 25, 1);  // a quarter of the way to pixel 1
  EXPECT_NEAR(canvas.at(3, 3).r * 255, 255, 1);
}

TEST(canvas, steps_hide_the_noise) {
  const std::uint8_t pixels[4] = {100, 101, 102, 255};
  const Canvas canvas({pixels, 4, 1, 4, PixelFormat::kGrey8}, 1, 1, 1, 5);
  EXPECT_EQ(canvas.at(0, 0).r, canvas.at(2, 0).r);
  EXPECT_NEAR(canvas.at(0, 0).r, 0.4F, 0.003F);
  EXPECT_EQ(canvas.at(3, 0).r, 1);
}

TEST(canvas, blue_first_images_keep_their_colours) {
  const std::uint8_t pixel[3] = {255, 0, 0};
  EXPECT_EQ(Canvas({pixel, 1, 1, 3, PixelFormat::kBgr8}, 1, 1, 1).at(0, 0).b, 1);
  EXPECT_EQ(Canvas({pixel, 1, 1, 3, PixelFormat::kRgb8}, 1, 1, 1).at(0, 0).r, 1);
}

TEST(canvas, its_png_reads_back_to_the_same_pixels) {
  Canvas canvas(33, 17);
  canvas.line(3, 3, 30, 12, 4, {0.2F, 0.6F, 1});
  const std::string file = canvas.png();
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&image, file.data(), file.size()), 0);
  image.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(image));
  ASSERT_NE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr), 0);
  ASSERT_EQ(image.width, 33U);
  ASSERT_EQ(image.height, 17U);
  for (int y = 0; y < 17; ++y)
    for (int x = 0; x < 33; ++x)
      EXPECT_EQ(static_cast<int>(std::lround(canvas.at(x, y).g * 255)),
                pixels[static_cast<std::size_t>(3 * (33 * y + x) + 1)]);
}

// Not push_back(straight(..)): g++ 12.2 at -O3 inlines both and drops the stores (neither clang nor a sanitizer
// objects). Tangent along +x of the map, right along +y, away from the viewer along +z: seen by a camera at the origin.
Primitive3d straight(float x, float y, float z) {
  Primitive3d p;
  p.state = State::kConfirmed;
  p.existence = 1;
  p.geometry.position = {x, y, z};
  p.tangent = {1, 0, 0};
  return p;
}

Camera pinhole() {
  Camera c;
  c.width_px = 640;
  c.height_px = 480;
  c.fx_px = c.fy_px = 500;
  c.cx_px = 320;
  c.cy_px = 240;
  return c;
}

TEST(project, gives_pixel_direction_depth_scale_and_side) {
  const Viewpoint view = Viewpoint::of(Transform<Left, Map>{});
  const auto p = project(straight(0.1F, 0.2F, 2), view, pinhole());
  ASSERT_TRUE(p);
  EXPECT_NEAR(p->x_px, 320 + 25, 1e-4);
  EXPECT_NEAR(p->y_px, 240 + 50, 1e-4);
  EXPECT_NEAR(p->direction, 0, 1e-6);
  EXPECT_NEAR(p->pixels_per_metre, 250, 1e-3);
  EXPECT_NEAR(p->facing, std::atan2(0.2, 2), 1e-5);  // line of sight across the tangent, against +z
  EXPECT_FALSE(project(straight(0, 0, -2), view, pinhole()));
}

TEST(project, from_behind_it_shows_its_back) {
  // The camera on the other side of the edge, turned half round about its own y axis.
  Transform<Left, Map> T_l_m;
  T_l_m.rotation = {0, 1, 0, 0};
  T_l_m.translation = {0, 0, 4};
  const auto p = project(straight(0, 0, 2), Viewpoint::of(T_l_m), pinhole());
  ASSERT_TRUE(p);
  EXPECT_NEAR(p->facing, kPi, 1e-5);
  EXPECT_NEAR(std::abs(p->direction), kPi, 1e-5);
}

TEST(project, direction_follows_the_distortion) {
  Camera camera = pinhole();
  camera.distortion = Distortion::kBrownConrady;
  camera.coefficients[0] = -0.3;
  const Viewpoint view = Viewpoint::of(Transform<Left, Map>{});
  Primitive3d p = straight(0.5F, 0.4F, 2), q = straight(0.5F + 1e-3F, 0.4F, 2);
  const auto a = project(p, view, camera), b = project(q, view, camera);
  ASSERT_TRUE(a && b);
  EXPECT_NEAR(a->direction, std::atan2(b->y_px - a->y_px, b->x_px - a->x_px), 1e-2);
  EXPECT_LT(a->direction, -1e-3);  // a barrel bends the horizontal line up, away from a pinhole's zero
}

struct Scene {
  std::vector<std::uint8_t> pixels = std::vector<std::uint8_t>(640 * 480, 100);
  StereoFrame frame;
  StereoRig rig;
  Motion motion;
  std::vector<Primitive2d> left, right;
  std::vector<StereoMatch> matches;
  std::vector<Primitive3d> model;

  Scene() {
    frame.left = frame.right = {pixels.data(), 640, 480, 640, PixelFormat::kGrey8};
    rig.left = rig.right = pinhole();
    rig.T_r_l.translation = {-0.1, 0, 0};
  }
  [[nodiscard]] OverlayScene view() const { return {frame, rig, motion, left, right, matches, model}; }
};

bool grey(Colour c) { return std::abs(c.r - c.g) < 0.02F && std::abs(c.g - c.b) < 0.02F; }

TEST(overlay, shows_left_and_right_side_by_side_at_twice_the_size) {
  const Canvas canvas = draw_primitives(Scene().view());
  EXPECT_EQ(canvas.height_px(), 960);
  EXPECT_GE(canvas.width_px(), 2 * 1280);
}

TEST(overlay, draws_a_primitive_where_it_is_with_its_side_colours) {
  Scene scene;
  Primitive2d p;
  p.x_px = 100;
  p.y_px = 50;
  p.theta = 0;  // to the right: left is up
  p.appearance.left = {1, 0, 0};
  p.appearance.right = {0, 0, 1};
  scene.left.push_back(p);
  const Canvas canvas = draw_primitives(scene.view());
  EXPECT_FALSE(grey(canvas.at(200, 100)));
  const Colour above = canvas.at(200, 96), below = canvas.at(200, 105);
  EXPECT_GT(above.r, above.b);
  EXPECT_GT(below.b, below.r);
  EXPECT_TRUE(grey(canvas.at(300, 300)));
}

TEST(overlay, projects_the_model_into_both_images_and_leaves_out_backs) {
  Scene scene;
  scene.model = {straight(0, 0, 1)};
  Canvas canvas = draw_model(scene.view());
  EXPECT_FALSE(grey(canvas.at(640, 480)));                 // left: centre
  EXPECT_FALSE(grey(canvas.at(1280 + 8 + 2 * 270, 480)));  // right: 50 px to the left of it
  scene.model[0].geometry.quaternion = {1, 0, 0, 0};       // half a turn about the tangent: the other side
  canvas = draw_model(scene.view());
  EXPECT_TRUE(grey(canvas.at(640, 480)));
}

TEST(overlay, overview_shows_the_left_image_twice_primitives_and_model) {
  Scene scene;
  Primitive2d p;
  p.x_px = 100;
  p.y_px = 50;
  scene.left.push_back(p);
  scene.model = {straight(0, 0, 1)};
  const Canvas canvas = draw_overview(scene.view());
  EXPECT_EQ(canvas.height_px(), 480);
  EXPECT_EQ(canvas.width_px(), 2 * 640 + 8);
  EXPECT_FALSE(grey(canvas.at(100, 50)));
  EXPECT_TRUE(grey(canvas.at(320, 240)));
  EXPECT_TRUE(grey(canvas.at(648 + 100, 50)));
  EXPECT_FALSE(grey(canvas.at(648 + 320, 240)));
}

TEST(overlay, matches_with_wild_indices_are_skipped) {
  Scene scene;
  scene.left.resize(1);
  scene.right.resize(1);
  scene.matches = {{0, 0}, {5, 0}, {0, 9}};
  EXPECT_EQ(draw_matches(scene.view()).height_px(), 960);
}

}  // namespace
}  // namespace accrete::cli
