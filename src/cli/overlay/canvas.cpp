#include "cli/overlay/canvas.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>

#include "cli/failure.h"

namespace accrete::cli {
namespace {

std::uint8_t to_byte(float v) { return static_cast<std::uint8_t>(std::lround(255 * std::clamp(v, 0.0F, 1.0F))); }

Colour pixel(const ImageView& image, int x, int y) {
  x = std::clamp(x, 0, image.width_px - 1);
  y = std::clamp(y, 0, image.height_px - 1);
  const std::uint8_t* p = image.row(y) + x * channels(image.format);
  constexpr float k = 1 / 255.0F;
  switch (image.format) {
    case PixelFormat::kGrey8:
      return {k * p[0], k * p[0], k * p[0]};
    case PixelFormat::kRgb8:
      return {k * p[0], k * p[1], k * p[2]};
    case PixelFormat::kBgr8:
      return {k * p[2], k * p[1], k * p[0]};
  }
  return {};
}

Colour mixed(Colour a, Colour b, float s) {
  return {a.r + s * (b.r - a.r), a.g + s * (b.g - a.g), a.b + s * (b.b - a.b)};
}

}  // namespace

Canvas::Canvas(int width_px, int height_px)
    : width_(width_px), height_(height_px), rgb_(static_cast<std::size_t>(3) * width_px * height_px, 0) {}

Canvas::Canvas(const ImageView& image, int scale, float saturation, float brightness, int steps)
    : Canvas(image.width_px * scale, image.height_px * scale) {
  const float step = 1 / static_cast<float>(scale), first = (step - 1) / 2;  // pixel centres at integers on both sides
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const float u = first + step * static_cast<float>(x), v = first + step * static_cast<float>(y);
      const int u0 = static_cast<int>(std::floor(u)), v0 = static_cast<int>(std::floor(v));
      const float su = u - static_cast<float>(u0), sv = v - static_cast<float>(v0);
      const Colour c = mixed(mixed(pixel(image, u0, v0), pixel(image, u0 + 1, v0), su),
                             mixed(pixel(image, u0, v0 + 1), pixel(image, u0 + 1, v0 + 1), su), sv);
      const float grey = 0.299F * c.r + 0.587F * c.g + 0.114F * c.b;
      const Colour shown = mixed(Colour{}, mixed({grey, grey, grey}, c, saturation), brightness);
      const auto rounded = [n = static_cast<float>(steps)](float value) { return std::round(n * value) / n; };
      blend(x, y, {rounded(shown.r), rounded(shown.g), rounded(shown.b)}, 1);
    }
}

Colour Canvas::at(int x, int y) const {
  const std::uint8_t* p = &rgb_[3 * (static_cast<std::size_t>(y) * width_ + x)];
  return {p[0] / 255.0F, p[1] / 255.0F, p[2] / 255.0F};
}

void Canvas::blend(int x, int y, Colour colour, float alpha) {
  const Colour c = alpha < 1 ? mixed(at(x, y), colour, alpha) : colour;
  std::uint8_t* p = &rgb_[3 * (static_cast<std::size_t>(y) * width_ + x)];
  p[0] = to_byte(c.r);
  p[1] = to_byte(c.g);
  p[2] = to_byte(c.b);
}

void Canvas::line(float x0, float y0, float x1, float y1, float width_px, Colour colour, float alpha) {
  if (!std::isfinite(x0 + y0 + x1 + y1 + width_px)) return;
  const float radius = width_px / 2;
  const auto low = [](float a, float b, float r) { return std::max(0.0F, std::floor(std::min(a, b) - r - 1)); };
  const auto high = [](float a, float b, float r, int size) {
    return std::min(static_cast<float>(size - 1), std::ceil(std::max(a, b) + r + 1));
  };
  const float dx = x1 - x0, dy = y1 - y0, length2 = dx * dx + dy * dy;
  const float left = low(x0, x1, radius), right = high(x0, x1, radius, width_);
  const float top = low(y0, y1, radius), bottom = high(y0, y1, radius, height_);
  for (float y = top; y <= bottom; ++y)
    for (float x = left; x <= right; ++x) {
      const float s = length2 > 0 ? std::clamp(((x - x0) * dx + (y - y0) * dy) / length2, 0.0F, 1.0F) : 0;
      const float distance = std::hypot(x - x0 - s * dx, y - y0 - s * dy);
      const float coverage = std::clamp(radius + 0.5F - distance, 0.0F, 1.0F);
      if (coverage > 0) blend(static_cast<int>(x), static_cast<int>(y), colour, alpha * coverage);
    }
}

void Canvas::paste(const Canvas& other, int x, int y) {
  for (int v = std::max(0, -y); v < other.height_ && v + y < height_; ++v)
    for (int u = std::max(0, -x); u < other.width_ && u + x < width_; ++u) blend(u + x, v + y, other.at(u, v), 1);
}

std::string Canvas::png() const {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width_);
  image.height = static_cast<png_uint_32>(height_);
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string out(bytes, '\0');
  if (png_image_write_to_memory(&image, out.data(), &bytes, 0, rgb_.data(), 0, nullptr) == 0)
    throw Failure(ExitStatus::kOutput, fmt::format("a picture cannot be written as PNG: {}", image.message));
  out.resize(bytes);
  return out;
}

Colour ramp(float s) {
  constexpr std::array<Colour, 5> kStops{{{0.20F, 0.25F, 0.75F},
                                          {0.00F, 0.72F, 0.85F},
                                          {0.25F, 0.80F, 0.35F},
                                          {0.98F, 0.85F, 0.20F},
                                          {0.93F, 0.25F, 0.20F}}};
  const float position = std::clamp(s, 0.0F, 1.0F) * (kStops.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(position), kStops.size() - 2);
  return mixed(kStops[i], kStops[i + 1], position - static_cast<float>(i));
}

Colour hue(float turns) {
  const auto channel = [turns](float shift) {
    const float s = turns + shift - std::floor(turns + shift);
    return 0.25F + 0.75F * std::clamp(std::abs(6 * s - 3) - 1, 0.0F, 1.0F);
  };
  return {channel(0), channel(2 / 3.0F), channel(1 / 3.0F)};
}

}  // namespace accrete::cli
