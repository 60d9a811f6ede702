#include "extract/side_colours.h"

#include <algorithm>
#include <cmath>

namespace accrete::extract {
namespace {

std::array<float, 3> bilinear_rgb(const ImageView& image, float x, float y) {
  // The farthest sample lies 4.4 px (4.25 across, 0.75 along) from a point that is 5 px inside: nothing is negative,
  // and truncation is std::floor(), which SSE2 has not.
  const int xi = static_cast<int>(x), yi = static_cast<int>(y), n = channels(image.format);
  const float ax = x - static_cast<float>(xi), ay = y - static_cast<float>(yi);
  const std::uint8_t* a = image.row(yi) + xi * n;
  const std::uint8_t* b = image.row(yi + 1) + xi * n;
  std::array<float, 3> rgb{};
  for (int c = 0; c < 3; ++c) {
    const int k = n == 1 ? 0 : (image.format == PixelFormat::kBgr8 ? 2 - c : c);
    rgb[static_cast<std::size_t>(c)] =
        ((1 - ay) * ((1 - ax) * static_cast<float>(a[k]) + ax * static_cast<float>(a[k + n])) +
         ay * ((1 - ax) * static_cast<float>(b[k]) + ax * static_cast<float>(b[k + n]))) /
        255.0F;
  }
  return rgb;
}

// Mean over four points: two distances from the edge, two places along it.
std::array<float, 3> side(const ImageView& image, const Localised& e, float distance, float& variance) {
  std::array<float, 3> sum{}, sum2{};
  for (const float along : {-0.75F, 0.75F})
    for (const float extra : {0.0F, 0.75F}) {
      const float d = distance + (distance < 0 ? -extra : extra);
      const auto rgb = bilinear_rgb(image, e.x_px - d * e.uy + along * e.ux, e.y_px + d * e.ux + along * e.uy);
      for (std::size_t c = 0; c < 3; ++c) {
        sum[c] += 0.25F * rgb[c];
        sum2[c] += 0.25F * rgb[c] * rgb[c];
      }
    }
  for (std::size_t c = 0; c < 3; ++c) variance = std::max(variance, sum2[c] - sum[c] * sum[c]);
  return sum;
}

}  // namespace

SideColours sample_sides(const ImageView& image, const Localised& edge, bool step) {
  // Side samples begin 2 px from a step and 3.5 px from the middle of a line (METHOD 1.4, for this band-pass).
  const float distance = step ? 2.0F : 3.5F;
  SideColours out;
  float variance = 0;
  out.left = side(image, edge, -distance, variance);
  out.right = side(image, edge, distance, variance);
  // Four correlated samples count as two; floor 4 grey levels (METHOD 1.5).
  out.sigma = std::sqrt(std::max(variance, 0.0F) / 2 + (4.0F / 255) * (4.0F / 255));
  return out;
}

float encoding_shift(const SideColours& sides, Channel channel, float mixing_width_px) {
  float contrast = 0, moment = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const float step = kChannelWeights[static_cast<int>(channel)][c] * (sides.right[c] - sides.left[c]);
    contrast += step;
    moment -= step * (sides.right[c] - sides.left[c]) / (6 * (sides.right[c] + sides.left[c]) + 1e-3F);
  }
  // Steps of opposite sign in different channels may cancel in the sum: what is left is then too uncertain to correct.
  if (std::fabs(contrast) < 0.02F) return 0;
  return std::clamp(mixing_width_px * moment / contrast, -0.5F, 0.5F);
}

bool touches_fill(const ImageView& image, int x, int y) {
  const int n = channels(image.format);
  int zeros = 0;
  for (int dy = -kRadius; dy <= kRadius; dy += 2) {
    const std::uint8_t* r = image.row(y + dy) + (x - kRadius) * n;
    for (int dx = 0; dx <= 2 * kRadius; dx += 2) {
      const std::uint8_t* p = r + dx * n;
      zeros += p[0] == 0 && p[n / 2] == 0 && p[n - 1] == 0;
    }
  }
  // A quarter of the 25 samples. Single clipped pixels of a dark but real region do not count.
  return zeros >= 6;
}

}  // namespace accrete::extract
