#include "extract/quadrature.h"

#include <algorithm>

namespace accrete::extract {
namespace {

#define ACCRETE_RESTRICT __restrict

// Folded: the four passes share the sums and differences of mirrored pixels.
void horizontal(const float* ACCRETE_RESTRICT r, float* ACCRETE_RESTRICT g1, float* ACCRETE_RESTRICT g2,
                float* ACCRETE_RESTRICT odd, float* ACCRETE_RESTRICT smooth, int width) {
  constexpr Kernels k = kKernels;
  for (int x = 0; x < width; ++x) {
    const float z = r[x];
    const float p1 = r[x + 1] + r[x - 1], p2 = r[x + 2] + r[x - 2], p3 = r[x + 3] + r[x - 3], p4 = r[x + 4] + r[x - 4];
    const float m1 = r[x + 1] - r[x - 1], m2 = r[x + 2] - r[x - 2], m3 = r[x + 3] - r[x - 3], m4 = r[x + 4] - r[x - 4];
    g1[x] = k.gauss1[0] * z + k.gauss1[1] * p1 + k.gauss1[2] * p2 + k.gauss1[3] * p3 + k.gauss1[4] * p4;
    g2[x] = k.gauss2[0] * z + k.gauss2[1] * p1 + k.gauss2[2] * p2 + k.gauss2[3] * p3 + k.gauss2[4] * p4;
    odd[x] = k.odd[1] * m1 + k.odd[2] * m2 + k.odd[3] * m3 + k.odd[4] * m4;
    smooth[x] = k.smooth[0] * z + k.smooth[1] * p1 + k.smooth[2] * p2 + k.smooth[3] * p3 + k.smooth[4] * p4;
  }
}

// rows[i] is the horizontal pass at y - 4 + i. The taps are written out: compilers vectorise this form, not a loop.
void vertical(const float* const* ga, const float* const* gb, const float* const* od, const float* const* sm,
              float* ACCRETE_RESTRICT even, float* ACCRETE_RESTRICT odd_x, float* ACCRETE_RESTRICT odd_y,
              float* ACCRETE_RESTRICT energy, int width) {
  constexpr Kernels k = kKernels;
  const float *a0 = ga[0], *a1 = ga[1], *a2 = ga[2], *a3 = ga[3], *a4 = ga[4], *a5 = ga[5], *a6 = ga[6], *a7 = ga[7],
              *a8 = ga[8];
  const float *b0 = gb[0], *b1 = gb[1], *b2 = gb[2], *b3 = gb[3], *b4 = gb[4], *b5 = gb[5], *b6 = gb[6], *b7 = gb[7],
              *b8 = gb[8];
  for (int x = 0; x < width; ++x)
    even[x] = k.gauss1[0] * a4[x] + k.gauss1[1] * (a3[x] + a5[x]) + k.gauss1[2] * (a2[x] + a6[x]) +
              k.gauss1[3] * (a1[x] + a7[x]) + k.gauss1[4] * (a0[x] + a8[x]) -
              (k.gauss2[0] * b4[x] + k.gauss2[1] * (b3[x] + b5[x]) + k.gauss2[2] * (b2[x] + b6[x]) +
               k.gauss2[3] * (b1[x] + b7[x]) + k.gauss2[4] * (b0[x] + b8[x]));
  const float *c0 = od[0], *c1 = od[1], *c2 = od[2], *c3 = od[3], *c4 = od[4], *c5 = od[5], *c6 = od[6], *c7 = od[7],
              *c8 = od[8];
  const float *d0 = sm[0], *d1 = sm[1], *d2 = sm[2], *d3 = sm[3], *d5 = sm[5], *d6 = sm[6], *d7 = sm[7], *d8 = sm[8];
  for (int x = 0; x < width; ++x) {
    const float u = k.smooth[0] * c4[x] + k.smooth[1] * (c3[x] + c5[x]) + k.smooth[2] * (c2[x] + c6[x]) +
                    k.smooth[3] * (c1[x] + c7[x]) + k.smooth[4] * (c0[x] + c8[x]);
    const float v = k.odd[1] * (d5[x] - d3[x]) + k.odd[2] * (d6[x] - d2[x]) + k.odd[3] * (d7[x] - d1[x]) +
                    k.odd[4] * (d8[x] - d0[x]);
    odd_x[x] = u;
    odd_y[x] = v;
    energy[x] = even[x] * even[x] + u * u + v * v;
  }
}

}  // namespace

void load_row(const ImageView& image, Channel channel, int y, float* ACCRETE_RESTRICT out) {
  const std::uint8_t* ACCRETE_RESTRICT s = image.row(y);
  const int width = image.width_px;
  if (image.format == PixelFormat::kGrey8) {
    for (int x = 0; x < width; ++x) out[x] = static_cast<float>(s[x]);
  } else {
    const float* w = kChannelWeights[static_cast<int>(channel)];
    const bool rgb = image.format == PixelFormat::kRgb8;
    const float w0 = rgb ? w[0] : w[2], w1 = w[1], w2 = rgb ? w[2] : w[0];
    for (int x = 0; x < width; ++x)
      out[x] = w0 * static_cast<float>(s[3 * x]) + w1 * static_cast<float>(s[3 * x + 1]) +
               w2 * static_cast<float>(s[3 * x + 2]);
  }
  for (int i = 1; i <= kRadius; ++i) {
    out[-i] = out[0];
    out[width - 1 + i] = out[width - 1];
  }
}

QuadratureFilter::QuadratureFilter(const ImageView& image, Channel channel, std::span<float> memory)
    : image_(image), channel_(channel), stride_(row_stride(static_cast<std::size_t>(image.width_px))) {
  row_ = memory.data();
  ring_ = row_ + stride_;
  planes_ = ring_ + stride_ * kTaps * 4;
}

void QuadratureFilter::load(int y) {
  load_row(image_, channel_, y, row_ + kPadding);
  float* base = ring_ + static_cast<std::size_t>(y % kTaps) * stride_ + kPadding;
  const std::size_t step = stride_ * kTaps;
  horizontal(row_ + kPadding, base, base + step, base + 2 * step, base + 3 * step, image_.width_px);
}

bool QuadratureFilter::advance() {
  const int y = newest_ + 1;
  if (y >= image_.height_px) return false;
  for (; loaded_ < image_.height_px && loaded_ <= y + kRadius; ++loaded_) load(loaded_);
  const float* rows[4][kTaps];
  for (int i = 0; i < kTaps; ++i) {
    const int source = std::clamp(y + i - kRadius, 0, image_.height_px - 1);
    for (int p = 0; p < 4; ++p)
      rows[p][i] =
          ring_ + (static_cast<std::size_t>(p) * kTaps + static_cast<std::size_t>(source % kTaps)) * stride_ + kPadding;
  }
  const auto out = [&](int p) {
    return planes_ + (static_cast<std::size_t>(p) * kRingRows + static_cast<std::size_t>(y % kRingRows)) * stride_ +
           kPadding;
  };
  vertical(rows[0], rows[1], rows[2], rows[3], out(0), out(1), out(2), out(3), image_.width_px);
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
