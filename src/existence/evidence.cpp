#include "existence/evidence.h"

#include <algorithm>
#include <cmath>

#include "base/elementary.h"

namespace accrete::existence {

float probability(float log_odds) { return 1 / (1 + exp_of(-log_odds)); }

float log_odds(float probability) { return log_of(probability / (1 - probability)); }

namespace {

struct Change {
  float across_px, sine;
};

Change change(float x, float y, float c, float s, float x2, float y2, float c2, float s2) {
  const float dx = x2 - x, dy = y2 - y;
  return {std::fabs(-dx * s + dy * c), std::fabs(c * s2 - s * c2)};
}

}  // namespace

float deviations_apart(const View& a, const View& b, float sigma_n_px, float sigma_theta) {
  const Change l = change(a.x_l, a.y_l, a.c_l, a.s_l, b.x_l, b.y_l, b.c_l, b.s_l);
  const Change r = change(a.x_r, a.y_r, a.c_r, a.s_r, b.x_r, b.y_r, b.c_r, b.s_r);
  return std::max(std::max(l.across_px, r.across_px) / sigma_n_px, std::max(l.sine, r.sine) / sigma_theta);
}

float novelty(float deviations) {
  constexpr float kScale = 3;  // Delta_0 of METHOD 7.2
  const float d = deviations / kScale;
  return 1 - exp_of(-d * d);
}

float novelty(const View& last, const View& now, float sigma_n_px, float sigma_theta) {
  return novelty(deviations_apart(last, now, sigma_n_px, sigma_theta));
}

float displacement_px(const View& a, const View& b) {
  return std::max(hypot_of(a.x_l - b.x_l, a.y_l - b.y_l), hypot_of(a.x_r - b.x_r, a.y_r - b.y_r));
}

float updated_log_odds(float log_odds, float log_likelihood_ratio, float novelty_weight, float clamp) {
  // -2 .. 3: model errors and correlated evidence keep a single frame from deciding (METHOD 7.2, which says 2; a pair
  // of eyes that agree is worth more than one that misses: 3251 instead of 2614 confirmed on a drive of 51 frames).
  const float step = novelty_weight * std::clamp(log_likelihood_ratio, -2.0F, 3.0F);
  return std::clamp(log_odds + step, -clamp, clamp);
}

float predicted_visibility(float last, float face, float turned_rad) {
  // What was seen may go: one frame in ten whatever the geometry says (things in front move by themselves), and surely
  // where the surface turns away. What was hidden comes back as the view turns: kReturn is a third of a half turn,
  // about what a face needs to come round.
  constexpr float kReturn = 1.047F;
  const float goes = 1 - 0.9F * face;
  const float comes = face * (1 - exp_of(-turned_rad / kReturn));
  return last * (1 - goes) + (1 - last) * comes;
}

float corrected_visibility(float predicted, bool matched, float detection) {
  if (matched) return 1;
  return predicted * (1 - detection) / (1 - predicted * detection);
}

}  // namespace accrete::existence
