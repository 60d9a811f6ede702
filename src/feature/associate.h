// Which observation belongs to which expected feature of any kind: gates, likelihoods, and the one-to-one assignment
// that edges have (METHOD 6; docs/math/association.md, docs/math/features.md).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "associate/gate_kernel.h"
#include "associate/one_to_one.h"
#include "feature/filter.h"

namespace accrete::inline ACCRETE_ISA {
namespace feature {

// Quantile of chi-squared by Wilson and Hilferty (1931), `z` that of the normal distribution: right to 0.6 % at 99 %,
// and to 1.2 % at 99.9 % from six degrees of freedom on.
constexpr float chi_squared(int dof, double z) {
  const double a = 2.0 / (9.0 * dof), t = 1 - a + z * root_of_constant(a);
  return static_cast<float>(dof * t * t * t);
}
template <class F, int Eyes>
inline constexpr float kGate = chi_squared(F::residuals(Eyes), 2.3263);  // 99 %: geometry
template <class F, int Eyes>
inline constexpr float kGateAll = chi_squared(F::residuals(Eyes) + kAppearance<F>, 3.0902);  // 99.9 %: and appearance

// What one eye saw.
template <class F>
struct Observation {
  ViewOf<F, float> view;
  Appearances<F> appearance;
  float sigma_phase, sigma_colour;
  // log density of chance observations here: per px^2, of an edge per px across within its slide gate; and of chance
  // appearances like this one. Everything else is F::log_chance.
  float log_density, log_appearance;
};

template <class F>
using BothSeen = std::array<std::span<const Observation<F>>, 2>;  // of both eyes

// A feature that should be seen now.
template <class F>
struct Expected {
  Estimate<F, float> estimate;
  Appearances<F> mean, variance;   // predicted
  float visible, detection;        // P_vis, and p_d of one eye
  float independent_channels = 3;  // of the images' colours (associate/clutter.h)
};

using associate::Likelihood;
inline constexpr Likelihood kImpossible = {std::numeric_limits<float>::infinity(),
                                           -std::numeric_limits<float>::infinity()};

// log of the IPDA bracket, as log_match_likelihood of edges, for ratios of any size: when many dimensions fit, they are
// beyond the range of exp(), and must still be told apart.
template <int Eyes>
float log_match(float visible, float detection, float log_ratio) {
  if (log_ratio <= associate::kMaxLogRatio) return associate::log_match_likelihood<Eyes>(visible, detection, log_ratio);
  const float other = Eyes == 2 ? detection : 1 - detection;
  return std::max(log_of(associate::miss_likelihood(visible, detection)),
                  log_of(visible * detection * other) + log_ratio);
}

template <int M>
Likelihood gaussian(Symmetric<float, M> S, float* z) {
  float inverse[M], d2 = 0, log_det = 0;
  if (!cholesky<M>(S, S, inverse)) return kImpossible;
  solve_lower<M>(S, inverse, z);
  for (int m = 0; m < M; ++m) {
    d2 += z[m] * z[m];
    log_det += 2 * log_of(S(m, m));
  }
  return {d2, -0.5F * (d2 + log_det + static_cast<float>(M) * associate::kLogTwoPi)};
}

// Geometry. root: of the estimate's covariance.
template <Feature F, int Eyes>
Likelihood geometry_likelihood(const Expected<F>& e, const RootOf<F, float>& root, const Camera<float>* cameras,
                               const ViewOf<F, float>* seen) {
  constexpr int M = F::residuals(Eyes);
  auto sums = moments<F, Eyes>(e.estimate.x, root, cameras, seen);
  if (!sums.visible) return kImpossible;
  Symmetric<float, M> noise;
  F::template noise<Eyes>(seen, noise);
  return gaussian<M>(innovation_covariance(sums, noise), sums.central);
}

// Appearance, as associate::appearance_likelihood of an edge. Of several colours each counts for at most kSideGate:
// beyond an occluding contour the background changes. A single one must fit.
template <Feature F>
Likelihood appearance_likelihood(const Expected<F>& e, const Appearances<F>& seen, float sigma_phase,
                                 float sigma_colour) {
  const float share = e.independent_channels / 3;
  Likelihood out{0, 0};
  int changed = 0;
  for (std::size_t g = 0; g < F::kColours; ++g) {
    float d2 = 0, log_norm = 0;
    for (std::size_t i = F::kPhases + 3 * g; i < F::kPhases + 3 * g + 3; ++i) {
      const float v = e.variance[i] + sigma_colour * sigma_colour + associate::kColourFloor2, d = seen[i] - e.mean[i];
      d2 += d * d / v;
      log_norm += log_of(v) + associate::kLogTwoPi;
    }
    d2 *= share;
    changed += d2 > associate::kSideGate;
    if (F::kColours > 1) d2 = std::min(associate::kSideGate, d2);
    out.d2 += d2;
    out.log_g -= 0.5F * (d2 + log_norm * share);
  }
  for (std::size_t i = 0; i < F::kPhases; ++i) {
    const float v = e.variance[i] + sigma_phase * sigma_phase + associate::kFloorPhase2,
                d = wrap_phase(seen[i] - e.mean[i]);
    float d2 = d * d / v;
    if (changed < F::kColours) d2 = std::min(associate::kSideGate, d2);
    out.d2 += d2;
    out.log_g -= 0.5F * (d2 + log_of(v) + associate::kLogTwoPi);
  }
  return out;
}

// The mean of what both eyes saw: circular for a phase.
template <class F>
Appearances<F> mean_of(const Appearances<F>& a, const Appearances<F>& b) {
  Appearances<F> m;
  for (std::size_t i = 0; i < m.size(); ++i)
    m[i] = i < F::kPhases ? wrap_phase(a[i] + 0.5F * wrap_phase(b[i] - a[i])) : 0.5F * (a[i] + b[i]);
  return m;
}

template <class F>
struct Candidate {
  std::uint32_t index;
  std::uint8_t sense;
  ViewOf<F, float> view;  // in that sense
  float d2, log_g;
};

// Everything of one expected feature that does not depend on what was seen.
template <Feature F>
struct Search {
  const Expected<F>& expected;
  const Camera<float>* cameras;
  BothSeen<F> seen;
  RootOf<F, float> root;
  ViewOf<F, float> predicted[2];
  bool visible;

  Search(const Expected<F>& e, const Camera<float>* both, BothSeen<F> observations)
      : expected(e), cameras(both), seen(observations) {
    root = root_of<F>(e.estimate.P);
    visible = root.good && F::look(e.estimate.x, both[0], predicted[0]) && F::look(e.estimate.x, both[1], predicted[1]);
  }

  // Every observation of an eye that is near, in the description that fits best.
  [[nodiscard]] associate::NearestList<Candidate<F>> gather(std::size_t eye) const {
    associate::NearestList<Candidate<F>> list;
    for (std::uint32_t i = 0; i < seen[eye].size(); ++i) {
      Candidate<F> best{i, 0, {}, kImpossible.d2, kImpossible.log_g};
      for (int sense = 0; sense < F::kSenses; ++sense) {
        const ViewOf<F, float> view = F::described(seen[eye][i].view, sense);
        if (!F::near(predicted[eye], view)) continue;
        const Likelihood l = geometry_likelihood<F, 1>(expected, root, cameras + eye, &view);
        if (l.d2 < best.d2) best = {i, static_cast<std::uint8_t>(sense), view, l.d2, l.log_g};
      }
      if (best.d2 <= kGate<F, 2>) list.offer(best);  // a part of a residual never has more than the whole
    }
    return list;
  }

  [[nodiscard]] associate::HypothesisList hypotheses(std::uint32_t index) const {
    associate::HypothesisList list;
    if (!visible) return list;
    const auto l = gather(0), r = gather(1);
    const float log_miss = log_of(associate::miss_likelihood(expected.visible, expected.detection));
    const auto mono = [&](const Candidate<F>& c, std::size_t eye) {
      if (c.d2 > kGate<F, 1>) return;
      const Observation<F>& o = seen[eye][c.index];
      const Likelihood a =
          appearance_likelihood<F>(expected, F::described(o.appearance, c.sense), o.sigma_phase, o.sigma_colour);
      if (c.d2 + a.d2 > kGateAll<F, 1>) return;
      const float log_ratio = c.log_g + a.log_g - o.log_density - F::log_chance(1) - o.log_appearance;
      const float log_l = log_match<1>(expected.visible, expected.detection, log_ratio);
      associate::Hypothesis h{log_l - log_miss, log_l, index, associate::kNone, associate::kNone, 0, 0, c.d2};
      (eye == 0 ? h.left : h.right) = static_cast<std::int32_t>(c.index);
      (eye == 0 ? h.left_sense : h.right_sense) = c.sense;
      list.offer(h);
    };
    for (std::size_t i = 0; i < l.count; ++i) mono(l.item[i], 0);
    for (std::size_t i = 0; i < r.count; ++i) mono(r.item[i], 1);
    for (std::size_t i = 0; i < l.count; ++i)
      for (std::size_t j = 0; j < r.count; ++j) {
        const Candidate<F>&cl = l.item[i], &cr = r.item[j];
        const Observation<F>&ol = seen[0][cl.index], &orr = seen[1][cr.index];
        const ViewOf<F, float> views[2] = {cl.view, cr.view};
        const Likelihood g = geometry_likelihood<F, 2>(expected, root, cameras, views);
        if (g.d2 > kGate<F, 2>) continue;
        const Appearances<F> both =
            mean_of<F>(F::described(ol.appearance, cl.sense), F::described(orr.appearance, cr.sense));
        const Likelihood a = appearance_likelihood<F>(expected, both, 0.5F * (ol.sigma_phase + orr.sigma_phase),
                                                      0.5F * (ol.sigma_colour + orr.sigma_colour));
        if (g.d2 + a.d2 > kGateAll<F, 2>) continue;
        const float log_ratio =
            g.log_g + a.log_g - ol.log_density - orr.log_density - F::log_chance(2) - ol.log_appearance;
        const float log_l = log_match<2>(expected.visible, expected.detection, log_ratio);
        list.offer({log_l - log_miss, log_l, index, static_cast<std::int32_t>(cl.index),
                    static_cast<std::int32_t>(cr.index), cl.sense, cr.sense, g.d2});
      }
    return list;
  }
};

// Do two views of one eye lie within `limit_px` of each other, across an edge or altogether?
template <Feature F>
bool is_close(const ViewOf<F, float>& a, const ViewOf<F, float>& b, float limit_px) {
  float r[F::residuals(1)];
  F::template difference<1>(&a, &b, r);
  for (int m = 0; m < F::kAcross; ++m)
    if (!(std::fabs(r[m]) <= limit_px)) return false;
  return true;
}

// `hypotheses` has room for kPerExpected per expected feature, an owner for every observation of its eye;
// out.size() == expected.size().
template <Feature F>
void associate_features(std::span<const Expected<F>> expected, const Camera<float>* cameras, BothSeen<F> seen,
                        std::span<associate::Hypothesis> hypotheses, std::span<std::int32_t> left_owner,
                        std::span<std::int32_t> right_owner, std::span<associate::Association> out) {
  constexpr float kOther = 1.0F;  // px, as of contours (associate/associate.cpp)
  std::fill(left_owner.begin(), left_owner.end(), associate::kNone);
  std::fill(right_owner.begin(), right_owner.end(), associate::kNone);
  std::size_t n = 0;
  for (std::uint32_t i = 0; i < expected.size(); ++i) {
    const Search<F> search(expected[i], cameras, seen);
    const auto apart = [&](std::int32_t a, std::int32_t b, std::size_t eye) {
      if (a == associate::kNone || b == associate::kNone || a == b) return false;
      return !is_close<F>(seen[eye][static_cast<std::size_t>(a)].view, seen[eye][static_cast<std::size_t>(b)].view,
                          kOther);
    };
    associate::collect(
        search.hypotheses(i), log_of(associate::miss_likelihood(expected[i].visible, expected[i].detection)),
        [&](const associate::Hypothesis& a, const associate::Hypothesis& b) {
          return apart(a.left, b.left, 0) || apart(a.right, b.right, 1);
        },
        out[i], hypotheses, n);
  }
  associate::assign_one_to_one(hypotheses.first(n), left_owner, right_owner, out,
                               [&](std::uint32_t winner, std::uint32_t loser) {
                                 ViewOf<F, float> a, b;
                                 for (int eye = 0; eye < 2; ++eye) {
                                   (void)F::look(expected[winner].estimate.x, cameras[eye], a);
                                   (void)F::look(expected[loser].estimate.x, cameras[eye], b);
                                   if (!is_close<F>(a, b, kOther)) return false;
                                 }
                                 return true;
                               });
}

}  // namespace feature
}  // namespace accrete::inline ACCRETE_ISA
