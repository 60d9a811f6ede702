#include "synthetic/canvas.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace accrete::hal::synthetic {
namespace {

constexpr int kRadius = 2;  // of the blur: the first tap left out is 1e-8
constexpr double kBlurSigma = 0.5;
constexpr std::size_t kEncodingSteps = 4096;  // linear interpolation between them errs by < 0.01 grey levels

std::array<float, 2 * kRadius + 1> blur_kernel() {
  std::array<double, 2 * kRadius + 1> k{};
  double sum = 0;
  for (int i = -kRadius; i <= kRadius; ++i) sum += k[i + kRadius] = std::exp(-0.5 * i * i / (kBlurSigma * kBlurSigma));
  std::array<float, 2 * kRadius + 1> result{};
  for (std::size_t i = 0; i < k.size(); ++i) result[i] = static_cast<float>(k[i] / sum);
  return result;
}

}  // namespace

double encode_srgb(double linear) {
  if (linear <= 0.0031308) return 12.92 * std::max(linear, 0.0);
  return 1.055 * std::pow(std::min(linear, 1.0), 1 / 2.4) - 0.055;
}

Canvas::Canvas(int width_px, int height_px)
    : width_(width_px),
      height_(height_px),
      columns_(width_px + 2 * kRadius + 2),
      rows_(height_px + 2 * kRadius),
      light_(static_cast<std::size_t>(columns_) * rows_ * 3),
      blurred_(light_.size()),
      encoding_(kEncodingSteps + 2) {
  for (std::size_t i = 0; i < encoding_.size(); ++i)
    encoding_[i] = static_cast<float>(255 * encode_srgb(static_cast<double>(i) / kEncodingSteps));
}

void Canvas::clear() { std::fill(light_.begin(), light_.end(), 0.0F); }

void Canvas::add(const Convex& polygon, const Colour& colour) {
  // From pixel centres at integers to pixels that begin at integers, margin included.
  constexpr double kShift = kRadius + 0.5;
  const double w = columns_ - 2, h = rows_;
  const Convex inside = clip_to_rectangle(polygon, -kShift, -kShift, w - kShift, h - kShift);
  for (std::size_t i = 0; i < inside.size(); ++i) {
    const Pixel p = inside[i], q = inside[(i + 1) % inside.size()];
    add_edge({std::clamp(p.x + kShift, 0.0, w), std::clamp(p.y + kShift, 0.0, h)},
             {std::clamp(q.x + kShift, 0.0, w), std::clamp(q.y + kShift, 0.0, h)}, colour);
  }
}

// An edge lights everything to its right, with the sign of its direction: the sum over a closed outline is its area.
// Each row receives differences, so that one running sum fills the interior.
void Canvas::add_edge(Pixel from, Pixel to, const Colour& colour) {
  if (from.y == to.y) return;
  const double sign = from.y < to.y ? -1 : 1;
  if (from.y > to.y) std::swap(from, to);
  const double slope = (to.x - from.x) / (to.y - from.y);
  const auto put = [&](std::size_t cell, double share) {
    for (std::size_t c = 0; c < 3; ++c) light_[3 * cell + c] += static_cast<float>(share * colour[c]);
  };
  const int last = std::min(static_cast<int>(to.y), rows_ - 1);
  for (int row = static_cast<int>(from.y); row <= last; ++row) {
    const double y0 = std::max<double>(row, from.y), y1 = std::min<double>(row + 1, to.y);
    if (y1 <= y0) continue;
    const double xa = from.x + (y0 - from.y) * slope, xb = from.x + (y1 - from.y) * slope;
    const double x0 = std::clamp(std::min(xa, xb), 0.0, columns_ - 2.0);
    const double x1 = std::clamp(std::max(xa, xb), x0, columns_ - 2.0);
    const double height = sign * (y1 - y0);
    const std::size_t start = static_cast<std::size_t>(row) * columns_;
    const int i0 = static_cast<int>(x0), i1 = static_cast<int>(x1);
    if (i0 == i1) {  // covered to the right of the edge's mean position
      const double right = i0 + 1 - 0.5 * (x0 + x1);
      put(start + i0, height * right);
      put(start + i0 + 1, height * (1 - right));
      continue;
    }
    const double per_px = height / (x1 - x0);  // height of the edge within one column
    // Area right of the edge up to x within the row: per_px * (x - x0)^2 / 2, linear beyond x1. Its second difference
    // at the columns' borders is what the pixels' first differences are.
    double previous = 0, before = 0;
    for (int i = i0; i <= i1 + 1; ++i) {
      const double x = i + 1;
      const double filled =
          x <= x1 ? 0.5 * per_px * (x - x0) * (x - x0) : 0.5 * per_px * (x1 - x0) * (x1 - x0) + height * (x - x1);
      const double pixel = filled - previous;
      put(start + i, pixel - before);
      before = pixel;
      previous = filled;
    }
  }
}

void Canvas::integrate() {
  for (int row = 0; row < rows_; ++row) {
    float* p = light_.data() + static_cast<std::size_t>(row) * columns_ * 3;
    float r = 0, g = 0, b = 0;
    for (int i = 0; i < columns_; ++i, p += 3) {
      p[0] = r += p[0];
      p[1] = g += p[1];
      p[2] = b += p[2];
    }
  }
}

// Separable, rows first; the result lies at the picture's own coordinates in the first width_ columns of blurred_.
void Canvas::blur() {
  static const std::array<float, 2 * kRadius + 1> k = blur_kernel();
  const std::size_t pitch = static_cast<std::size_t>(columns_) * 3, width = static_cast<std::size_t>(width_) * 3;
  for (int row = 0; row < rows_; ++row) {
    const float* in = light_.data() + row * pitch;
    float* out = blurred_.data() + row * pitch;
    for (std::size_t i = 0; i < width; ++i)
      out[i] = k[0] * in[i] + k[1] * in[i + 3] + k[2] * in[i + 6] + k[3] * in[i + 9] + k[4] * in[i + 12];
  }
  for (int row = 0; row < height_; ++row) {
    float* out = blurred_.data() + row * pitch;  // the row itself is read first, and by nobody after
    const float *a = out + pitch, *b = a + pitch, *c = b + pitch, *d = c + pitch;
    for (std::size_t i = 0; i < width; ++i)
      out[i] = k[0] * out[i] + k[1] * a[i] + k[2] * b[i] + k[3] * c[i] + k[4] * d[i];
  }
}

void Canvas::develop(double noise_levels, std::uint64_t noise_seed, std::uint8_t* rgb) {
  integrate();
  blur();
  const float sigma = static_cast<float>(noise_levels);
  std::uint64_t counter = mix(noise_seed);
  for (int row = 0; row < height_; ++row) {
    const float* in = blurred_.data() + static_cast<std::size_t>(row) * columns_ * 3;
    std::uint8_t* out = rgb + static_cast<std::size_t>(row) * width_ * 3;
    for (int i = 0; i < width_; ++i, in += 3, out += 3) {
      const std::uint64_t bits = mix(counter++);
      for (std::size_t c = 0; c < 3; ++c) {
        const float x = std::clamp(in[c], 0.0F, 1.0F) * static_cast<float>(kEncodingSteps);
        const std::size_t step = static_cast<std::size_t>(x);
        const float level = encoding_[step] + (x - static_cast<float>(step)) * (encoding_[step + 1] - encoding_[step]);
        const float noisy = level + sigma * normal_(bits >> (NormalTable::kBits * c)) + 0.5F;
        out[c] = static_cast<std::uint8_t>(std::clamp(noisy, 0.0F, 255.0F));
      }
    }
  }
}

}  // namespace accrete::hal::synthetic
