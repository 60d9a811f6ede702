// A picture in memory with the few shapes that overlays need, anti-aliased.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "accrete/image.h"

namespace accrete::cli {

struct Colour {
  float r = 0, g = 0, b = 0;  // 0..1
};

class Canvas {
 public:
  Canvas(int width_px, int height_px);
  // An image enlarged `scale` times (bilinear), its saturation and brightness multiplied, each channel rounded to
  // `steps` steps (fewer hide the noise, which is most of a PNG file). Preconditions: image.valid(), steps >= 1.
  Canvas(const ImageView& image, int scale, float saturation, float brightness, int steps = 255);

  [[nodiscard]] int width_px() const { return width_; }
  [[nodiscard]] int height_px() const { return height_; }
  [[nodiscard]] Colour at(int x, int y) const;

  // A line with round ends; coordinates in pixels, centres at integers. Parts outside the picture are cut off; a
  // coordinate that is not finite draws nothing.
  void line(float x0, float y0, float x1, float y1, float width_px, Colour colour, float alpha = 1);
  void disc(float x, float y, float radius_px, Colour colour, float alpha = 1) {
    line(x, y, x, y, 2 * radius_px, colour, alpha);
  }
  // Copies `other` to (x, y); what does not fit is cut off.
  void paste(const Canvas& other, int x, int y);

  // The picture as an RGB PNG file. Throws Failure(kOutput) when libpng refuses.
  [[nodiscard]] std::string png() const;

 private:
  void blend(int x, int y, Colour colour, float alpha);

  int width_ = 0, height_ = 0;
  std::vector<std::uint8_t> rgb_;
};

// A gradient from dark blue over cyan, green and yellow to red; `s` is clamped to 0..1.
[[nodiscard]] Colour ramp(float s);
// A closed circle of hues, for directions; any `turns`.
[[nodiscard]] Colour hue(float turns);

}  // namespace accrete::cli
