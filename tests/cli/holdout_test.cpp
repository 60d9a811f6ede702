// Which frames are kept aside, which primitives must be visible there, and what counts as found.
#include "cli/evaluate/holdout.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cli/evaluate/holdout_plan.h"
#include "cli/evaluate/hull.h"
#include "cli/failure.h"

namespace accrete::cli {
namespace {

TEST(plan, every_nth_frame_and_those_that_share_its_left_photograph) {
  // Frame k shows photographs k (left) and k + 1 (right): the frame before a held-out one shows its left photograph.
  std::string sources = "# frame left right\n";
  for (int k = 0; k < 12; ++k)
    sources += std::to_string(k) + " p" + std::to_string(k) + ".png p" + std::to_string(k + 1) + ".png 1 0 0\n";
  const HoldOutPlan plan = plan_hold_out(5, 12, sources, "rig.txt");
  EXPECT_EQ(plan.held, (std::set<std::uint64_t>{4, 9}));
  EXPECT_EQ(plan.shared, (std::set<std::uint64_t>{3, 8}));
  EXPECT_TRUE(plan.keeps_aside(3) && plan.keeps_aside(4) && !plan.keeps_aside(5));
}

TEST(plan, without_sources_only_the_nth_frames) {
  const HoldOutPlan plan = plan_hold_out(2, 5, "", "rig.txt");
  EXPECT_EQ(plan.held, (std::set<std::uint64_t>{1, 3}));
  EXPECT_TRUE(plan.shared.empty());
  EXPECT_TRUE(plan_hold_out(0, 5, "", "rig.txt").held.empty());
}

TEST(plan, garbled_sources_are_refused_with_their_line) {
  try {
    (void)plan_hold_out(2, 5, "0 a b\nx c d\n", "rig.txt");
    ADD_FAILURE();
  } catch (const Failure& failure) {
    EXPECT_NE(std::string(failure.what()).find("rig.txt:2:"), std::string::npos) << failure.what();
  }
  EXPECT_THROW((void)plan_hold_out(2, 5, "0 a\n", "rig.txt"), Failure);
}

TEST(hull, holds_what_lies_between_its_corners) {
  const auto hull = convex_hull({{0, 0}, {10, 0}, {10, 10}, {0, 10}, {5, 5}, {5, 0}});
  EXPECT_EQ(hull.size(), 4U);
  EXPECT_TRUE(in_hull(hull, {5, 5}) && in_hull(hull, {0, 0}) && in_hull(hull, {10, 5}));
  EXPECT_FALSE(in_hull(hull, {10.1, 5}) || in_hull(hull, {-1, -1}));
  EXPECT_FALSE(in_hull(convex_hull({{0, 0}, {1, 1}}), {0, 0}));
  EXPECT_FALSE(in_hull(convex_hull({{0, 0}, {1, 1}, {2, 2}}), {1, 1}));
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

// At (x, y) px, one metre away, tangent to the right, seen from the front.
Primitive3d at_pixel(float x, float y) {
  Primitive3d p;
  p.state = State::kConfirmed;
  p.existence = 1;
  p.geometry.position = {(x - 320) / 500, (y - 240) / 500, 1};
  p.tangent = {1, 0, 0};
  return p;
}

Primitive2d observed(float x, float y, float theta = 0) {
  Primitive2d q;
  q.x_px = x;
  q.y_px = y;
  q.theta = theta;
  return q;
}

HeldOutFrame frame_with(std::vector<Primitive2d> primitives, const std::vector<std::uint8_t>& pixels) {
  StereoFrame frame;
  frame.left = frame.right = {pixels.data(), 640, 480, 640, PixelFormat::kGrey8};
  return held_out_frame(7, frame, Motion{}, primitives);
}

const std::vector<std::uint8_t> kGrey(640 * 480, 90);

TEST(visible, needs_the_image_the_right_side_and_pixels) {
  std::vector<std::uint8_t> pixels = kGrey;
  for (int y = 0; y < 480; ++y)
    for (int x = 480; x < 640; ++x) pixels[static_cast<std::size_t>(640 * y + x)] = 0;  // fill
  const HeldOutFrame frame = frame_with({}, pixels);
  const auto sees = [&](const Primitive3d& p) { return predict_visible(std::vector{p}, frame, pinhole()).size() == 1; };
  EXPECT_TRUE(sees(at_pixel(100, 100)));
  EXPECT_FALSE(sees(at_pixel(5, 100)));    // too near to the border
  EXPECT_FALSE(sees(at_pixel(700, 100)));  // outside
  EXPECT_FALSE(sees(at_pixel(560, 100)));  // in the fill
  EXPECT_FALSE(sees(at_pixel(478, 100)));  // its kernel touches the fill
  Primitive3d back = at_pixel(100, 240);
  back.geometry.quaternion = {1, 0, 0, 0};
  EXPECT_FALSE(sees(back));
}

TEST(found, within_the_tolerances_across_along_and_in_angle) {
  const auto found = [](const Primitive2d& q) {
    const HeldOutFrame frame = frame_with({q}, kGrey);
    return score_hold_out(std::vector{at_pixel(100, 100)}, std::vector{frame}, pinhole(), std::nullopt)["found"] == 1;
  };
  constexpr float kDegree = 0.0174533F;
  EXPECT_TRUE(found(observed(100, 100)));
  EXPECT_TRUE(found(observed(105.9F, 101.4F)));
  EXPECT_FALSE(found(observed(106.1F, 100)));
  EXPECT_FALSE(found(observed(100, 101.6F)));
  EXPECT_TRUE(found(observed(100, 100, 19 * kDegree)));
  EXPECT_TRUE(found(observed(100, 100, 161 * kDegree)));  // 19 degrees the other way round
  EXPECT_FALSE(found(observed(100, 100, 21 * kDegree)));
}

TEST(found, counts_what_is_explained_on_the_object_only) {
  const Box box{{-0.1, -0.1, 0.9}, {0.1, 0.1, 1.1}};  // about 320 +- 55, 240 +- 55 px
  const HeldOutFrame frame = frame_with({observed(320, 240), observed(340, 260), observed(100, 100)}, kGrey);
  const std::vector<Primitive3d> model{at_pixel(320, 240), at_pixel(300, 300), at_pixel(100, 100)};
  const auto r = score_hold_out(model, std::vector{frame, frame}, pinhole(), box);
  EXPECT_EQ(r["frames"], 2);
  EXPECT_EQ(r["predicted_visible"], 6);
  EXPECT_EQ(r["found"], 4);
  EXPECT_EQ(r["on_object"], 4);  // the one at (100, 100) is not on it
  EXPECT_EQ(r["explained"], 2);
  EXPECT_DOUBLE_EQ(r["explained_rate"], 0.5);
  EXPECT_EQ(r["per_frame"][0]["frame"], 7);
}

}  // namespace
}  // namespace accrete::cli
