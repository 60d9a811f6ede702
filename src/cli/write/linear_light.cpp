#include "cli/write/linear_light.h"

#include <array>
#include <cmath>

namespace accrete::cli {
namespace {

// IEC 61966-2-1. Estimates may leave 0..1 by their noise: the curve is continued, odd below zero.
struct Decoded {
  double value, slope;
};
Decoded decode_srgb(double encoded) {
  constexpr double kKnee = 0.04045, kDivisor = 12.92, kOffset = 0.055, kExponent = 2.4;
  const double c = std::abs(encoded);
  if (c <= kKnee) return {encoded / kDivisor, 1 / kDivisor};
  const double base = (c + kOffset) / (1 + kOffset);
  return {std::copysign(std::pow(base, kExponent), encoded), kExponent / (1 + kOffset) * std::pow(base, kExponent - 1)};
}

}  // namespace

Encoding encoding_of(const Params& params) {
  return params.extract.mixing_width_px > 0 ? Encoding::kSrgb : Encoding::kLinear;
}

Primitive3d in_linear_light(const Primitive3d& primitive, Encoding encoding) {
  Primitive3d p = primitive;
  if (encoding == Encoding::kLinear) return p;
  std::array<double, 7> slope{1};  // of the phase
  for (std::size_t k = 0; k < 6; ++k) {
    float& colour = k < 3 ? p.appearance.mean.left[k] : p.appearance.mean.right[k - 3];
    const Decoded d = decode_srgb(static_cast<double>(colour));
    colour = static_cast<float>(d.value);
    slope[k + 1] = d.slope;
  }
  for (std::size_t i = 0; i < 7; ++i)
    for (std::size_t j = i; j < 7; ++j) {
      float& c = p.appearance.covariance[packed_index(7, i, j)];
      c = static_cast<float>(slope[i] * slope[j] * static_cast<double>(c));
    }
  return p;
}

}  // namespace accrete::cli
