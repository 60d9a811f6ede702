#include "store/birth.h"

#include <algorithm>
#include <cmath>

#include "base/elementary.h"
#include "existence/evidence.h"
#include "extract/extract.h"
#include "stereo/reconstruct.h"

namespace accrete {
namespace {

bool explained(const BirthInput& in, const StereoMatch& m) {
  if (in.left_owner[m.left] != associate::kNone || in.right_owner[m.right] != associate::kNone) return true;
  const associate::Explained& e = in.explained[m.left];
  for (std::size_t k = 0; k < e.count; ++k)
    if (e.right[k] == m.right) return true;
  return false;
}

bool excluded(const Params& params, const std::array<float, 3>& p) {
  for (int i = 0; i < params.excluded_count; ++i) {
    const ExcludedBox& b = params.excluded[static_cast<std::size_t>(i)];
    bool inside = true;
    for (std::size_t k = 0; k < 3; ++k) inside = inside && p[k] >= b.min_m[k] && p[k] <= b.max_m[k];
    if (inside) return true;
  }
  return false;
}

// Mean of both views per side; photometric differences between the eyes are systematic, so averaging gains nothing
// below the floor (METHOD 3.3).
AppearanceState appearance_of(const Primitive2d& l, const Primitive2d& r, bool right_reversed) {
  const Appearance a = l.appearance, b = right_reversed ? reversed(r.appearance) : r.appearance;
  AppearanceState s;
  s.mean.phase = atan2_of(sin_of(a.phase) + sin_of(b.phase), cos_of(a.phase) + cos_of(b.phase));
  for (std::size_t c = 0; c < 3; ++c) {
    s.mean.left[c] = 0.5F * (a.left[c] + b.left[c]);
    s.mean.right[c] = 0.5F * (a.right[c] + b.right[c]);
  }
  const float phase2 = 0.5F * l.sigma_phase * r.sigma_phase;
  const float colour2 = std::max(0.5F * l.sigma_colour * r.sigma_colour, (4.0F / 255) * (4.0F / 255));
  s.covariance[packed_index(7, 0, 0)] = phase2;
  for (std::size_t i = 1; i < 7; ++i) s.covariance[packed_index(7, i, i)] = colour2;
  return s;
}

// A position in the map is rounded to this part of it, and must still tell a thousandth of the depth: a map whose
// origin is 17,000 depths away (UTM coordinates) does not. Subtract a constant from all poses then.
constexpr float kRounding = 6e-8F, kMaxRounding = 1e-3F;

}  // namespace

void give_birth(const BirthInput& in, const Params& params, Store& store, StepReport& report) {
  const AlignedPose& T = in.pose;
  float R_m_a[9], t_m_a[3];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) R_m_a[3 * i + j] = T.R[3 * j + i];
    t_m_a[i] = -(T.R[i] * T.t[0] + T.R[3 + i] * T.t[1] + T.R[6 + i] * T.t[2]);
  }
  const float origin = std::max({std::fabs(t_m_a[0]), std::fabs(t_m_a[1]), std::fabs(t_m_a[2])});
  constexpr float kPitch = static_cast<float>(extract::kPitch);
  const float sigma_slide = kPitch / std::sqrt(12.0F);  // the sampling point is uniform along the edge

  std::size_t wanted = 0;
  for (const StereoMatch& m : in.matches) wanted += !explained(in, m);
  report.evicted += store.make_room(std::min(wanted, store.tracks.size() / 4), params.existence.decide);

  for (const StereoMatch& m : in.matches) {
    if (explained(in, m)) continue;
    if (store.free_count == 0) {
      ++report.birth_refused_capacity;
      continue;
    }
    const Primitive2d &l = in.left[m.left], &r = in.right[m.right];
    const LineElement el = l.aligned, er = m.right_reversed ? reversed(r.aligned) : r.aligned;
    Geometry g;
    const ReconstructOutcome outcome = reconstruct(el, er, in.optics, sigma_slide, params.filter.sigma_roll, g);
    if (outcome != ReconstructOutcome::kOk) {
      ++(outcome == ReconstructOutcome::kBehind ? report.birth_refused_behind : report.birth_refused_degenerate);
      continue;
    }
    const float depth = g.position[2];
    if (!(origin * kRounding < kMaxRounding * depth) || !transform(g, R_m_a, t_m_a)) {
      ++report.birth_refused_range;
      continue;
    }
    if (excluded(params, g.position)) {
      ++report.birth_refused_excluded;
      continue;
    }
    const std::uint32_t slot = store.take();
    accrete::store(g, store.geometry[slot / kBlockLanes], slot % kBlockLanes);
    accrete::store(appearance_of(l, r, m.right_reversed), store.appearance[slot / kBlockLanes], slot % kBlockLanes);
    Track& t = store.tracks[slot];
    t.log_odds = existence::log_odds(m.probability);
    t.observations = 1;
    t.first_frame = t.last_frame = in.frame;
    t.pitch_m = kPitch * depth / in.optics.focal_px;
    t.birth = {el.x_px, el.y_px, el.c, el.s, er.x_px, er.y_px, er.c, er.s};
    t.counted = t.used = t.birth;
    float n = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      t.viewer[k] = t_m_a[k] - g.position[k];
      n += t.viewer[k] * t.viewer[k];
    }
    for (float& v : t.viewer) v /= std::sqrt(n);
    t.seen.count(t.viewer, true);
    ++report.born;
  }
}

}  // namespace accrete
