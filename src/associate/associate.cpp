#include "associate/associate.h"

#include <algorithm>
#include <cmath>

namespace accrete::associate {
namespace {

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
    const auto different = [&](const Hypothesis& a, const Hypothesis& b) {
      return different_contours(expected[i], a, b, left, right);
    };
    collect(scratch.room->hypotheses[own], log_miss(expected[i]), different, out[i], scratch.hypotheses, n);
  }
  assign_one_to_one(
      scratch.hypotheses.first(n), scratch.left_owner, scratch.right_owner, out,
      [&](std::uint32_t winner, std::uint32_t loser) { return same_contour(expected[loser], expected[winner]); });
}

}  // namespace accrete::associate
