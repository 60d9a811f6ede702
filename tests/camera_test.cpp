#include "accrete/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace accrete {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Camera pinhole() { return {640, 480, 533.4, 530.1, 342.5, 234.7, Distortion::kNone, {}}; }
Camera with(Distortion model, std::array<double, 12> k) {
  Camera c = pinhole();
  c.distortion = model;
  c.coefficients = k;
  return c;
}

struct Named {
  std::string name;
  Camera camera;
};
void PrintTo(const Named& n, std::ostream* os) { *os << n.name; }

// The strong barrel of OpenCV's sample cameras (k3 included), a rational lens, one with thin prisms, and a fisheye.
const Named kModels[] = {
    {"none", pinhole()},
    {"brown4", with(Distortion::kBrownConrady, {-0.2834, 0.0739, 0.00019, 1.76e-05})},
    {"brown5", with(Distortion::kBrownConrady, {-0.28197, 0.03886, 0.00121, -0.000126, 0.11908})},
    {"brown8", with(Distortion::kBrownConrady, {0.41, -2.1, 0.0005, -0.0003, 1.6, 0.53, -2.0, 1.5})},
    {"brown12", with(Distortion::kBrownConrady,
                     {-0.25, 0.07, 0.001, -0.0005, 0.01, 0.02, -0.01, 0.004, 0.001, -0.0002, 0.0008, 0.0003})},
    {"kannala", with(Distortion::kKannalaBrandt, {-0.0137, 0.0204, -0.0123, 0.0028})},
};

class CameraModel : public testing::TestWithParam<Named> {};

TEST_P(CameraModel, RoundTripFromPixelOnAGridWithTheBorder) {
  const Camera& c = GetParam().camera;
  for (double y = -0.5; y <= 479.5; y += 24)
    for (double x = -0.5; x <= 639.5; x += 32) {
      const auto p = unproject(c, {x, y});
      ASSERT_TRUE(p.ok()) << x << ' ' << y;
      const auto back = project(c, p.value());
      ASSERT_TRUE(back.ok()) << x << ' ' << y;
      EXPECT_NEAR(back.value().x, x, 1e-6);
      EXPECT_NEAR(back.value().y, y, 1e-6);
    }
}

TEST_P(CameraModel, RoundTripFromRay) {
  const Camera& c = GetParam().camera;
  for (double y = -0.4; y <= 0.4; y += 0.08)
    for (double x = -0.55; x <= 0.55; x += 0.11) {
      const auto pixel = project(c, {x, y});
      ASSERT_TRUE(pixel.ok()) << x << ' ' << y;
      const auto p = unproject(c, pixel.value());
      ASSERT_TRUE(p.ok()) << x << ' ' << y;
      EXPECT_NEAR(p.value().x, x, 1e-8);
      EXPECT_NEAR(p.value().y, y, 1e-8);
    }
}

TEST_P(CameraModel, JacobianAgainstDifferences) {
  const Camera& c = GetParam().camera;
  const double h = 1e-6;
  for (const Normalized p : {Normalized{0, 0}, {1e-6, -1e-6}, {0.3, -0.2}, {-0.5, 0.4}, {0.0, 0.4}, {-0.6, 0.0}}) {
    const auto j = project_jacobian(c, p);
    const auto x0 = project(c, {p.x - h, p.y}).value(), x1 = project(c, {p.x + h, p.y}).value();
    const auto y0 = project(c, {p.x, p.y - h}).value(), y1 = project(c, {p.x, p.y + h}).value();
    EXPECT_NEAR(j[0], (x1.x - x0.x) / (2 * h), 1e-5);
    EXPECT_NEAR(j[1], (y1.x - y0.x) / (2 * h), 1e-5);
    EXPECT_NEAR(j[2], (x1.y - x0.y) / (2 * h), 1e-5);
    EXPECT_NEAR(j[3], (y1.y - y0.y) / (2 * h), 1e-5);
  }
}

INSTANTIATE_TEST_SUITE_P(Models, CameraModel, testing::ValuesIn(kModels),
                         [](const auto& model) { return model.param.name; });

TEST(Camera, BrownConradyAgainstItsFormula) {
  // By hand, one coefficient at a time, at (0.5, 0.25): u = 0.3125.
  struct Case {
    int index;
    double dx, dy;
  };
  const double u = 0.3125;
  for (const Case& t :
       {Case{0, 0.5 * u, 0.25 * u}, Case{1, 0.5 * u * u, 0.25 * u * u}, Case{2, 2 * 0.125, u + 2 * 0.0625},
        Case{3, u + 2 * 0.25, 2 * 0.125}, Case{4, 0.5 * u * u * u, 0.25 * u * u * u}, Case{8, u, 0}, Case{9, u * u, 0},
        Case{10, 0, u}, Case{11, 0, u * u}}) {
    std::array<double, 12> k{};
    k[static_cast<std::size_t>(t.index)] = 0.1;
    const Camera c = with(Distortion::kBrownConrady, k);
    const auto p = project(c, {0.5, 0.25});
    ASSERT_TRUE(p.ok());
    EXPECT_NEAR(p.value().x, c.fx_px * (0.5 + 0.1 * t.dx) + c.cx_px, 1e-10) << t.index;
    EXPECT_NEAR(p.value().y, c.fy_px * (0.25 + 0.1 * t.dy) + c.cy_px, 1e-10) << t.index;
  }
  const Camera c = with(Distortion::kBrownConrady, {0, 0, 0, 0, 0, 0.1, 0.2, 0.3});
  EXPECT_NEAR(project(c, {0.5, 0.25}).value().x,
              c.fx_px * 0.5 / (1 + 0.1 * u + 0.2 * u * u + 0.3 * u * u * u) + c.cx_px, 1e-10);
}

TEST(Camera, KannalaBrandtWithoutCoefficientsIsEquidistant) {
  const Camera c = with(Distortion::kKannalaBrandt, {});
  for (const double degrees : {1e-7, 10.0, 45.0, 80.0, 89.0}) {
    const double theta = degrees * 3.14159265358979323846 / 180;
    const auto p = project(c, {std::tan(theta), 0});
    ASSERT_TRUE(p.ok());
    EXPECT_NEAR(p.value().x, c.fx_px * theta + c.cx_px, 1e-9);
    const auto ray = unproject(c, p.value());
    ASSERT_TRUE(ray.ok()) << degrees;
    EXPECT_NEAR(ray.value().x / std::tan(theta), 1, 1e-6);
  }
  // 90 degrees and more have no point in the plane at z = 1.
  EXPECT_EQ(unproject(c, {c.cx_px + 1.6 * c.fx_px, c.cy_px}).status(), Status::kInvalidArgument);
}

TEST(Camera, FailsBeyondTheFold) {
  // x (1 - 0.3 x^2) rises until x = sqrt(1 / 0.9) = 1.0541, where it is 0.7027.
  const Camera c = with(Distortion::kBrownConrady, {-0.3});
  const double fold = std::sqrt(1 / 0.9), top = fold * (1 - 0.3 * fold * fold);
  EXPECT_TRUE(project(c, {0.999 * fold, 0}).ok());
  EXPECT_EQ(project(c, {1.001 * fold, 0}).status(), Status::kInvalidArgument);
  // Far outside the polynomial takes every value again: still refused.
  EXPECT_EQ(project(c, {5, 3}).status(), Status::kInvalidArgument);
  const auto near = unproject(c, {c.cx_px + 0.9999 * top * c.fx_px, c.cy_px});
  ASSERT_TRUE(near.ok());
  EXPECT_LT(near.value().x, fold);
  EXPECT_EQ(unproject(c, {c.cx_px + 1.001 * top * c.fx_px, c.cy_px}).status(), Status::kInvalidArgument);
}

TEST(Camera, FailsBeyondTheFirstOfTwoFolds) {
  // Slope 1 - 2 u + 0.9 u^2: folds at u = 0.76 and rises again from u = 1.46. The second branch is no image.
  const Camera c = with(Distortion::kBrownConrady, {-2.0 / 3, 0.18});
  EXPECT_TRUE(project(c, {std::sqrt(0.75), 0}).ok());
  for (const double u : {0.78, 1.0, 1.4, 1.5, 2.5, 4.0})
    EXPECT_EQ(project(c, {std::sqrt(u), 0}).status(), Status::kInvalidArgument) << u;
}

TEST(Camera, FailsBeyondAPoleAndAFisheyeFold) {
  const Camera rational = with(Distortion::kBrownConrady, {0, 0, 0, 0, 0, -1});  // pole at r = 1
  EXPECT_TRUE(project(rational, {0.9, 0}).ok());
  EXPECT_EQ(project(rational, {1.1, 0}).status(), Status::kInvalidArgument);
  const Camera fisheye = with(Distortion::kKannalaBrandt, {-0.5});  // slope 1 - 1.5 theta^2: fold at 46.8 degrees
  EXPECT_TRUE(project(fisheye, {1.0, 0}).ok());
  EXPECT_EQ(project(fisheye, {1.1, 0}).status(), Status::kInvalidArgument);
  EXPECT_EQ(unproject(fisheye, {fisheye.cx_px + 0.6 * fisheye.fx_px, 0}).status(), Status::kInvalidArgument);
}

TEST(Camera, RefusesWhatIsNotFinite) {
  const double inf = std::numeric_limits<double>::infinity();
  for (const Named& n : kModels) {
    for (const double v : {kNan, inf, 1e200}) {
      const auto p = project(n.camera, {v, 0});
      EXPECT_TRUE(!p.ok() || std::isfinite(p.value().x)) << n.name << v;
      const auto r = unproject(n.camera, {0, v});
      EXPECT_TRUE(!r.ok() || std::isfinite(r.value().y)) << n.name << v;
    }
    EXPECT_FALSE(project(n.camera, {kNan, 0}).ok());
    EXPECT_FALSE(unproject(n.camera, {0, kNan}).ok());
    EXPECT_EQ(validate(n.camera), Status::kOk);
  }
  for (double Camera::*member : {&Camera::fx_px, &Camera::fy_px, &Camera::cx_px, &Camera::cy_px}) {
    Camera c = pinhole();
    c.*member = kNan;
    EXPECT_EQ(validate(c), Status::kInvalidArgument);
  }
  Camera c = pinhole();
  c.fy_px = 0;
  EXPECT_EQ(validate(c), Status::kInvalidArgument);
  c = pinhole();
  c.coefficients[3] = inf;
  EXPECT_EQ(validate(c), Status::kInvalidArgument);
  c = pinhole();
  c.width_px = 0;
  EXPECT_EQ(validate(c), Status::kInvalidArgument);
}

}  // namespace
}  // namespace accrete
