#include "associate/associate.h"

#include <algorithm>
#include <cmath>

namespace accrete::associate {
namespace {

constexpr float kLogThree = 1.0986F;   // METHOD 6.4: the margin below which two contours are ambiguous
constexpr float kOtherContour = 1.0F;  // px of normal offset between observations of different contours

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

void associate(std::span<const Expected> expected, const EyeView& left, const EyeView& right, const GateKernels& gate,
               Scratch& scratch, std::span<Association> out) {
  std::fill_n(scratch.left_owner.begin(), left.primitives.size(), kNone);
  std::fill_n(scratch.right_owner.begin(), right.primitives.size(), kNone);
  for (std::size_t i = 0; i < left.primitives.size(); ++i) scratch.explained[i].count = 0;

  std::size_t n = 0;
  for (std::uint32_t i = 0; i < expected.size(); ++i) {
    const std::size_t own = i % GatingRoom::kGroup;
    if (own == 0)
      find_hypotheses(expected, i, std::min<std::size_t>(GatingRoom::kGroup, expected.size() - i), left, right, gate,
                      scratch.explained, *scratch.room);
    out[i] = {};
    const auto items = scratch.room->hypotheses[own].items();
    out[i].log_likelihood_ratio = log_miss(expected[i]);
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
