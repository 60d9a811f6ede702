#include "existence/static_hypothesis.h"

#include <algorithm>
#include <cmath>

#include "base/elementary.h"
#include "existence/evidence.h"

namespace accrete::existence {
namespace {

// Best log(g / beta) of one eye at the place of birth, or -infinity.
float best_log_ratio(float x, float y, float c, float s, const Appearance& mean, const associate::EyeView& view) {
  float best = -1e9F;
  view.grid->near(x, y, associate::kSlideGate, [&](std::uint16_t i) {
    const Primitive2d& p = view.primitives[i];
    const associate::Residual r = associate::residual(x, y, c, s, p.aligned);
    if (std::fabs(r.slide_px) > associate::kSlideGate || std::fabs(r.sine) > 0.5F) return;
    // The difference of two observations of one edge: twice the variance of one.
    const float vn = 2 * p.aligned.sigma_n_px * p.aligned.sigma_n_px;
    const float va = 2 * p.aligned.sigma_theta * p.aligned.sigma_theta;
    const float d2 = r.n_px * r.n_px / vn + r.sine * r.sine / va;
    if (d2 > associate::kGate4) return;
    const Appearance seen = r.reversed ? reversed(p.appearance) : p.appearance;
    constexpr float kVariance[7] = {};
    const associate::Likelihood a = associate::appearance_likelihood(
        mean, kVariance, seen, 1.4142F * p.sigma_phase, 1.4142F * p.sigma_colour, view.clutter->independent_channels);
    const float log_g = -0.5F * (d2 + log_of(vn * va)) - 1.837877F + a.log_g;
    best = std::max(best, log_g - view.clutter->log_geometry(i) - view.clutter->log_appearance(seen));
  });
  return best;
}

}  // namespace

float static_log_ratio(const Track& track, const Appearance& mean, const associate::EyeView& left,
                       const associate::EyeView& right, float detection) {
  const View& b = track.birth;
  const float l = exp_of(std::min(best_log_ratio(b.x_l, b.y_l, b.c_l, b.s_l, mean, left), 30.0F));
  const float r = exp_of(std::min(best_log_ratio(b.x_r, b.y_r, b.c_r, b.s_r, mean, right), 30.0F));
  const float q = 1 - detection;
  return log_of((q + detection * l) * (q + detection * r));
}

bool distinguishable(const Track& track, const View& now, float sigma_n_px, float sigma_theta) {
  return deviations_apart(track.birth, now, sigma_n_px, sigma_theta) > 3;
}

}  // namespace accrete::existence
