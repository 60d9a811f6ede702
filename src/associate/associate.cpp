#include "associate/associate.h"

#include <algorithm>
#include <cmath>

#include "base/elementary.h"

namespace accrete::associate {
namespace {

constexpr float kLogThree = 1.0986F;   // METHOD 6.4: the margin below which two contours are ambiguous
constexpr float kOtherContour = 1.0F;  // px of normal offset between observations of different contours
constexpr float kMaxAcross = 16.0F;    // px: wider gates are not searched; their likelihood is below any clutter's

struct Candidate {
  std::uint16_t index;
  Residual residual;
  Likelihood mono;
};

struct CandidateList {
  static constexpr std::size_t kMax = 8;
  std::array<Candidate, kMax> item;
  std::size_t count = 0;

  void offer(const Candidate& c) {
    if (count < kMax) {
      item[count++] = c;
      return;
    }
    auto worst = std::max_element(item.begin(), item.end(),
                                  [](const Candidate& a, const Candidate& b) { return a.mono.d2 < b.mono.d2; });
    if (c.mono.d2 < worst->mono.d2) *worst = c;
  }
};

CandidateList gather(const Expected& e, const EyeView& view, int eye) {
  const PredictedObservation& p = e.predicted;
  const float x = eye == 0 ? p.x_l : p.x_r, y = eye == 0 ? p.y_l : p.y_r;
  const float c = eye == 0 ? p.c_l : p.c_r, s = eye == 0 ? p.s_l : p.s_r;
  const float variance = p.covariance[packed_index(4, eye == 0 ? 0 : 2, eye == 0 ? 0 : 2)] + e.noise.variance_n_px2;
  const float across = std::min(kMaxAcross, 3.7F * std::sqrt(variance + 0.25F));  // sqrt(kGate4), and 0.5 px of noise
  CandidateList list;
  view.grid->near(x, y, std::max(across, kSlideGate), [&](std::uint16_t i) {
    const LineElement& o = view.primitives[i].aligned;
    const Residual r = residual(x, y, c, s, o);
    if (std::fabs(r.slide_px) > kSlideGate || std::fabs(r.n_px) > across) return;
    if (std::fabs(r.sine) > 0.7F) return;  // 45 degrees: beyond, the sine no longer measures the angle
    const Likelihood l = mono_likelihood(p, eye, r, o, e.noise);
    if (l.d2 <= kGate4) list.offer({i, r, l});
  });
  return list;
}

Appearance in_sense(const Primitive2d& p, bool is_reversed) {
  return is_reversed ? accrete::reversed(p.appearance) : p.appearance;
}

// Circular mean of the phases, mean of the colours.
Appearance mean_of(const Appearance& a, const Appearance& b) {
  Appearance m;
  m.phase = atan2_of(sin_of(a.phase) + sin_of(b.phase), cos_of(a.phase) + cos_of(b.phase));
  for (std::size_t c = 0; c < 3; ++c) {
    m.left[c] = 0.5F * (a.left[c] + b.left[c]);
    m.right[c] = 0.5F * (a.right[c] + b.right[c]);
  }
  return m;
}

// The IPDA bracket for two eyes that detect independently, given that the edge is visible (METHOD 7.2).
struct Bracket {
  float visible, detection;

  [[nodiscard]] float miss() const {
    const float q = 1 - detection * 0.99F;  // 0.99: gate probability
    return 1 - visible + visible * q * q;
  }
  [[nodiscard]] float with_mono(float ratio) const { return miss() + visible * detection * (1 - detection) * ratio; }
  [[nodiscard]] float with_stereo(float ratio) const { return miss() + visible * detection * detection * ratio; }
};

// exp() of anything above this is clipped long before it is used.
float ratio_of(float log_ratio) { return exp_of(std::min(log_ratio, 30.0F)); }

class HypothesisList {
 public:
  void offer(const Hypothesis& h) {
    if (count_ == item_.size() && h.gain <= item_[count_ - 1].gain) return;
    std::size_t at = std::min(count_, item_.size() - 1);
    for (; at > 0 && item_[at - 1].gain < h.gain; --at) item_[at] = item_[at - 1];
    item_[at] = h;
    count_ = std::min(count_ + 1, item_.size());
  }
  [[nodiscard]] std::span<const Hypothesis> items() const { return std::span(item_).first(count_); }

 private:
  std::array<Hypothesis, kPerExpected> item_;
  std::size_t count_ = 0;
};

void mark_explained(Explained& e, std::uint16_t right) {
  for (std::size_t k = 0; k < e.count; ++k)
    if (e.right[k] == right) return;
  if (e.count < Explained::kMax) e.right[e.count++] = right;
}

HypothesisList hypotheses_of(std::uint32_t index, const Expected& e, const EyeView& left, const EyeView& right,
                             std::span<Explained> explained) {
  const CandidateList l = gather(e, left, 0), r = gather(e, right, 1);
  const Bracket bracket{e.visible, e.detection};
  const float log_miss = log_of(bracket.miss());
  HypothesisList list;
  const auto mono = [&](const Candidate& c, const EyeView& view, bool is_left) {
    if (c.mono.d2 > kGate2) return;
    const Primitive2d& p = view.primitives[c.index];
    const Appearance seen = in_sense(p, c.residual.reversed);
    const Likelihood a = appearance_likelihood(e.mean, e.variance, seen, p.sigma_phase, p.sigma_colour,
                                               view.clutter->independent_channels);
    if (c.mono.d2 + a.d2 > kGateAll2) return;
    const float log_ratio = c.mono.log_g + a.log_g - view.clutter->log_geometry(view.primitives, c.index) -
                            view.clutter->log_appearance(seen);
    const float log_l = log_of(bracket.with_mono(ratio_of(log_ratio)));
    list.offer({log_l - log_miss, log_l, index, is_left ? c.index : kNone, is_left ? kNone : c.index,
                is_left && c.residual.reversed, !is_left && c.residual.reversed, c.mono.d2});
  };
  for (std::size_t i = 0; i < l.count; ++i) mono(l.item[i], left, true);
  for (std::size_t i = 0; i < r.count; ++i) mono(r.item[i], right, false);
  for (std::size_t i = 0; i < l.count; ++i)
    for (std::size_t j = 0; j < r.count; ++j) {
      const Candidate &cl = l.item[i], &cr = r.item[j];
      const Primitive2d &pl = left.primitives[cl.index], &pr = right.primitives[cr.index];
      const Likelihood g = stereo_likelihood(e.predicted, cl.residual, pl.aligned, cr.residual, pr.aligned, e.noise);
      if (g.d2 > kGate4) continue;
      const Appearance seen = mean_of(in_sense(pl, cl.residual.reversed), in_sense(pr, cr.residual.reversed));
      const Likelihood a =
          appearance_likelihood(e.mean, e.variance, seen, 0.5F * (pl.sigma_phase + pr.sigma_phase),
                                0.5F * (pl.sigma_colour + pr.sigma_colour), left.clutter->independent_channels);
      if (g.d2 + a.d2 > kGateAll4) continue;
      mark_explained(explained[cl.index], cr.index);
      const float log_ratio = g.log_g + a.log_g - left.clutter->log_geometry(left.primitives, cl.index) -
                              right.clutter->log_geometry(right.primitives, cr.index) -
                              left.clutter->log_appearance(seen);
      const float log_l = log_of(bracket.with_stereo(ratio_of(log_ratio)));
      list.offer(
          {log_l - log_miss, log_l, index, cl.index, cr.index, cl.residual.reversed, cr.residual.reversed, g.d2});
    }
  return list;
}

bool different_contours(const Expected& e, const Hypothesis& a, const Hypothesis& b, const EyeView& left,
                        const EyeView& right) {
  const PredictedObservation& p = e.predicted;
  const auto offset = [](float x, float y, float c, float s, const LineElement& o) {
    return residual(x, y, c, s, o).n_px;
  };
  const auto apart = [&](std::int32_t i, std::int32_t j, const EyeView& view, float x, float y, float c, float s) {
    if (i == kNone || j == kNone || i == j) return false;
    const auto& p1 = view.primitives[static_cast<std::size_t>(i)].aligned;
    const auto& p2 = view.primitives[static_cast<std::size_t>(j)].aligned;
    return std::fabs(offset(x, y, c, s, p1) - offset(x, y, c, s, p2)) > kOtherContour;
  };
  return apart(a.left, b.left, left, p.x_l, p.y_l, p.c_l, p.s_l) ||
         apart(a.right, b.right, right, p.x_r, p.y_r, p.c_r, p.s_r);
}

// Do two expected primitives lie on the same contour in both images? Then losing an observation to the other says
// nothing about existence.
bool same_contour(const Expected& a, const Expected& b) {
  const auto off_line = [](float x, float y, float c, float s, float qx, float qy) {
    return std::fabs(-(qx - x) * s + (qy - y) * c);
  };
  const PredictedObservation &p = a.predicted, &q = b.predicted;
  const auto limit = [](const PredictedObservation& o, std::size_t i) {
    return 1.0F + 3 * std::sqrt(o.covariance[packed_index(4, i, i)]);
  };
  return off_line(p.x_l, p.y_l, p.c_l, p.s_l, q.x_l, q.y_l) < std::max(limit(p, 0), limit(q, 0)) &&
         off_line(p.x_r, p.y_r, p.c_r, p.s_r, q.x_r, q.y_r) < std::max(limit(p, 2), limit(q, 2));
}

}  // namespace

void associate(std::span<const Expected> expected, const EyeView& left, const EyeView& right, Scratch& scratch,
               std::span<Association> out) {
  std::fill_n(scratch.left_owner.begin(), left.primitives.size(), kNone);
  std::fill_n(scratch.right_owner.begin(), right.primitives.size(), kNone);
  for (std::size_t i = 0; i < left.primitives.size(); ++i) scratch.explained[i].count = 0;

  std::size_t n = 0;
  for (std::uint32_t i = 0; i < expected.size(); ++i) {
    out[i] = {};
    const HypothesisList list = hypotheses_of(i, expected[i], left, right, scratch.explained);
    const auto items = list.items();
    out[i].log_likelihood_ratio = log_of(Bracket{expected[i].visible, expected[i].detection}.miss());
    if (items.empty()) continue;
    bool ambiguous = false;
    for (std::size_t k = 1; k < items.size() && items[k].gain > items[0].gain - kLogThree; ++k)
      ambiguous = ambiguous || different_contours(expected[i], items[0], items[k], left, right);
    if (ambiguous) {
      out[i].outcome = AssociateOutcome::kAmbiguous;
      out[i].log_likelihood_ratio = 0;
      continue;
    }
    for (const Hypothesis& h : items)
      if (h.gain > 0) scratch.hypotheses[n++] = h;
  }

  // Greedy: along a contour a wrong swap errs along the edge only, where nothing is measured (METHOD 6.3).
  const std::span<Hypothesis> pool = scratch.hypotheses.first(n);
  std::sort(pool.begin(), pool.end(), [](const Hypothesis& a, const Hypothesis& b) {
    if (a.gain != b.gain) return a.gain > b.gain;
    if (a.expected != b.expected) return a.expected < b.expected;
    return a.left != b.left ? a.left < b.left : a.right < b.right;
  });
  for (const Hypothesis& h : pool) {
    Association& a = out[h.expected];
    if (a.outcome == AssociateOutcome::kStereo || a.outcome == AssociateOutcome::kMono) continue;
    std::int32_t* owner_l = h.left == kNone ? nullptr : &scratch.left_owner[static_cast<std::size_t>(h.left)];
    std::int32_t* owner_r = h.right == kNone ? nullptr : &scratch.right_owner[static_cast<std::size_t>(h.right)];
    const std::int32_t taken_l = owner_l == nullptr ? kNone : *owner_l;
    const std::int32_t taken_r = owner_r == nullptr ? kNone : *owner_r;
    if (taken_l == kNone && taken_r == kNone) {
      a = {owner_l != nullptr && owner_r != nullptr ? AssociateOutcome::kStereo : AssociateOutcome::kMono,
           h.left,
           h.right,
           h.left_reversed,
           h.right_reversed,
           h.log_likelihood_ratio,
           h.d2};
      if (owner_l != nullptr) *owner_l = static_cast<std::int32_t>(h.expected);
      if (owner_r != nullptr) *owner_r = static_cast<std::int32_t>(h.expected);
      continue;
    }
    const std::int32_t winner = taken_l != kNone ? taken_l : taken_r;
    if (same_contour(expected[h.expected], expected[static_cast<std::size_t>(winner)])) {
      a.outcome = AssociateOutcome::kStarved;
      a.log_likelihood_ratio = 0;
    }
  }
}

}  // namespace accrete::associate
