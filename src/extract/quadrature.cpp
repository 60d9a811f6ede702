#include "extract/quadrature.h"

#include <algorithm>

namespace accrete::extract {

void load_row(const ImageView& image, Channel channel, int y, const RowKernels& kernels, float* out) {
  const int width = image.width_px;
  if (image.format == PixelFormat::kGrey8) {
    kernels.load_grey(image.row(y), width, out);
  } else {
    const float* w = kChannelWeights[static_cast<int>(channel)];
    const bool rgb = image.format == PixelFormat::kRgb8;
    const float weights[3] = {rgb ? w[0] : w[2], w[1], rgb ? w[2] : w[0]};
    kernels.load_colour(image.row(y), width, weights, out);
  }
  for (int i = 1; i <= kRadius; ++i) {
    out[-i] = out[0];
    out[width - 1 + i] = out[width - 1];
  }
}

QuadratureFilter::QuadratureFilter(const ImageView& image, Channel channel, const RowKernels& kernels,
                                   std::span<float> memory)
    : image_(image),
      channel_(channel),
      kernels_(kernels),
      stride_(row_stride(static_cast<std::size_t>(image.width_px))) {
  row_ = memory.data();
  ring_ = row_ + stride_;
  planes_ = ring_ + stride_ * kTaps * kPasses;
}

void QuadratureFilter::load(int y) {
  load_row(image_, channel_, y, kernels_, row_ + kPadding);
  float* const out[kPasses] = {pass(kGauss1, y), pass(kGauss2, y), pass(kOdd, y), pass(kSmooth, y)};
  kernels_.filter_along(row_ + kPadding, image_.width_px, out);
}

bool QuadratureFilter::advance() {
  const int y = newest_ + 1;
  if (y >= image_.height_px) return false;
  for (; loaded_ < image_.height_px && loaded_ <= y + kRadius; ++loaded_) load(loaded_);
  const float* rows[kPasses][kTaps];
  for (int i = 0; i < kTaps; ++i) {
    const int source = std::clamp(y + i - kRadius, 0, image_.height_px - 1);
    for (int p = 0; p < kPasses; ++p) rows[p][i] = pass(p, source);
  }
  kernels_.filter_across(rows, image_.width_px, plane(0, y), plane(1, y), plane(2, y), plane(3, y));
  newest_ = y;
  return true;
}

Triple quadrature_at(const std::uint8_t* grey, std::ptrdiff_t stride, int x, int y) {
  constexpr Kernels k = kKernels;
  float g1 = 0, g2 = 0, ox = 0, oy = 0;
  for (int dy = -kRadius; dy <= kRadius; ++dy) {
    const std::uint8_t* r = grey + (y + dy) * stride + x;
    const auto f = [r](int i) { return static_cast<float>(r[i]); };
    float a = k.gauss1[0] * f(0), b = k.gauss2[0] * f(0), c = 0, d = k.smooth[0] * f(0);
    for (int i = 1; i <= kRadius; ++i) {
      const float p = f(i) + f(-i);
      a += k.gauss1[i] * p;
      b += k.gauss2[i] * p;
      c += k.odd[i] * (f(i) - f(-i));
      d += k.smooth[i] * p;
    }
    const int j = dy < 0 ? -dy : dy;
    g1 += k.gauss1[j] * a;
    g2 += k.gauss2[j] * b;
    ox += k.smooth[j] * c;
    oy += (dy < 0 ? -k.odd[j] : k.odd[j]) * d;
  }
  return {g1 - g2, ox, oy};
}

}  // namespace accrete::extract
