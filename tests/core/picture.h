// Images painted by a formula, and extraction from them: what the tests of the stages share.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "extract/extract.h"
#include "kernels/kernels.h"

namespace accrete::test {

// A generator whose numbers are the same with every standard library.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed * 2 + 1) {}

  std::uint64_t bits() {  // splitmix64
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15U);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
  }
  double uniform(double low = 0, double high = 1) {
    return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1p-53;
  }
  double normal(double sigma = 1) {  // Box-Muller
    const double r = std::sqrt(-2 * std::log(1 - uniform()));
    return sigma * r * std::cos(2 * 3.14159265358979323846 * uniform());
  }
  bool chance(double probability) { return uniform() < probability; }
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(bits() % n); }

 private:
  std::uint64_t state_;
};

using Rgb = std::array<double, 3>;  // 0 .. 255

struct Picture {
  int width = 0, height = 0;
  PixelFormat format = PixelFormat::kGrey8;
  std::vector<std::uint8_t> data;

  [[nodiscard]] ImageView view() const {
    return {data.data(), width, height, std::ptrdiff_t{width} * channels(format), format};
  }
  [[nodiscard]] std::uint8_t* at(int x, int y) {
    return data.data() + (std::ptrdiff_t{y} * width + x) * channels(format);
  }
};

inline std::uint8_t level(double v) { return static_cast<std::uint8_t>(std::lround(std::fmin(255, std::fmax(0, v)))); }

// `colour(x, y)` is the value at a pixel's centre; sigma_noise in grey levels, independent per channel.
inline Picture paint(int width, int height, PixelFormat format, const std::function<Rgb(double, double)>& colour,
                     double sigma_noise = 0, std::uint64_t seed = 1) {
  Picture p{width, height, format, {}};
  p.data.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                static_cast<std::size_t>(channels(format)));
  Dice dice(seed);
  const auto noise = [&] { return sigma_noise > 0 ? dice.normal(sigma_noise) : 0; };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Rgb c = colour(x, y);
      std::uint8_t* out = p.at(x, y);
      if (format == PixelFormat::kGrey8) {
        out[0] = level(c[0] + noise());
        continue;
      }
      for (std::size_t k = 0; k < 3; ++k) out[format == PixelFormat::kRgb8 ? k : 2 - k] = level(c[k] + noise());
    }
  return p;
}
inline Picture paint_grey(int width, int height, const std::function<double(double, double)>& value,
                          double sigma_noise = 0, std::uint64_t seed = 1) {
  return paint(
      width, height, PixelFormat::kGrey8,
      [&](double x, double y) {
        const double v = value(x, y);
        return Rgb{v, v, v};
      },
      sigma_noise, seed);
}

// A straight edge: through (x, y), direction theta. side() is the distance along the right-hand normal.
struct Line {
  double x, y, theta;

  [[nodiscard]] double side(double px, double py) const {
    return -(px - x) * std::sin(theta) + (py - y) * std::cos(theta);
  }
  [[nodiscard]] double along(double px, double py) const {
    return (px - x) * std::cos(theta) + (py - y) * std::sin(theta);
  }
};

// 0 .. 1 over a blur of deviation sigma.
inline double smooth_step(double d, double sigma) { return 0.5 * std::erfc(-d / (sigma * std::sqrt(2.0))); }

// A pinhole camera without distortion; its aligned image is its raw one, moved to the principal point.
inline Camera plain_camera(int width, int height, double focal = 400) {
  Camera c;
  c.width_px = width;
  c.height_px = height;
  c.fx_px = c.fy_px = focal;
  c.cx_px = 0.5 * width;
  c.cy_px = 0.5 * height;
  return c;
}

// Extraction with memory of its own; remembers the previous image, as a pipeline does.
class Extractor {
 public:
  Extractor(int width, int height, std::size_t capacity = 4096)
      : camera_(plain_camera(width, height)),
        rows_(extract::kChannels * extract::quadrature_floats(static_cast<std::size_t>(width))),
        cells_(extract::cells_per_band(static_cast<std::size_t>(width))),
        previous_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)),
        out_(capacity) {}

  std::span<const Primitive2d> operator()(const Picture& picture, const ExtractParams& params = {}) {
    counts = {};
    extract::Scratch scratch{rows_, cells_, previous_, has_previous_};
    const std::size_t n =
        extract::extract(picture.view(), params, {&camera_, {1, 0, 0, 0, 1, 0, 0, 0, 1}, camera_.fx_px},
                         kernels(InstructionSet::kBest).rows, scratch, out_, counts);
    has_previous_ = scratch.has_previous;
    return std::span<const Primitive2d>(out_).first(n);
  }

  ExtractCounts counts;

 private:
  Camera camera_;
  std::vector<float> rows_;
  std::vector<extract::Cell> cells_;
  std::vector<std::uint8_t> previous_;
  std::vector<Primitive2d> out_;
  bool has_previous_ = false;
};

}  // namespace accrete::test
