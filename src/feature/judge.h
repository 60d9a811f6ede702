// What one look does to the existence of a feature of any kind: how new the view is, and whether it stands still in the
// image instead; the test itself is existence/judge.h, and the n-scan criterion with it.
#pragma once

#include <algorithm>
#include <cmath>

#include "existence/evidence.h"
#include "existence/judge.h"
#include "feature/associate.h"

namespace accrete::inline ACCRETE_ISA {
namespace feature {

// What both eyes saw or should see, as it is kept of a feature.
template <class F>
using BothViews = std::array<ViewOf<F, float>, 2>;

// Distance of two views in deviations, at the residual where it is most (as existence::deviations_apart of edges). The
// deviations are those of `observed`: views by look() have none.
template <Feature F>
float deviations_apart(const BothViews<F>& last, const BothViews<F>& now, const BothViews<F>& observed) {
  constexpr int M = F::residuals(2);
  float r[M], most = 0;
  Symmetric<float, M> noise;
  F::template difference<2>(now.data(), last.data(), r);
  F::template noise<2>(observed.data(), noise);
  for (int m = 0; m < M; ++m) most = std::max(most, std::fabs(r[m]) / std::sqrt(std::max(noise(m, m), 1e-12F)));
  return most;
}

// log of the bracket of the rival motion, which leaves the feature where its eyes saw it first (METHOD 8).
template <Feature F>
float static_log_ratio(const Expected<F>& e, const BothViews<F>& birth, BothSeen<F> seen) {
  constexpr int M = F::residuals(1);
  constexpr float kRootTwo = 1.41421356F;  // the difference of two observations: twice the variance of one
  const float q = 1 - e.detection;
  float ratio = 1;
  for (std::size_t eye = 0; eye < 2; ++eye) {
    float best = -1e9F;
    for (const Observation<F>& o : seen[eye])
      for (int sense = 0; sense < F::kSenses; ++sense) {
        const ViewOf<F, float> view = F::described(o.view, sense);
        if (!F::near(birth[eye], view)) continue;
        float r[M];
        Symmetric<float, M> noise;
        F::template difference<1>(&birth[eye], &view, r);
        F::template noise<1>(&view, noise);
        for (float& v : noise.v) v *= 2;
        const Likelihood g = gaussian<M>(noise, r);
        if (g.d2 > kGate<F, 2>) continue;
        const Likelihood a = appearance_likelihood<F>(e, F::described(o.appearance, sense), kRootTwo * o.sigma_phase,
                                                      kRootTwo * o.sigma_colour);
        best = std::max(best, g.log_g + a.log_g - o.log_density - F::log_chance(1) - o.log_appearance);
      }
    ratio *= q + e.detection * exp_of(std::min(best, associate::kMaxLogRatio));
  }
  return log_of(ratio);
}

// What is kept of a feature beside its estimate.
template <class F>
struct History {
  Track track;
  BothViews<F> birth;    // as observed
  BothViews<F> counted;  // predicted when evidence was last counted; at first the birth
};

template <Feature F>
existence::Verdict judge(History<F>& history, const associate::Association& association, const Expected<F>& expected,
                         const Camera<float>* cameras, BothSeen<F> seen, const std::array<float, 3>& toward_viewer,
                         std::uint32_t frame, const ExistenceParams& params) {
  BothViews<F> now;
  for (std::size_t eye = 0; eye < 2; ++eye)
    if (!F::look(expected.estimate.x, cameras[eye], now[eye])) return existence::Verdict::kUndecided;
  existence::Evidence evidence{};
  evidence.outcome = association.outcome;
  evidence.log_likelihood_ratio = association.log_likelihood_ratio;
  evidence.visible = expected.visible;
  evidence.detection = expected.detection;
  evidence.distinguishable =
      expected.visible > 0.5F && deviations_apart<F>(history.birth, now, history.birth) > 3;  // METHOD 8
  if (evidence.distinguishable) evidence.static_log_ratio = static_log_ratio<F>(expected, history.birth, seen);
  evidence.toward_viewer = toward_viewer;
  evidence.frame = frame;
  const float novelty = existence::novelty(deviations_apart<F>(history.counted, now, history.birth));
  const existence::Judgement judgement = existence::judge(history.track, evidence, novelty, params);
  if (judgement.counted) history.counted = now;
  return judgement.verdict;
}

}  // namespace feature
}  // namespace accrete::inline ACCRETE_ISA
