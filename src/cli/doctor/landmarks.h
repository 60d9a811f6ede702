// Points that can be found again in another image, whatever the calibration says. An edge shows only its motion across
// itself; whether the rows of two images agree takes points that are pinned down in both directions.
// docs/math/rig_checks.md
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "accrete/camera.h"
#include "accrete/image.h"

namespace accrete::cli {

struct GreyImage {
  int width_px = 0, height_px = 0;
  std::vector<std::uint8_t> pixels;

  [[nodiscard]] int at(int x, int y) const {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) + static_cast<std::size_t>(x)];
  }
};

[[nodiscard]] GreyImage to_grey(const ImageView& image);
// As seen in a mirror: columns exchanged, rows exchanged, or both.
[[nodiscard]] GreyImage mirrored(const GreyImage& image, bool columns, bool rows);

struct Landmark {
  int x = 0, y = 0;
  std::array<float, 64> descriptor{};  // 8 x 8 samples of the surroundings, mean zero, length one
  float brightness = 0;                // mean of the surroundings, grey levels
};

struct LandmarkImage {
  GreyImage grey;
  std::vector<Landmark> landmarks;
};

// The strongest corners (smaller eigenvalue of the structure tensor), at least 8 px apart, at most `most`.
[[nodiscard]] LandmarkImage find_landmarks(GreyImage image, std::size_t most = 500);

// The same spot in two images: where, and which landmarks.
struct Pair {
  Pixel a, b;  // b to a fraction of a pixel
  std::uint32_t index_a = 0, index_b = 0;
  float brightness_a = 0, brightness_b = 0;
};

// Landmarks that are each other's best partner anywhere in the other image, clearly better than the second best.
[[nodiscard]] std::vector<Pair> pair_landmarks(const LandmarkImage& a, const LandmarkImage& b);

}  // namespace accrete::cli
