#include "associate/gate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angles.h"
#include "base/elementary.h"

namespace accrete::associate {
namespace {

constexpr float kLogTwoPi = 1.83787707F;

// d2 and log density of a small Gaussian by Cholesky in place. S: full symmetric N x N, lower triangle used.
template <int N>
Likelihood gaussian(float (&S)[N][N], float (&z)[N]) {
  float log_det = 0, d2 = 0;
  for (int j = 0; j < N; ++j) {
    float d = S[j][j];
    for (int k = 0; k < j; ++k) d -= S[j][k] * S[j][k];
    if (!(d > 1e-20F)) return {std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};
    const float l = std::sqrt(d);
    S[j][j] = l;
    log_det += 2 * log_of(l);
    for (int i = j + 1; i < N; ++i) {
      float s = S[i][j];
      for (int k = 0; k < j; ++k) s -= S[i][k] * S[j][k];
      S[i][j] = s / l;
    }
    float v = z[j];
    for (int k = 0; k < j; ++k) v -= S[j][k] * z[k];
    z[j] = v / l;
    d2 += z[j] * z[j];
  }
  return {d2, -0.5F * (d2 + log_det + static_cast<float>(N) * kLogTwoPi)};
}

// Element (i, j) of the state-induced covariance after each eye's normal offset has been moved along its line by the
// slide: n(slide) = n + slide * theta, both being errors of the prediction (a line that turns leaves the point at
// distance `slide` by that much).
struct Shifted {
  const PredictedObservation& p;
  float slide[2];

  [[nodiscard]] float base(int i, int j) const {
    return p.covariance[packed_index(4, static_cast<std::size_t>(std::min(i, j)),
                                     static_cast<std::size_t>(std::max(i, j)))];
  }
  [[nodiscard]] float operator()(int i, int j) const {
    const bool ni = (i & 1) == 0, nj = (j & 1) == 0;
    float v = base(i, j);
    if (ni) v += slide[i / 2] * base(i + 1, j);
    if (nj) v += slide[j / 2] * base(i, j + 1);
    if (ni && nj) v += slide[i / 2] * slide[j / 2] * base(i + 1, j + 1);
    return v;
  }
};

}  // namespace

Residual residual(float x, float y, float c, float s, const LineElement& observed) {
  const float dx = observed.x_px - x, dy = observed.y_px - y;
  const float cosine = c * observed.c + s * observed.s;
  const float sine = c * observed.s - s * observed.c;
  return {-dx * s + dy * c, cosine < 0 ? -sine : sine, dx * c + dy * s, cosine < 0};
}

Likelihood stereo_likelihood(const PredictedObservation& p, const Residual& rl, const LineElement& l,
                             const Residual& rr, const LineElement& r, const Noise& noise) {
  const Shifted shifted{p, {rl.slide_px, rr.slide_px}};
  float S[4][4];
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j <= i; ++j) S[i][j] = shifted(i, j);
  S[0][0] += l.sigma_n_px * l.sigma_n_px + noise.variance_n_px2;
  S[1][1] += l.sigma_theta * l.sigma_theta + noise.variance_theta;
  S[2][2] += r.sigma_n_px * r.sigma_n_px + noise.variance_n_px2;
  S[3][3] += r.sigma_theta * r.sigma_theta + noise.variance_theta;
  float z[4] = {rl.n_px, rl.sine, rr.n_px, rr.sine};
  return gaussian(S, z);
}

Likelihood mono_likelihood(const PredictedObservation& p, int eye, const Residual& r, const LineElement& observed,
                           const Noise& noise) {
  const Shifted shifted{p, {eye == 0 ? r.slide_px : 0, eye == 1 ? r.slide_px : 0}};
  const int n = 2 * eye;
  float S[2][2];
  S[0][0] = shifted(n, n) + observed.sigma_n_px * observed.sigma_n_px + noise.variance_n_px2;
  S[1][0] = shifted(n + 1, n);
  S[1][1] = shifted(n + 1, n + 1) + observed.sigma_theta * observed.sigma_theta + noise.variance_theta;
  float z[2] = {r.n_px, r.sine};
  return gaussian(S, z);
}

Likelihood appearance_likelihood(const Appearance& mean, const float variance[7], const Appearance& seen,
                                 float sigma_phase, float sigma_colour, float independent_channels) {
  constexpr float kFloorPhase2 = 0.35F * 0.35F;
  const float share = independent_channels / 3;
  Likelihood out{0, 0};
  int changed = 0;  // sides
  for (std::size_t side = 0; side < 2; ++side) {
    float d2 = 0, log_norm = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const float v = variance[1 + 3 * side + c] + sigma_colour * sigma_colour + kColourFloor2;
      const float d = side == 0 ? seen.left[c] - mean.left[c] : seen.right[c] - mean.right[c];
      d2 += d * d / v;
      log_norm += log_of(v) + kLogTwoPi;
    }
    d2 *= share;
    changed += d2 > kSideGate;
    d2 = std::min(kSideGate, d2);
    out.d2 += d2;
    out.log_g -= 0.5F * (d2 + log_norm * share);
  }
  const float vp = variance[0] + sigma_phase * sigma_phase + kFloorPhase2;
  const float dp = wrap_two_pi(seen.phase - mean.phase);
  float d2 = dp * dp / vp;
  if (changed < 2) d2 = std::min(kSideGate, d2);
  out.d2 += d2;
  out.log_g -= 0.5F * (d2 + log_of(vp) + kLogTwoPi);
  return out;
}

}  // namespace accrete::associate
