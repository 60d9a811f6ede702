// Camera formats to 8-bit grey and RGB: against formulas in double, and against drivers that lie about sizes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "camera/convert.h"
#include "camera/eyes.h"

namespace accrete::hal::camera {
namespace {

using Bytes = std::vector<std::uint8_t>;

RawImage raw_image(RawFormat format, int width, int height, std::size_t stride, const Bytes& bytes) {
  return {format, width, height, {}, split_planes(format, width, height, stride, bytes)};
}

Bytes converted(const RawImage& image) {
  EXPECT_EQ(check(image), nullptr);
  const std::size_t images = image.format == RawFormat::kY8i ? 2 : 1;
  Bytes out(images *
            static_cast<std::size_t>(image.width_px * image.height_px * channels(converted_format(image.format))));
  convert(image, out.data());
  return out;
}

Bytes random_bytes(std::size_t n) {
  std::mt19937 random(7);
  Bytes bytes(n);
  for (std::uint8_t& b : bytes) b = static_cast<std::uint8_t>(random());
  return bytes;
}

// ITU-R BT.601 and BT.709 as they are printed: in analogue values 0..1 and -0.5..0.5.
std::array<double, 3> oracle(ColourCode code, int y8, int cb8, int cr8) {
  const double kr = code.bt709 ? 0.2126 : 0.299, kb = code.bt709 ? 0.0722 : 0.114, kg = 1 - kr - kb;
  const double y = code.full_range ? y8 / 255.0 : (y8 - 16) / 219.0;
  const double cb = (cb8 - 128) / (code.full_range ? 255.0 : 224.0);
  const double cr = (cr8 - 128) / (code.full_range ? 255.0 : 224.0);
  const double r = y + 2 * (1 - kr) * cr, b = y + 2 * (1 - kb) * cb;
  const double g = (y - kr * r - kb * b) / kg;
  const auto level = [](double v) { return std::clamp(255 * v, 0.0, 255.0); };
  return {level(r), level(g), level(b)};
}

TEST(V4l2Convert, ColoursAreThoseOfTheStandards) {
  for (const ColourCode code : {ColourCode{false, false}, {false, true}, {true, false}, {true, true}}) {
    double worst = 0;
    for (int y = 0; y < 256; y += 3)
      for (int cb = 0; cb < 256; cb += 5)
        for (int cr = 0; cr < 256; cr += 5) {
          const Bytes bytes{static_cast<std::uint8_t>(y), static_cast<std::uint8_t>(cb), static_cast<std::uint8_t>(y),
                            static_cast<std::uint8_t>(cr)};
          RawImage image = raw_image(RawFormat::kYuyv, 2, 1, 4, bytes);
          image.colour = code;
          std::uint8_t out[6];
          convert(image, out);
          const auto expected = oracle(code, y, cb, cr);
          for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(out[c] - expected[c]));
        }
    EXPECT_LE(worst, 0.503);  // rounding, and 3 coefficients of 16 bits
  }
}

TEST(V4l2Convert, BlackGreyAndWhiteAreExact) {
  for (const auto& [y, grey] : {std::pair{16, 0}, {235, 255}, {126, 128}}) {
    const auto luma = static_cast<std::uint8_t>(y);
    const Bytes bytes{luma, 128, luma, 128};
    const auto level = static_cast<std::uint8_t>(grey);
    EXPECT_EQ(converted(raw_image(RawFormat::kYuyv, 2, 1, 4, bytes)), Bytes(6, level));
  }
}

// Every layout of the same picture gives the same pixels, whatever the padding; odd sizes included.
TEST(V4l2Convert, LayoutsOfOnePictureAgree) {
  for (const auto& [width, height] : {std::pair{6, 4}, {5, 3}, {1, 1}, {2, 1}}) {
    const int cw = (width + 1) / 2;
    const auto luma = [](int x, int y) { return static_cast<std::uint8_t>(40 + 17 * x + 29 * y); };
    const auto cb = [](int x, int y) { return static_cast<std::uint8_t>(100 + 11 * x + 5 * y); };
    const auto cr = [](int x, int y) { return static_cast<std::uint8_t>(90 + 3 * x + 31 * y); };
    Bytes expected;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const auto rgb = oracle({}, luma(x, y), cb(x / 2, y / 2), cr(x / 2, y / 2));
        for (const double v : rgb) expected.push_back(static_cast<std::uint8_t>(std::lround(v)));
      }
    for (const int padding : {0, 2, 8}) {
      const int stride = 2 * cw + padding, packed = 4 * cw + padding;
      const auto at = [](int index) { return static_cast<std::size_t>(index); };
      Bytes nv12(at(stride * (height + (height + 1) / 2)), 0xEE), yu12(nv12.size(), 0xEE);
      Bytes yuyv(at(packed * height), 0xEE), uyvy = yuyv;
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          nv12[at(stride * y + x)] = yu12[at(stride * y + x)] = luma(x, y);
          const int c = packed * y + 4 * (x / 2);
          yuyv[at(c + 2 * (x % 2))] = uyvy[at(c + 1 + 2 * (x % 2))] = luma(x, y);
          yuyv[at(c + 1)] = uyvy[at(c)] = cb(x / 2, y / 2);
          yuyv[at(c + 3)] = uyvy[at(c + 2)] = cr(x / 2, y / 2);
          const int chroma = stride * height, half = stride / 2;
          nv12[at(chroma + stride * (y / 2) + 2 * (x / 2))] = cb(x / 2, y / 2);
          nv12[at(chroma + stride * (y / 2) + 2 * (x / 2) + 1)] = cr(x / 2, y / 2);
          yu12[at(chroma + half * (y / 2) + x / 2)] = cb(x / 2, y / 2);
          yu12[at(chroma + half * ((height + 1) / 2 + y / 2) + x / 2)] = cr(x / 2, y / 2);
        }
      EXPECT_EQ(converted(raw_image(RawFormat::kNv12, width, height, at(stride), nv12)), expected);
      EXPECT_EQ(converted(raw_image(RawFormat::kYu12, width, height, at(stride), yu12)), expected);
      EXPECT_EQ(converted(raw_image(RawFormat::kYuyv, width, height, at(packed), yuyv)), expected);
      EXPECT_EQ(converted(raw_image(RawFormat::kUyvy, width, height, at(packed), uyvy)), expected);
    }
  }
}

TEST(V4l2Convert, WideGreyIsScaledAndRounded) {
  for (const auto& [format, bits] : {std::pair{RawFormat::kY10, 10}, {RawFormat::kY12, 12}, {RawFormat::kY16, 16}}) {
    const int max = (1 << bits) - 1, width = max + 1;
    Bytes bytes;
    for (int v = 0; v <= max; ++v) {
      bytes.push_back(static_cast<std::uint8_t>(v & 255));
      bytes.push_back(static_cast<std::uint8_t>(v >> 8));
    }
    RawImage image{format, width, 1, {}, {}};
    image.planes[0] = {bytes, bytes.size()};
    Bytes out(static_cast<std::size_t>(width));
    convert(image, out.data());
    for (int v = 0; v <= max; ++v) ASSERT_EQ(out[static_cast<std::size_t>(v)], std::lround(v * 255.0 / max)) << v;
  }
  EXPECT_EQ(converted(raw_image(RawFormat::kY10, 1, 1, 2, Bytes{0xFF, 0xFF})), Bytes{255});  // rubbish above 10 bits
}

TEST(V4l2Convert, WhatNeedsNoConversionIsLookedAtInPlace) {
  const Bytes bytes = random_bytes(20 * 4);
  for (const auto& [format, pixel] : {std::pair{RawFormat::kGrey, 1}, {RawFormat::kRgb3, 3}, {RawFormat::kBgr3, 3}}) {
    const RawImage image = raw_image(format, 5, 4, 20, bytes);
    ASSERT_TRUE(is_direct(format));
    const ImageView view = direct_view(image);
    EXPECT_TRUE(view.valid());
    EXPECT_EQ(view.data, bytes.data());
    EXPECT_EQ(view.stride_bytes, 20);
    const Bytes copy = converted(image);
    for (int y = 0; y < 4; ++y)
      EXPECT_TRUE(std::equal(view.row(y), view.row(y) + 5 * pixel, copy.begin() + y * 5 * pixel));
  }
  EXPECT_EQ(converted_format(RawFormat::kBgr3), PixelFormat::kBgr8);
}

TEST(V4l2Convert, InterleavedEyesComeApart) {
  const Bytes bytes{1, 101, 2, 102, 0, 0, 3, 103, 4, 104, 0, 0};
  EXPECT_EQ(converted(raw_image(RawFormat::kY8i, 2, 2, 6, bytes)), (Bytes{1, 2, 3, 4, 101, 102, 103, 104}));
}

constexpr RawFormat kAll[] = {RawFormat::kGrey, RawFormat::kY10,  RawFormat::kY12,  RawFormat::kY16,
                              RawFormat::kYuyv, RawFormat::kUyvy, RawFormat::kNv12, RawFormat::kYu12,
                              RawFormat::kRgb3, RawFormat::kBgr3, RawFormat::kY8i};

// The fewest bytes that suffice are enough, one less is not: the sanitizer sees that nothing beyond them is read.
TEST(V4l2Convert, ReadsNothingBeyondTheBytes) {
  for (const RawFormat format : kAll)
    for (const auto& [width, height] : {std::pair{7, 5}, {8, 4}, {1, 1}, {2, 3}}) {
      const std::size_t stride = row_bytes(format, 0, width) + 3;
      std::size_t enough = 0;
      for (std::size_t n = 1; n < 1000 && enough == 0; ++n) {
        const Bytes bytes = random_bytes(n);
        if (check(raw_image(format, width, height, stride, bytes)) == nullptr) enough = n;
      }
      ASSERT_GT(enough, 0U);
      const Bytes bytes = random_bytes(enough);
      converted(raw_image(format, width, height, stride, bytes));
      // As many as the rows reach, and not more than whole rows have.
      std::size_t most = 0;
      for (int i = 0; i < plane_count(format); ++i)
        most += (i == 0 || format == RawFormat::kNv12 ? stride : (stride + 1) / 2) *
                static_cast<std::size_t>(plane_rows(format, i, height));
      EXPECT_LE(enough, most);
      EXPECT_GE(enough, most - stride);
    }
}

TEST(V4l2Convert, RefusesHostileSizes) {
  const Bytes bytes(64, 0);
  for (const RawFormat format : kAll) {
    for (const auto& [width, height] : {std::pair{0, 4}, {4, 0}, {-4, 4}, {4, -4}, {1 << 30, 1}, {1, 1 << 30}})
      EXPECT_NE(check(raw_image(format, width, height, 16, bytes)), nullptr);
    for (const std::size_t stride : {std::size_t{0}, std::size_t{1}, SIZE_MAX, SIZE_MAX / 2, SIZE_MAX / 3 + 1})
      EXPECT_NE(check(raw_image(format, 4, 4, stride, bytes)), nullptr);
    EXPECT_NE(check(raw_image(format, 4, 4, 32, Bytes{})), nullptr);
    EXPECT_NE(check(raw_image(format, 16000, 16000, 64000, bytes)), nullptr);
  }
  EXPECT_NE(check(raw_image(RawFormat::kJpeg, 4, 4, 0, Bytes{})), nullptr);
}

TEST(V4l2Eyes, ViewsOfOneImageDivideItWithoutACopy) {
  const Bytes bytes = random_bytes(40 * 6);
  const ImageView whole{bytes.data(), 12, 6, 40, PixelFormat::kRgb8};
  ImageView left, right;
  split(StereoLayout::kSideBySide, whole, left, right);
  EXPECT_EQ(left.data, bytes.data());
  EXPECT_EQ(right.data, bytes.data() + 18);
  EXPECT_EQ(right.width_px, 6);
  EXPECT_EQ(right.height_px, 6);
  EXPECT_EQ(right.stride_bytes, 40);
  split(StereoLayout::kSideBySideSwapped, whole, left, right);
  EXPECT_EQ(right.data, bytes.data());
  EXPECT_EQ(left.data, bytes.data() + 18);
  split(StereoLayout::kTopBottom, whole, left, right);
  EXPECT_EQ(left.data, bytes.data());
  EXPECT_EQ(right.data, bytes.data() + 3 * 40);
  EXPECT_EQ(right.width_px, 12);
  EXPECT_EQ(right.height_px, 3);
}

TEST(V4l2Eyes, SizesOfBufferAndEye) {
  Size eye;
  EXPECT_TRUE(eye_size(StereoLayout::kSideBySide, {2560, 720}, eye));
  EXPECT_EQ(eye.width_px, 1280);
  EXPECT_EQ(buffer_size(StereoLayout::kSideBySide, eye).width_px, 2560);
  EXPECT_TRUE(eye_size(StereoLayout::kInterleaved, {640, 480}, eye));
  EXPECT_EQ(eye.width_px, 640);
  EXPECT_FALSE(eye_size(StereoLayout::kSideBySide, {641, 480}, eye));
  EXPECT_FALSE(eye_size(StereoLayout::kTopBottom, {640, 481}, eye));
}

}  // namespace
}  // namespace accrete::hal::camera
