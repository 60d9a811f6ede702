// Light on a sensor: exact area coverage of convex polygons, then the lens, the encoding and the noise.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "synthetic/polygon.h"
#include "synthetic/random.h"

namespace accrete::hal::synthetic {

using Colour = std::array<double, 3>;  // linear light, 0..1

// sRGB (IEC 61966-2-1) of linear light, both 0..1.
[[nodiscard]] double encode_srgb(double linear);

class Canvas {
 public:
  Canvas(int width_px, int height_px);

  void clear();
  // Adds light on the area of the polygon; a negative colour takes it away. Pixel centres at integers.
  void add(const Convex& polygon, const Colour& colour);
  // Blur, encoding, noise: RGB, rows without padding. Ends what add() collected; clear() begins the next picture.
  void develop(double noise_levels, std::uint64_t noise_seed, std::uint8_t* rgb);

 private:
  void add_edge(Pixel from, Pixel to, const Colour& colour);
  void integrate();
  void blur();

  int width_, height_;        // of the picture
  int columns_, rows_;        // with a margin as wide as the blur, and one column where the last pixel spills
  std::vector<float> light_;  // first differences along the row of what the pixels hold; later the pixels
  std::vector<float> blurred_;
  std::vector<float> encoding_;  // linear light to grey levels
  NormalTable normal_;
};

}  // namespace accrete::hal::synthetic
