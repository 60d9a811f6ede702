#include "extract/localise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/angles.h"
#include "base/elementary.h"

namespace accrete::extract {
namespace {

struct Sample {
  float even, odd_x, odd_y;
};

// Between four pixels. Candidates are well inside: no coordinate is negative, and truncation is std::floor(), which
// SSE2 has not.
class Bilinear {
 public:
  Bilinear(const QuadratureFilter& f, float x, float y) {
    const int xi = static_cast<int>(x), yi = static_cast<int>(y);
    const float ax = x - static_cast<float>(xi), ay = y - static_cast<float>(yi);
    w00_ = (1 - ax) * (1 - ay), w01_ = ax * (1 - ay), w10_ = (1 - ax) * ay, w11_ = ax * ay;
    above_ = f.even(yi) + xi, below_ = f.even(yi + 1) + xi;
    step_ = f.plane_step();
  }
  [[nodiscard]] float even() const { return plane(0); }
  [[nodiscard]] float odd_x() const { return plane(1); }
  [[nodiscard]] float odd_y() const { return plane(2); }

 private:
  [[nodiscard]] float plane(std::size_t p) const {
    const float *a = above_ + p * step_, *b = below_ + p * step_;
    return w00_ * a[0] + w01_ * a[1] + w10_ * b[0] + w11_ * b[1];
  }
  float w00_, w01_, w10_, w11_;
  const float *above_, *below_;
  std::size_t step_;
};

[[nodiscard]] Sample sample(const QuadratureFilter& f, float x, float y) {
  const Bilinear at(f, x, y);
  return {at.even(), at.odd_x(), at.odd_y()};
}

// Orientation of the normal as a double angle, summed over a 3 x 3 grid turned into the edge's frame (METHOD 1.1):
// immune to the sign flip of the odd part across a line, where it vanishes in the middle.
struct DoubleAngle {
  float c = 0, s = 0;
  void add(float odd_x, float odd_y) {
    c += odd_x * odd_x - odd_y * odd_y;
    s += 2 * odd_x * odd_y;
  }
};
[[nodiscard]] DoubleAngle normal_around(const QuadratureFilter& f, float x, float y, float nx, float ny) {
  DoubleAngle sum;
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j) {
      const float fi = static_cast<float>(i), fj = static_cast<float>(j);
      const Bilinear at(f, x + fi * nx - fj * ny, y + fi * ny + fj * nx);
      sum.add(at.odd_x(), at.odd_y());
    }
  return sum;
}

// Share of the orientation variance in a 5 x 5 window: 0 along an edge, towards 1 at a junction (METHOD 1.3).
[[nodiscard]] float orientation_variance(const QuadratureFilter& f, int x, int y) {
  float c = 0, s = 0, w = 0;
  for (int dy = -2; dy <= 2; ++dy) {
    const float* ox = f.odd_x(y + dy);
    const float* oy = f.odd_y(y + dy);
    for (int dx = -2; dx <= 2; ++dx) {
      const float a = ox[x + dx], b = oy[x + dx];
      c += a * a - b * b;
      s += 2 * a * b;
      w += a * a + b * b;
    }
  }
  return w > 0 ? 1 - std::sqrt(c * c + s * s) / w : 1;
}

struct Crossing {
  float offset;
  float slope;  // of the even part (step) or its curvature (line), for the localisation noise
  bool found;
};

// Step-like: the zero crossing of the even part nearest to the candidate.
[[nodiscard]] Crossing zero_crossing(const std::array<float, 5>& even) {
  Crossing best{0, 0, false};
  for (int i = 0; i < 4; ++i) {
    const float a = even[static_cast<std::size_t>(i)], b = even[static_cast<std::size_t>(i) + 1];
    if ((a < 0) == (b < 0)) continue;
    const float offset = static_cast<float>(i) - 2 + a / (a - b);
    if (!best.found || std::fabs(offset) < std::fabs(best.offset)) best = {offset, std::fabs(b - a), true};
  }
  return best;
}

// Line-like: the extremum of the even part, by a parabola.
[[nodiscard]] Crossing extremum(const std::array<float, 5>& even) {
  const float sign = even[2] < 0 ? -1.0F : 1.0F;
  int peak = 2;
  for (int i = 1; i <= 3; ++i)
    if (sign * even[static_cast<std::size_t>(i)] > sign * even[static_cast<std::size_t>(peak)]) peak = i;
  const auto p = static_cast<std::size_t>(peak);
  const float a = sign * even[p - 1], b = sign * even[p], c = sign * even[p + 1];
  const float curvature = 2 * b - a - c;
  if (!(b >= a && b >= c && curvature > 0)) return {0, 0, false};
  return {static_cast<float>(peak) - 2 + 0.5F * (c - a) / curvature, curvature, true};
}

// How far along the edge, on both sides, its straightness is looked at (px); and the bend that makes it a corner.
constexpr float kBendReach = 2.0F;
constexpr float kMaxBend = 0.52F;  // rad (30 degrees): over 20 would refuse half of all candidates

// The largest angle between the orientations at -kBendReach, 0 and +kBendReach along the edge.
[[nodiscard]] float bend_along(const QuadratureFilter& f, float x, float y, float nx, float ny) {
  const float orientation = atan2_of(ny, nx);
  float turn[2] = {0, 0};
  for (int side = 0; side < 2; ++side) {
    const float t = side == 0 ? -kBendReach : kBendReach;
    DoubleAngle d;
    for (int i = -1; i <= 1; ++i) {
      const float fi = static_cast<float>(i);
      const Bilinear at(f, x + fi * nx - t * ny, y + fi * ny + t * nx);
      d.add(at.odd_x(), at.odd_y());
    }
    turn[side] = wrap_pi(0.5F * atan2_of(d.s, d.c) - orientation);
  }
  return std::max({std::fabs(turn[1] - turn[0]), std::fabs(turn[0]), std::fabs(turn[1])});
}

// How far the profile across the edge is from the symmetry of an isolated one, where a step's even part is
// antisymmetric and its odd part symmetric (a line's the other way round): neighbouring structure breaks it, and
// displaces the edge. Measured on a rendered box (docs/math/extraction.md): the error across the edge grows with it
// like 1 px times the asymmetry of the even part, or 2 px times that of the odd part.
[[nodiscard]] float asymmetry(const std::array<float, 5>& even, const std::array<float, 5>& odd, bool step) {
  const float sign = step ? 1.0F : -1.0F;
  const float e = std::fabs(even[0] + sign * even[4]) / (std::fabs(even[0]) + std::fabs(even[4]) + 1e-6F);
  const float amplitude = std::sqrt(even[2] * even[2] + odd[2] * odd[2]) + 1e-6F;
  const float o = std::fabs(odd[0] - sign * odd[4]) / amplitude;
  return std::max(e, 2 * o);
}

// Beyond this the crossing belongs to a neighbouring pixel's candidate.
constexpr float kMaxOffset = 1.5F;

}  // namespace

LocaliseOutcome localise(const QuadratureFilter& f, int x, int y, const ExtractParams& params, Localised& out) {
  const float variance = orientation_variance(f, x, y);
  const float amplitude0 = std::sqrt(f.energy(y)[x]);
  // A0 of METHOD 1.3: 2.5 times the noise amplitude of the triple.
  const float noise_amplitude = params.noise_sigma * std::sqrt(kEvenNorm * kEvenNorm + 2 * kOddNorm * kOddNorm);
  const float contrast = amplitude0 / (amplitude0 + 2.5F * noise_amplitude);
  out.confidence_i0d = 1 - contrast;
  out.confidence_i1d = contrast * (1 - variance);
  out.confidence_i2d = contrast * variance;
  if (out.confidence_i1d < params.min_confidence_i1d || out.confidence_i1d < out.confidence_i2d ||
      out.confidence_i1d < out.confidence_i0d)
    return LocaliseOutcome::kDimension;

  float px = static_cast<float>(x), py = static_cast<float>(y);
  DoubleAngle d;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) d.add(f.odd_x(y + dy)[x + dx], f.odd_y(y + dy)[x + dx]);
  float slope = 0, contamination = 0;
  bool step = true;
  for (int iteration = 0; iteration < 2; ++iteration) {
    const float psi = 0.5F * atan2_of(d.s, d.c);
    const auto [ny, nx] = sine_cosine(psi);
    std::array<float, 5> even{}, odd{};
    for (int i = 0; i < 5; ++i) {
      const float t = static_cast<float>(i - 2);
      const Sample q = sample(f, px + t * nx, py + t * ny);
      even[static_cast<std::size_t>(i)] = q.even;
      odd[static_cast<std::size_t>(i)] = q.odd_x * nx + q.odd_y * ny;
    }
    const float a2 = even[2] * even[2] + odd[2] * odd[2];
    if (iteration == 0) step = even[2] * even[2] < kStepLike * kStepLike * a2;
    const Crossing c = step ? zero_crossing(even) : extremum(even);
    if (!c.found || std::fabs(c.offset) > kMaxOffset) return LocaliseOutcome::kNoPeak;
    slope = c.slope;
    contamination = asymmetry(even, odd, step);
    px += c.offset * nx;
    py += c.offset * ny;
    if (std::fabs(px - static_cast<float>(x)) > 2 || std::fabs(py - static_cast<float>(y)) > 2)
      return LocaliseOutcome::kNoPeak;
    d = normal_around(f, px, py, nx, ny);
  }

  // A corner or a bend turns the orientation along the edge; its position and direction are then those of neither side.
  const float psi = 0.5F * atan2_of(d.s, d.c);
  const SineCosine<float> normal = sine_cosine(psi);
  const float bend = bend_along(f, px, py, normal.cosine, normal.sine);
  if (bend > kMaxBend) return LocaliseOutcome::kDimension;

  float theta = psi - kPi / 2;
  if (theta < 0) theta += kPi;
  if (theta >= kPi) theta -= kPi;
  const SineCosine<float> along = sine_cosine(theta);
  const float nx = -along.sine, ny = along.cosine;
  const auto phase_at = [&](float t) {
    const Sample q = sample(f, px + t * nx, py + t * ny);
    return atan2_of(q.odd_x * nx + q.odd_y * ny, q.even);
  };
  const Sample q = sample(f, px, py);
  const float odd = q.odd_x * nx + q.odd_y * ny;
  out.x_px = px;
  out.y_px = py;
  out.theta = theta;
  out.ux = along.cosine;
  out.uy = along.sine;
  out.amplitude = std::sqrt(q.even * q.even + q.odd_x * q.odd_x + q.odd_y * q.odd_y);
  out.phase = atan2_of(odd, q.even);
  out.phase_slope = wrap_two_pi(phase_at(0.5F) - phase_at(-0.5F));
  // Noise (docs/math/extraction.md): of the crossing, sigma_even / slope; of the parabola, sigma_even sqrt(1/2) /
  // curvature. Floors: what real images cannot beat (METHOD 1.4).
  const float sigma_even = params.noise_sigma * kEvenNorm;
  const float noise_n = sigma_even / slope * (step ? 1.0F : 0.7071F);
  // A bend of `bend` radians over 2 kBendReach px leaves its chord by a quarter of kBendReach times that.
  const float bend_n = 0.25F * kBendReach * bend;
  out.sigma_n_px = std::sqrt(params.floor_n_px * params.floor_n_px + noise_n * noise_n + bend_n * bend_n +
                             contamination * contamination);
  const float direction_strength = std::sqrt(std::sqrt(d.c * d.c + d.s * d.s) / 9);
  // Nine samples of a response that is correlated over 2 px: about three independent ones.
  const float noise_theta = params.noise_sigma * kOddNorm / (direction_strength * 1.732F);
  out.sigma_theta =
      std::sqrt(params.floor_theta * params.floor_theta + noise_theta * noise_theta + 0.25F * bend * bend);
  out.sigma_phase = std::max(0.25F, sigma_even / out.amplitude);  // METHOD 1.5
  return LocaliseOutcome::kOk;
}

}  // namespace accrete::extract
