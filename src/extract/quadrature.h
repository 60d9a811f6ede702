// The band-pass quadrature triple of one image, streamed row by row: a difference of Gaussians (sigma 1 and 2 px) and
// its two Riesz transforms, as separable 9-tap kernels (docs/math/extraction.md). Rows come out while they are in the
// cache.
#pragma once

#include <cstddef>
#include <span>

#include "accrete/image.h"
#include "extract/rows.h"

namespace accrete::extract {

inline constexpr int kRingRows =
    16;                              // rows of responses kept: a band of cells and what its primitives sample around it
inline constexpr int kPlanes = 4;    // even, odd x, odd y, energy
inline constexpr int kPadding = 32;  // floats around a row, so that kernels need no border case

// Euclidean norms of the three 2D kernels: the noise of a response is sigma_image times this.
inline constexpr float kEvenNorm = 0.1862F;
inline constexpr float kOddNorm = 0.1334F;

[[nodiscard]] constexpr std::size_t row_stride(std::size_t width) { return (width + 2 * kPadding + 15) / 16 * 16; }
// Floats that a QuadratureFilter needs for images of up to `width` pixels.
[[nodiscard]] constexpr std::size_t quadrature_floats(std::size_t width) {
  return row_stride(width) * (1 + kTaps * kPasses + kRingRows * kPlanes);
}

// What of the pixels is filtered: grey levels (luma), or the blue-red difference (R - B) / 2 of a colour image, in
// which edges between colours of one brightness show.
enum class Channel : std::uint8_t { kLuma, kChroma };
inline constexpr float kChannelWeights[2][3] = {{0.299F, 0.587F, 0.114F}, {0.5F, 0.0F, -0.5F}};  // of R, G, B

class QuadratureFilter {
 public:
  // Precondition: memory.size() >= quadrature_floats(image.width_px); image.valid(); chroma needs a colour image.
  QuadratureFilter(const ImageView& image, Channel channel, const RowKernels& kernels, std::span<float> memory);

  // Computes the responses of the next row; false when all rows are done. Borders are replicated.
  bool advance();
  [[nodiscard]] const RowKernels& kernels() const { return kernels_; }
  // Index of the newest row of responses, -1 before the first.
  [[nodiscard]] int newest() const { return newest_; }

  // Rows newest() - kRingRows + 1 .. newest() are there; x from 0 to width - 1.
  [[nodiscard]] const float* even(int y) const { return plane(0, y); }
  [[nodiscard]] const float* odd_x(int y) const { return plane(1, y); }
  [[nodiscard]] const float* odd_y(int y) const { return plane(2, y); }
  [[nodiscard]] const float* energy(int y) const { return plane(3, y); }  // even^2 + odd^2
  // From a row of even() to the same one of odd_x(), and on to odd_y().
  [[nodiscard]] std::size_t plane_step() const { return kRingRows * stride_; }

 private:
  [[nodiscard]] float* plane(int p, int y) const {
    return planes_ + (static_cast<std::size_t>(p) * kRingRows + static_cast<std::size_t>(y) % kRingRows) * stride_ +
           kPadding;
  }
  [[nodiscard]] float* pass(int p, int y) const {
    return ring_ + (static_cast<std::size_t>(p) * kTaps + static_cast<std::size_t>(y) % kTaps) * stride_ + kPadding;
  }
  void load(int y);

  ImageView image_;
  Channel channel_;
  const RowKernels& kernels_;
  std::size_t stride_;
  float* row_;     // one padded row of the channel
  float* ring_;    // kPasses x kTaps rows
  float* planes_;  // 4 planes x kRingRows rows
  int loaded_ = 0;
  int newest_ = -1;
};

// One row of a channel in grey levels, with kRadius replicated pixels on both sides of `out`.
void load_row(const ImageView& image, Channel channel, int y, const RowKernels& kernels, float* out);

// The triple at one pixel of an image that is no longer streamed. Precondition: the pixel is at least kRadius inside.
struct Triple {
  float even, odd_x, odd_y;
};
[[nodiscard]] Triple quadrature_at(const std::uint8_t* grey, std::ptrdiff_t stride, int x, int y);

}  // namespace accrete::extract
