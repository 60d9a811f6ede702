#include "predict/visibility.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/elementary.h"

namespace accrete {
namespace {

using Direction = std::array<float, 3>;

// Vertices of an icosahedron, (0, +-1, +-phi) and its rotations, and the 30 middles of its edges: (+-phi, 0, 0) and its
// rotations, and (+-1, +-phi^2, +-phi) / 2 and its rotations (not their mirror images). All unit length.
constexpr std::array<Direction, SeenDirections::kBins> make_directions() {
  std::array<Direction, SeenDirections::kBins> d{};
  std::size_t n = 0;
  const auto add_rotations = [&](float x, float y, float z) {
    d[n++] = {x, y, z};
    d[n++] = {z, x, y};
    d[n++] = {y, z, x};
  };
  constexpr float kA = 0.525731112F, kB = 0.850650808F;             // 1 and phi, normalised
  constexpr float kC = 0.309016994F, kD = 0.5F, kE = 0.809016994F;  // 1 / 2phi, 1/2, phi / 2
  for (const float s : {-1.0F, 1.0F}) {
    add_rotations(s, 0, 0);
    for (const float t : {-1.0F, 1.0F}) {
      add_rotations(0, s * kA, t * kB);
      for (const float u : {-1.0F, 1.0F}) add_rotations(s * kC, t * kE, u * kD);
    }
  }
  return d;
}
constexpr auto kDirections = make_directions();

float dot(const Direction& a, const Direction& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

float normal_cdf(float x) { return normal_cdf_of(x); }

}  // namespace

void SeenDirections::count(const std::array<float, 3>& toward_viewer, bool hit) {
  std::size_t best = 0;
  float best_dot = -2;
  for (std::size_t b = 0; b < kBins; ++b) {
    const float c = dot(kDirections[b], toward_viewer);
    if (c > best_dot) {
      best_dot = c;
      best = b;
    }
  }
  if (visits[best] == 16) {  // memory of about sixteen looks
    visits[best] /= 2;
    hits[best] /= 2;
  }
  ++visits[best];
  hits[best] = static_cast<std::uint8_t>(hits[best] + hit);
}

float face_probability(const SeenDirections& seen, const std::array<float, 3>& toward_viewer, float cos_psi,
                       float sigma_roll) {
  // Weight of a bin by the angle to it: 1 in the middle, 0.37 at 20 degrees, nothing beyond 45.
  float hits = 0, visits = 0;
  for (std::size_t b = 0; b < SeenDirections::kBins; ++b) {
    if (seen.visits[b] == 0) continue;
    const float c = dot(kDirections[b], toward_viewer);
    if (c < 0.7071F) continue;
    const float w = exp_of((c - 1) * 16.6F);
    hits += w * static_cast<float>(seen.hits[b]);
    visits += w * static_cast<float>(seen.visits[b]);
  }
  // A surface edge faces the viewer up to 70 degrees from its mean viewing direction, give or take 8; the logistic is
  // widened by what is not known of the roll.
  constexpr float kLimit = 70 * kPi / 180, kWidth = 8 * kPi / 180;
  const float width = kWidth * std::sqrt(1 + kPi * sigma_roll * sigma_roll / (8 * kWidth * kWidth));
  const float psi = acos_of(std::clamp(cos_psi, -1.0F, 1.0F));
  const float prior = 1 / (1 + exp_of((psi - kLimit) / width));
  return (hits + prior) / (visits + 1);
}

float inside_probability(const Camera& camera, const Mat3& R_a_c, double focal_px, float x_px, float y_px,
                         float sigma_px, float margin_px) {
  const Vec3 d = transposed(R_a_c) * Vec3{x_px / focal_px, y_px / focal_px, 1};
  if (!(d[2] > 1e-6)) return 0;
  const Result<Pixel> p = project(camera, {d[0] / d[2], d[1] / d[2]});
  if (!p.ok()) return 0;
  const auto x = static_cast<float>(p.value().x), y = static_cast<float>(p.value().y);
  const float right = static_cast<float>(camera.width_px - 1) - margin_px;
  const float bottom = static_cast<float>(camera.height_px - 1) - margin_px;
  const float s = std::max(sigma_px, 0.5F);  // half a pixel: the border itself is no sharper
  const float distance = std::min(std::min(x - margin_px, right - x), std::min(y - margin_px, bottom - y));
  if (distance > 4 * s) return 1;
  if (distance < -4 * s) return 0;
  return normal_cdf((x - margin_px) / s) * normal_cdf((right - x) / s) * normal_cdf((y - margin_px) / s) *
         normal_cdf((bottom - y) / s);
}

}  // namespace accrete
