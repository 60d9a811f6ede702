// Colours on both sides of an edge, sampled where the phase says that the sides begin (METHOD 1.5).
#pragma once

#include "accrete/image.h"
#include "extract/localise.h"

namespace accrete::extract {

struct SideColours {
  std::array<float, 3> left{}, right{};  // RGB, 0..1
  float sigma = 0;                       // of one channel, 0..1
};

// Only here is colour touched: the image is never converted. `step`: an edge between two sides, not a line with two
// edges of its own. Precondition: the point is at least 6 px inside.
[[nodiscard]] SideColours sample_sides(const ImageView& image, const Localised& edge, bool step);

// Where an encoded image shows a step, relative to where it is: pixels integrate light, and the square root that
// encodes it moves the middle towards the dark side, by (b - a) / (6 (a + b)) of the width over which light is mixed,
// in each channel between encoded values a and b (docs/math/extraction.md). px along the right-hand normal, for the
// weighted sum of channels that was filtered; at most half a pixel.
[[nodiscard]] float encoding_shift(const SideColours& sides, Channel channel, float mixing_width_px);

// True when the kernel at (x, y) touches fill of exact zeros, as the border of a warped image has it: the straight edge
// of the fill is no edge of the scene. Real black has noise. Precondition: 4 px inside.
[[nodiscard]] bool touches_fill(const ImageView& image, int x, int y);

}  // namespace accrete::extract
