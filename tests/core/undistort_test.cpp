// Line elements through a lens and a turned aligned frame, against numerical differentiation of the map of points.
#include "extract/undistort.h"

#include <gtest/gtest.h>

#include "base/angles.h"
#include "core/picture.h"

namespace accrete {
namespace {

using test::Dice;

Camera bent(Distortion kind) {
  Camera c = test::plain_camera(640, 480, 500);
  c.fy_px = 510;
  c.cx_px = 310;
  c.cy_px = 250;
  c.distortion = kind;
  if (kind == Distortion::kBrownConrady) c.coefficients = {-0.28, 0.09, 0.0012, -0.0008, -0.01};
  if (kind == Distortion::kKannalaBrandt) c.coefficients = {0.03, -0.01, 0.004, -0.001};
  return c;
}

Mat3 turned() {  // a verged camera: 6 degrees about y, 2 about x, 1 about z
  const auto r = [](double x, double y, double z, double angle) {
    const double s = std::sin(angle / 2);
    return Quaternion{x * s, y * s, z * s, std::cos(angle / 2)};
  };
  return to_matrix(r(0, 1, 0, 0.105) * r(1, 0, 0, 0.035) * r(0, 0, 1, 0.017));
}

constexpr double kFocal = 480;

struct Point {
  double x, y;
};
// The map of points alone.
Point aligned(const Camera& camera, const Mat3& R, double x, double y) {
  const auto n = unproject(camera, {x, y});
  EXPECT_TRUE(n.ok());
  const Vec3 d = R * Vec3{n.value().x, n.value().y, 1};
  return {kFocal * d[0] / d[2], kFocal * d[1] / d[2]};
}
double cross(const Point& a, const Point& b) { return a.x * b.y - a.y * b.x; }

TEST(Undistort, of_elements_is_the_derivative_of_that_of_points) {
  Dice dice(1);
  const Mat3 R = turned();
  for (const Distortion kind : {Distortion::kNone, Distortion::kBrownConrady, Distortion::kKannalaBrandt}) {
    const Camera camera = bent(kind);
    for (int k = 0; k < 200; ++k) {
      Primitive2d p;
      p.x_px = static_cast<float>(dice.uniform(5, 635));
      p.y_px = static_cast<float>(dice.uniform(5, 475));
      p.theta = static_cast<float>(dice.uniform(0, double{kPi}));
      p.sigma_n_px = static_cast<float>(dice.uniform(0.1, 1));
      p.sigma_theta = static_cast<float>(dice.uniform(0.01, 0.1));
      ASSERT_TRUE(extract::undistort(camera, R, kFocal, p));

      const double x = p.x_px, y = p.y_px, c = std::cos(double{p.theta}), s = std::sin(double{p.theta});
      const Point at = aligned(camera, R, x, y);
      EXPECT_NEAR(p.aligned.x_px, at.x, 1e-3);
      EXPECT_NEAR(p.aligned.y_px, at.y, 1e-3);
      // Along the element.
      constexpr double h = 0.01;
      const auto along = [&](double cc, double ss) {
        const Point a = aligned(camera, R, x + h * cc, y + h * ss), b = aligned(camera, R, x - h * cc, y - h * ss);
        return Point{(a.x - b.x) / (2 * h), (a.y - b.y) / (2 * h)};
      };
      const Point u = along(c, s);
      const double stretch = std::hypot(u.x, u.y);
      EXPECT_NEAR(p.aligned.c, u.x / stretch, 1e-5);
      EXPECT_NEAR(p.aligned.s, u.y / stretch, 1e-5);
      // A line that is moved across itself by sigma.
      const Point v = along(-s, c);
      EXPECT_NEAR(p.aligned.sigma_n_px, double{p.sigma_n_px} * cross(u, v) / stretch, 1e-4);
      // A line that is turned: a small angle, scaled up.
      constexpr double turn = 1e-4;
      const Point w = along(std::cos(double{p.theta} + turn), std::sin(double{p.theta} + turn));
      const double angle = std::asin(cross(u, w) / (stretch * std::hypot(w.x, w.y))) / turn;
      EXPECT_GT(angle, 0);  // the sense of turning, and so the sides, stay
      EXPECT_NEAR(p.aligned.sigma_theta, double{p.sigma_theta} * angle, 1e-4);
    }
  }
}

TEST(Undistort, raw_position_and_angle_stay) {
  const Camera camera = bent(Distortion::kBrownConrady);
  Primitive2d p;
  p.x_px = 123;
  p.y_px = 77;
  p.theta = 1;
  ASSERT_TRUE(extract::undistort(camera, turned(), kFocal, p));
  EXPECT_EQ(p.x_px, 123);
  EXPECT_EQ(p.y_px, 77);
  EXPECT_EQ(p.theta, 1);
}

TEST(Undistort, outside_of_the_domain_is_refused) {
  // Far beyond the fold of the lens, behind the aligned camera, and not a number.
  Camera folding = bent(Distortion::kBrownConrady);
  folding.coefficients = {-0.5, 0, 0, 0, 0};
  Primitive2d p;
  p.x_px = 5000;
  p.y_px = 4000;
  EXPECT_FALSE(extract::undistort(folding, turned(), kFocal, p));
  p.x_px = 320;
  p.y_px = 240;
  EXPECT_FALSE(extract::undistort(bent(Distortion::kNone), {-1, 0, 0, 0, 1, 0, 0, 0, -1}, kFocal, p));
  EXPECT_FALSE(extract::undistort(bent(Distortion::kNone), {0, 0, 1, 0, 1, 0, -1, 0, 0.05}, kFocal, p));
  p.x_px = std::nanf("");
  EXPECT_FALSE(extract::undistort(bent(Distortion::kBrownConrady), turned(), kFocal, p));
}

}  // namespace
}  // namespace accrete
