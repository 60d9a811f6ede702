#include "stereo/match.h"

#include <algorithm>
#include <cmath>

#include "base/elementary.h"
#include "stereo/similarity.h"

namespace accrete::stereo {
namespace {

// How far the right element may be slid along itself to reach the epipolar line: 1.5 times half a pitch of 6 px.
constexpr float kMaxSlide = 4.5F;
// Rivals are hypotheses whose mismatch exceeds the best one's by less than this: log-ratio 3, a factor of 20.
constexpr float kRivalMargin = 6.0F;
// Two right elements this close on the same epipolar line are one contour, sampled twice.
constexpr float kSameContour = 1.5F;
// Prior existence of a left primitive's explanations together. METHOD 2.2 recalls 0.46; with 0.5 existence promised too
// much on every recording with truth (calibration: docs/math/stereo.md).
constexpr float kPrior = 0.2F;

void insert(Candidates& list, const Candidate& c) {
  const auto begin = list.item.begin();
  auto end = begin + static_cast<std::ptrdiff_t>(list.count);
  // One entry per contour: the better of two samplings of it stays.
  const auto same = std::find_if(
      begin, end, [&](const Candidate& o) { return std::fabs(o.disparity_px - c.disparity_px) < kSameContour; });
  if (same != end) {
    if (c.mismatch >= same->mismatch) return;
    end = std::move(same + 1, end, same);
  }
  const auto at = std::find_if(begin, end, [&](const Candidate& o) { return o.mismatch > c.mismatch; });
  if (at == list.item.end()) return;
  const auto last = end == list.item.end() ? end - 1 : end;
  std::move_backward(at, last, last + 1);
  *at = c;
  list.count = static_cast<std::size_t>(last + 1 - begin);
}

struct DisparityRange {
  float min, max;
};

DisparityRange range_of(const StereoParams& p, const AlignedOptics& o, int width) {
  const float fb = o.focal_px * o.baseline_m;
  DisparityRange r{0.5F, static_cast<float>(width) / 2};  // half a pixel is beyond what localisation can tell from zero
  if (p.max_depth_m > 0) r.min = std::max(r.min, fb / p.max_depth_m);
  if (p.min_depth_m > 0) r.max = fb / p.min_depth_m;
  return r;
}

// A neighbour along the contour whose hypothesis continues this one: collinear in both images (METHOD 2.2, group
// constraint). The disparity changes along the left edge with the difference of the two slopes.
bool supported(std::span<const Primitive2d> left, std::span<const Primitive2d> right, const Scratch& s, std::size_t i,
               const Candidate& mine) {
  const LineElement& e = left[i].aligned;
  const LineElement& f = right[mine.right].aligned;
  const float slope = e.c / e.s - f.c / f.s;  // d(disparity)/dy
  for (const std::uint16_t j : s.left_rows.between(e.y_px - 14, e.y_px + 14)) {
    if (j == i) continue;
    const LineElement& n = left[j].aligned;
    const float dx = n.x_px - e.x_px, dy = n.y_px - e.y_px;
    const float along = dx * e.c + dy * e.s, across = -dx * e.s + dy * e.c;
    // Within two and a half pitches, on the tangent line within 1.5 px plus curvature, and parallel within 20 degrees.
    if (std::fabs(along) > 15 || std::fabs(across) > 1.5F + 0.1F * std::fabs(along)) continue;
    if (std::fabs(e.c * n.s - e.s * n.c) > 0.34F) continue;
    const Candidates& others = s.candidates[j];
    for (std::size_t m = 0; m < others.count; ++m) {
      const Candidate& o = others.item[m];
      const float error = std::fabs(o.disparity_px - mine.disparity_px - slope * dy);
      if (o.right != mine.right && error < 1.0F + 0.15F * std::fabs(dy)) return true;
    }
  }
  return false;
}

}  // namespace

std::size_t match(std::span<const Primitive2d> left, std::span<const Primitive2d> right, const StereoParams& params,
                  const AlignedOptics& optics, int image_width_px, Scratch& scratch, std::span<StereoMatch> out,
                  StepReport& report) {
  scratch.left_rows.build(left);
  scratch.right_rows.build(right);
  const DisparityRange range = range_of(params, optics, image_width_px);
  const float min_sin = sin_of(params.min_psi);
  std::fill_n(scratch.best_of_right.begin(), right.size(), 1e9F);

  for (std::size_t i = 0; i < left.size(); ++i) {
    Candidates& c = scratch.candidates[i];
    c.count = 0;
    const LineElement& e = left[i].aligned;
    if (std::fabs(e.s) < min_sin) {
      ++report.stereo_refused_epipolar;
      continue;
    }
    for (const std::uint16_t j : scratch.right_rows.between(e.y_px - kMaxSlide, e.y_px + kMaxSlide)) {
      const LineElement& f = right[j].aligned;
      const float dx = e.x_px - f.x_px;
      if (dx < range.min - 8 || dx > range.max + 8) continue;  // 8 px: what the slide can change below
      if (std::fabs(f.s) < min_sin) continue;
      const float dy = e.y_px - f.y_px;
      if (std::fabs(dy) > kMaxSlide * std::fabs(f.s)) continue;
      const float disparity = dx - f.c / f.s * dy;
      if (disparity < range.min || disparity > range.max) continue;
      const float cosine = e.c * f.c + e.s * f.s;
      if (std::fabs(cosine) < 0.7F) continue;  // 45 degrees: three sigmas of METHOD 2.2
      const bool same_sense = cosine > 0;
      const float similar = similarity(left[i], right[j], same_sense);
      if (similar < params.min_similarity) continue;
      const float worse = mismatch(left[i], right[j], same_sense);
      insert(c, {j, !same_sense, worse, disparity, similar});
      scratch.best_of_right[j] = std::min(scratch.best_of_right[j], worse);
    }
  }

  std::size_t n = 0;
  for (std::size_t i = 0; i < left.size(); ++i) {
    const Candidates& list = scratch.candidates[i];
    const std::size_t first = n;
    float weights = 0;
    for (std::size_t k = 0; k < list.count && n - first < static_cast<std::size_t>(params.max_rivals); ++k) {
      const Candidate& c = list.item[k];
      const float relative = c.mismatch - list.item[0].mismatch;
      if (relative > kRivalMargin) break;
      if (c.mismatch > scratch.best_of_right[c.right] + kRivalMargin) continue;  // another left fits it far better
      if (n == out.size()) {
        ++report.stereo_refused_capacity;
        continue;
      }
      const bool grouped = supported(left, right, scratch, i, c);
      // A contour that continues in both images is four times as likely to be one (to be measured: docs/evaluation.md).
      const float weight = exp_of(-0.5F * relative) * (grouped ? 4.0F : 1.0F);
      weights += weight;
      out[n++] = {static_cast<std::uint16_t>(i), c.right, c.reversed, grouped, c.disparity_px, c.similarity, weight};
    }
    for (std::size_t k = first; k < n; ++k)
      out[k].probability = std::clamp(kPrior * out[k].probability / weights, 0.02F, kPrior);
    report.stereo_ambiguous += n - first > 1;
  }
  report.stereo_matches = static_cast<std::uint32_t>(n);
  return n;
}

}  // namespace accrete::stereo
