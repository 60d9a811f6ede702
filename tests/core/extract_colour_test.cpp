// Colours on both sides, edges between colours of one brightness, and what encoded light does to a step's place.
#include <gtest/gtest.h>

#include <algorithm>

#include "base/angles.h"
#include "core/picture.h"
#include "extract/side_colours.h"

namespace accrete {
namespace {

using namespace test;
using extract::Channel;

constexpr int kWidth = 96, kHeight = 80;

Rgb blend(const Rgb& left, const Rgb& right, double share_right) {
  Rgb c{};
  for (std::size_t k = 0; k < 3; ++k) c[k] = left[k] + (right[k] - left[k]) * share_right;
  return c;
}
Picture two_colours(const Line& line, const Rgb& left, const Rgb& right, PixelFormat format = PixelFormat::kRgb8) {
  return paint(kWidth, kHeight, format,
               [&](double x, double y) { return blend(left, right, smooth_step(line.side(x, y), 0.7)); });
}
std::vector<Primitive2d> inner(std::span<const Primitive2d> found) {
  std::vector<Primitive2d> out;
  std::copy_if(found.begin(), found.end(), std::back_inserter(out), [](const Primitive2d& p) {
    return p.x_px > 14 && p.y_px > 14 && p.x_px < kWidth - 14 && p.y_px < kHeight - 14;
  });
  return out;
}
double luma(const Rgb& c) { return 0.299 * c[0] + 0.587 * c[1] + 0.114 * c[2]; }

constexpr Rgb kEarth = {180, 80, 60}, kSea = {80, 110, 168};  // 107.6 and 107.6: one brightness

TEST(ExtractColour, each_side_has_its_colour_in_every_format_and_direction) {
  const Rgb a{200, 60, 30}, b{40, 90, 220};
  for (const PixelFormat format : {PixelFormat::kRgb8, PixelFormat::kBgr8})
    for (int k = 0; k < 16; ++k) {
      const Line line{kWidth / 2.0, kHeight / 2.0, k * double{kPi} / 16 + 0.02};
      Extractor extractor(kWidth, kHeight);
      const auto found = inner(extractor(two_colours(line, a, b, format)));
      EXPECT_GE(found.size(), 5U);
      for (const Primitive2d& p : found) {
        const bool opposite = std::fabs(double{p.theta} - line.theta) > 1.5;
        for (std::size_t c = 0; c < 3; ++c) {
          EXPECT_NEAR(double{p.appearance.left[c]} * 255, (opposite ? b : a)[c], 4) << k;
          EXPECT_NEAR(double{p.appearance.right[c]} * 255, (opposite ? a : b)[c], 4) << k;
        }
        EXPECT_GE(p.sigma_colour, 4.0F / 255 - 1e-6F);
      }
    }
}

TEST(ExtractColour, grey_images_have_three_equal_channels) {
  const Line line{kWidth / 2.0, kHeight / 2.0, 0.9};
  Extractor extractor(kWidth, kHeight);
  const auto found = inner(extractor(two_colours(line, {50, 50, 50}, {190, 190, 190}, PixelFormat::kGrey8)));
  ASSERT_GE(found.size(), 5U);
  for (const Primitive2d& p : found) {
    for (const auto* side : {&p.appearance.left, &p.appearance.right})
      EXPECT_TRUE((*side)[0] == (*side)[1] && (*side)[1] == (*side)[2]);
    EXPECT_NEAR(double{p.appearance.left[0]} * 255, 50, 4);
    EXPECT_NEAR(double{p.appearance.right[0]} * 255, 190, 4);
  }
}

TEST(ExtractColour, a_line_has_the_colours_beside_it_not_its_own) {
  const Line line{kWidth / 2 + 0.2, kHeight / 2.0, 0.7};
  const Picture p = paint(kWidth, kHeight, PixelFormat::kRgb8, [&](double x, double y) {
    const double d = line.side(x, y);
    return blend(blend({60, 40, 50}, {40, 50, 30}, smooth_step(d, 0.7)), {250, 250, 250}, std::exp(-0.5 * d * d));
  });
  Extractor extractor(kWidth, kHeight);
  const auto found = inner(extractor(p));
  ASSERT_GE(found.size(), 5U);
  for (const Primitive2d& e : found) {
    EXPECT_NEAR(e.appearance.left[0] * 255, 60, 5);
    EXPECT_NEAR(e.appearance.left[2] * 255, 50, 5);
    EXPECT_NEAR(e.appearance.right[0] * 255, 40, 5);
    EXPECT_NEAR(e.appearance.right[2] * 255, 30, 5);
  }
}

TEST(ExtractColour, edges_between_colours_of_one_brightness_are_found_where_they_are) {
  ASSERT_NEAR(luma(kEarth), luma(kSea), 0.2);
  ExtractParams params;
  params.mixing_width_px = 0;
  for (int k = 0; k < 16; ++k) {
    const Line line{kWidth / 2 + 0.3, kHeight / 2 + 0.1, k * double{kPi} / 16 + 0.02};
    Extractor extractor(kWidth, kHeight);
    const auto found = inner(extractor(two_colours(line, kEarth, kSea), params));
    EXPECT_GE(found.size(), 5U) << k;
    for (const Primitive2d& p : found) {
      EXPECT_LT(std::fabs(line.side(p.x_px, p.y_px)), 0.1) << k;
      EXPECT_LT(std::fabs(wrap_pi(p.theta - static_cast<float>(line.theta))), 0.02F) << k;
      const bool opposite = std::fabs(double{p.theta} - line.theta) > 1.5;
      EXPECT_GT((opposite ? p.appearance.right : p.appearance.left)[0], 0.6F);
      EXPECT_GT((opposite ? p.appearance.left : p.appearance.right)[2], 0.6F);
    }
  }
  // The same picture in grey has no edge at all.
  Extractor grey(kWidth, kHeight);
  const Line line{kWidth / 2.0, kHeight / 2.0, 0.6};
  EXPECT_TRUE(inner(grey(paint_grey(kWidth, kHeight, [&](double x, double y) {
                return luma(blend(kEarth, kSea, smooth_step(line.side(x, y), 0.7)));
              }))).empty());
}

TEST(ExtractColour, one_edge_is_the_same_structure_whichever_channel_finds_it) {
  // Luma that grows from nothing to as strong as chroma, in the sense opposite to it: no phase may flip on the way.
  int by_luma = 0, by_chroma = 0;
  for (int k = 0; k <= 20; ++k) {
    const double more = 4.0 * k;
    const Rgb right{kSea[0] + more, kSea[1] + more, kSea[2] + more * 0.5};
    const double step = luma(right) - luma(kEarth);
    if (step < 4.2 * ExtractParams{}.min_amplitude)
      continue;  // too weak for luma to have a say: a step gives a quarter
    const Line line{kWidth / 2 + 0.3, kHeight / 2 + 0.1, 0.8};
    Extractor extractor(kWidth, kHeight);
    const auto found = inner(extractor(two_colours(line, kEarth, right)));
    EXPECT_GE(found.size(), 5U);
    const double chroma_step = 0.5 * std::fabs((right[0] - right[2]) - (kEarth[0] - kEarth[2]));
    (chroma_step > 2 * step ? by_chroma : by_luma)++;
    for (const Primitive2d& p : found) EXPECT_NEAR(double{p.appearance.phase}, -double{kPi} / 2, 0.4) << k;
  }
  EXPECT_GT(by_luma, 2);
  EXPECT_GT(by_chroma, 2);
}

// Light of a^2 on the left and b^2 on the right, mixed over `width` and encoded by a square root: the mean place of the
// encoded step, by the trapezoidal rule. Positive on the right.
double encoded_place(double a, double b, double width) {
  constexpr int n = 20000;
  double area = 0;  // of encoded value over -w/2 .. w/2
  for (int i = 0; i <= n; ++i) {
    const double s = static_cast<double>(i) / n;
    area += (i == 0 || i == n ? 0.5 : 1.0) * std::sqrt(a * a + (b * b - a * a) * s) / n;
  }
  // A sharp step at x has the area a (1/2 + x / w) + b (1/2 - x / w).
  return width * (0.5 * (a + b) - area) / (b - a);
}

extract::SideColours grey_sides(double a, double b) {
  const auto l = static_cast<float>(a), r = static_cast<float>(b);
  return {{l, l, l}, {r, r, r}, 0};
}

TEST(ExtractColour, encoding_shift_is_that_of_a_square_root) {
  for (const double a : {0.05, 0.2, 0.5, 0.9})
    for (const double b : {0.1, 0.3, 0.6, 1.0})
      for (const double width : {0.5, 1.0, 2.0}) {
        const double place = encoded_place(a, b, width);
        EXPECT_NEAR(place, -width * (b - a) / (6 * (a + b)), 1e-6 * width);  // the closed form itself
        const double shift = double{encoding_shift(grey_sides(a, b), Channel::kLuma, static_cast<float>(width))};
        EXPECT_NEAR(shift, place, 0.003 * width + 1e-6) << a << ' ' << b;
        // Towards the dark side.
        EXPECT_LT(shift * (b - a), 0);
      }
}

TEST(ExtractColour, encoding_shift_of_channels_is_the_mean_by_their_share_in_the_filtered_step) {
  const double l[3] = {0.2, 0.7, 0.4}, r[3] = {0.6, 0.8, 0.45};
  extract::SideColours sides;
  for (std::size_t c = 0; c < 3; ++c) {
    sides.left[c] = static_cast<float>(l[c]);
    sides.right[c] = static_cast<float>(r[c]);
  }
  for (const Channel channel : {Channel::kLuma, Channel::kChroma}) {
    double moment = 0, step = 0;
    for (int c = 0; c < 3; ++c) {
      const double w = double{extract::kChannelWeights[static_cast<int>(channel)][c]} * (r[c] - l[c]);
      moment += w * encoded_place(l[c], r[c], 1);
      step += w;
    }
    EXPECT_NEAR(double{encoding_shift(sides, channel, 1)}, moment / step, 0.003);
  }
}

TEST(ExtractColour, encoding_shift_is_bounded_and_nothing_for_linear_light_or_equal_sides) {
  EXPECT_EQ(encoding_shift(grey_sides(0.3, 0.9), Channel::kLuma, 0), 0);
  EXPECT_EQ(encoding_shift(grey_sides(0.4, 0.4), Channel::kLuma, 1), 0);
  EXPECT_EQ(encoding_shift(grey_sides(0, 0), Channel::kLuma, 1), 0);
  EXPECT_LE(std::fabs(encoding_shift(grey_sides(0, 1), Channel::kLuma, 10)), 0.5F);
  // Steps that nearly cancel in the sum must not give a wild shift.
  extract::SideColours cancel{{0.1F, 0.9F, 0.5F}, {0.9F, 0.0F, 0.5F}, 0};
  for (float g = 0.3F; g < 0.7F; g += 0.01F) {
    cancel.right[1] = g;
    EXPECT_LE(std::fabs(encoding_shift(cancel, Channel::kLuma, 1)), 0.5F);
  }
}

TEST(ExtractColour, the_place_of_an_encoded_step_is_corrected) {
  // Light integrated over a pixel and its blur, square root, 8 bits: with the correction the place is right again.
  ExtractParams linear, mixed;
  linear.mixing_width_px = 0;
  mixed.mixing_width_px = 1;
  double before = 0, after = 0;
  int count = 0;
  Dice dice(4);
  for (int k = 0; k < 24; ++k) {
    const double dark = dice.uniform(0.1, 0.3), bright = dice.uniform(0.7, 1);
    // Along an axis, so that a pixel is a box of exactly one pixel across the edge; bright on either side.
    const Line line{kWidth / 2 + dice.uniform(-0.5, 0.5), kHeight / 2 + dice.uniform(-0.5, 0.5),
                    k % 2 == 0 ? 0 : double{kPi} / 2};
    const double a = k % 4 < 2 ? dark : bright, b = k % 4 < 2 ? bright : dark;
    const Picture p = paint_grey(kWidth, kHeight, [&](double x, double y) {
      const double covered = std::clamp(line.side(x, y) + 0.5, 0.0, 1.0);
      return 255 * std::sqrt(a * a + (b * b - a * a) * covered);
    });
    Extractor one(kWidth, kHeight), two(kWidth, kHeight);
    // Positive towards the bright side.
    const auto toward_bright = [&](const Primitive2d& e) { return line.side(e.x_px, e.y_px) * (b > a ? 1 : -1); };
    for (const Primitive2d& e : inner(one(p, linear))) before += toward_bright(e), ++count;
    for (const Primitive2d& e : inner(two(p, mixed))) after += toward_bright(e);
  }
  ASSERT_GT(count, 100);
  EXPECT_LT(before / count, -0.06);  // towards the dark side
  EXPECT_LT(std::fabs(after / count), 0.03);
  RecordProperty("before_after", std::to_string(before / count) + ' ' + std::to_string(after / count));
}

}  // namespace
}  // namespace accrete
