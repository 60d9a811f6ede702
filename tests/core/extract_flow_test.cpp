// Normal flow between two images of a moving edge.
#include <gtest/gtest.h>

#include "base/angles.h"
#include "core/picture.h"

namespace accrete {
namespace {

using namespace test;

constexpr int kWidth = 96, kHeight = 80;

Picture step_at(const Line& line, double moved, double low = 50, double high = 200) {
  return paint_grey(kWidth, kHeight,
                    [&](double x, double y) { return low + (high - low) * smooth_step(line.side(x, y) - moved, 0.7); });
}
bool inner(const Primitive2d& p) { return p.x_px > 14 && p.y_px > 14 && p.x_px < kWidth - 14 && p.y_px < kHeight - 14; }

TEST(NormalFlow, has_the_sign_and_the_size_of_the_shift) {
  for (const double shift : {-1.5, -0.8, -0.3, 0.0, 0.4, 1.0, 1.5})
    for (int k = 0; k < 12; ++k) {
      const Line line{kWidth / 2 + 0.2, kHeight / 2 - 0.3, k * double{kPi} / 12 + 0.03};
      Extractor extractor(kWidth, kHeight);
      for (const Primitive2d& p : extractor(step_at(line, 0))) EXPECT_FALSE(p.has_flow);  // there is no image before
      int measured = 0, seen = 0;
      for (const Primitive2d& p : extractor(step_at(line, shift))) {
        if (!inner(p)) continue;
        ++seen;
        if (!p.has_flow) continue;
        ++measured;
        const bool opposite = std::fabs(double{p.theta} - line.theta) > 1.5;
        EXPECT_NEAR(double{p.flow_px}, opposite ? -shift : shift, 0.1 + 0.15 * std::fabs(shift)) << k;
      }
      EXPECT_GE(seen, 5);
      EXPECT_GE(measured * 10, seen * 8) << k << ' ' << shift;
    }
}

TEST(NormalFlow, a_shift_along_the_edge_is_no_flow) {
  // The contrast is the same everywhere along the edge, so nothing tells that it has moved.
  const Line line{kWidth / 2.0, kHeight / 2.0, 0.7};
  const Line moved{line.x + 5 * std::cos(0.7), line.y + 5 * std::sin(0.7), 0.7};
  Extractor extractor(kWidth, kHeight);
  (void)extractor(step_at(line, 0));
  int measured = 0;
  for (const Primitive2d& p : extractor(step_at(moved, 0))) {
    if (!p.has_flow) continue;
    ++measured;
    EXPECT_NEAR(p.flow_px, 0, 0.05);
  }
  EXPECT_GE(measured, 5);
}

TEST(NormalFlow, what_was_not_there_before_has_none) {
  const Line line{kWidth / 2.0, kHeight / 2.0, 1.2};
  const Picture before[] = {
      paint_grey(kWidth, kHeight, [](double, double) { return 128; }),  // nothing
      step_at(line, 0, 118, 138),                                       // far weaker
      step_at(line, 25),                                                // far away
  };
  for (const Picture& b : before) {
    Extractor extractor(kWidth, kHeight);
    (void)extractor(b);
    int wrong = 0, seen = 0;
    for (const Primitive2d& p : extractor(step_at(line, 0))) {
      if (!inner(p)) continue;
      ++seen;
      wrong += p.has_flow;
    }
    EXPECT_GE(seen, 4);
    EXPECT_EQ(wrong, 0);
  }
}

TEST(NormalFlow, of_an_edge_where_another_ran_across_before_there_is_none) {
  int wrong = 0, seen = 0;
  for (int k = 0; k < 24; ++k) {
    // Both cross at a place that wanders through the lattice of samples; the first one stands at 60 to 90 degrees.
    const Line now{kWidth / 2 + 0.5 * k - 6, kHeight / 2 + 0.3 * k - 4, 0.9};
    const Line before{now.x, now.y, now.theta + (60 + 30.0 * k / 23) * double{kPi} / 180};
    Extractor extractor(kWidth, kHeight);
    (void)extractor(step_at(before, 0));
    for (const Primitive2d& p : extractor(step_at(now, 0))) {
      if (!inner(p) || std::fabs(before.side(p.x_px, p.y_px)) > 1) continue;
      ++seen;
      wrong += p.has_flow;
    }
  }
  EXPECT_GE(seen, 5);
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace accrete
