// Pipeline::judge and Pipeline::filter: what the associations do to existence, and to the states.
#include <algorithm>
#include <cmath>

#include "accumulator/pipeline.h"
#include "base/elementary.h"
#include "existence/evidence.h"
#include "existence/judge.h"
#include "existence/repeated_view.h"
#include "existence/static_hypothesis.h"
#include "filter/reliability.h"
#include "filter/view_change.h"

namespace accrete {
namespace {

View view_of(const PredictedObservation& p) { return {p.x_l, p.y_l, p.c_l, p.s_l, p.x_r, p.y_r, p.c_r, p.s_r}; }

// An undecided primitive that is not seen again cannot be decided: its place is needed (METHOD 7.4).
constexpr std::uint32_t kUndecidedAge = 12, kUndecidedSilence = 8;

// Weight of a new innovation in the running misfit: a memory of about five observations.
constexpr float kMisfitGain = 0.2F;

LineElement observed(const Primitive2d& p, bool is_reversed, const associate::Noise& noise, float bias2) {
  LineElement e = is_reversed ? reversed(p.aligned) : p.aligned;
  // The consider bias gates but does not correct: it would be filtered away (METHOD 1.4).
  e.sigma_n_px = std::sqrt(e.sigma_n_px * e.sigma_n_px + std::max(noise.variance_n_px2 - bias2, 0.0F));
  e.sigma_theta = std::sqrt(e.sigma_theta * e.sigma_theta + noise.variance_theta);
  return e;
}

constexpr float kIgnore = 30.0F;  // factor on sigma with which an observation changes nothing
// Per observation: a face keeps its paint, and what the light does averages out. Measured on a rendered box: none and
// this are alike, five times as much forgets.
constexpr float kColourDrift = 0.001F;

}  // namespace

void Pipeline::judge(StepReport& report) {
  using associate::AssociateOutcome;
  for (std::size_t i = 0; i < expected_count_; ++i) {
    const std::uint32_t slot = w_.expected_slots[i];
    Track& track = w_.tracks[slot];
    const associate::Expected& e = w_.expected[i];
    const associate::Association& a = w_.associations[i];
    switch (a.outcome) {
      case AssociateOutcome::kMissed:
        ++report.missed;
        break;
      case AssociateOutcome::kStereo:
        ++report.matched_stereo;
        break;
      case AssociateOutcome::kMono:
        ++report.matched_mono;
        break;
      case AssociateOutcome::kAmbiguous:
        ++report.ambiguous;
        break;
      case AssociateOutcome::kStarved:
        ++report.starved;
        break;
    }
    const Geometry g = load(w_.geometry[slot / kBlockLanes], slot % kBlockLanes);
    existence::Look look{};
    look.outcome = a.outcome;
    look.log_likelihood_ratio = a.log_likelihood_ratio;
    look.visible = e.visible;
    look.detection = e.detection;
    look.view = view_of(e.predicted);
    // The element's own noise comes on top of the prediction's: 0.3 px and 2 degrees (METHOD 1.4).
    look.sigma_n_px = std::sqrt(e.predicted.covariance[packed_index(4, 0, 0)] + e.noise.variance_n_px2 + 0.09F);
    look.sigma_theta = std::sqrt(e.predicted.covariance[packed_index(4, 1, 1)] + e.noise.variance_theta + 0.0012F);
    look.toward_viewer = unit_to(g.position, centres_[0]);
    look.frame = frame_;
    look.repeated = has_last_ && existence::found_by_repetition(a, g.position, last_centres_, centres_);
    look.distinguishable =
        e.visible > 0.5F && existence::distinguishable(track, look.view, look.sigma_n_px, look.sigma_theta);
    if (look.distinguishable)
      look.static_log_ratio =
          existence::static_log_ratio(track, e.mean, eye_view(0), eye_view(1), params_.existence.detection);
    const State before = track.state;
    const existence::Verdict verdict = existence::judge(track, look, params_.existence);
    report.newly_confirmed += before == State::kTentative && track.state != State::kTentative;
    if (verdict == existence::Verdict::kDelete) {
      (track.log_odds <= -params_.existence.decide ? report.deleted_existence : report.deleted_background)++;
      store_.release(slot);
    }
  }
  for (std::uint32_t slot = 0; slot < w_.tracks.size(); ++slot) {
    const Track& t = w_.tracks[slot];
    if (t.state != State::kTentative) continue;
    if (frame_ - t.first_frame < kUndecidedAge || frame_ - t.last_frame < kUndecidedSilence) continue;
    ++report.deleted_undecided;
    store_.release(slot);
  }
}

void Pipeline::filter(StepReport& report) {
  using associate::AssociateOutcome;
  UpdateBatch& b = w_.batch;
  const float bias2 = params_.filter.bias_px * params_.filter.bias_px;
  // Stereo pairs fill the batch from the front and single eyes from the back: one gather for the appearance of both.
  const std::size_t capacity = b.slots.size();
  std::size_t stereo = 0, mono = 0;
  const float channels = eye_view(0).clutter->independent_channels;
  float misfits = 0;
  for (std::size_t i = 0; i < expected_count_; ++i) {
    const associate::Association& a = w_.associations[i];
    const std::uint32_t slot = w_.expected_slots[i];
    Track& track = w_.tracks[slot];
    if (track.state == State::kFree) continue;
    if (a.outcome != AssociateOutcome::kStereo && a.outcome != AssociateOutcome::kMono) continue;
    const associate::Expected& e = w_.expected[i];
    const View view = view_of(e.predicted);
    if (existence::displacement_px(track.used, view) < 1) {  // the errors of a standing image are the same (METHOD 5.3)
      ++report.not_novel;
      continue;
    }
    track.used = view;
    const bool both = a.outcome == AssociateOutcome::kStereo;
    const float misfit = a.d2 / (both ? 4.0F : 2.0F);
    track.misfit += std::max(kMisfitGain, 1.0F / static_cast<float>(track.observations - 1)) * (misfit - track.misfit);
    misfits += misfit;
    const std::size_t k = both ? stereo++ : capacity - ++mono;
    b.slots[k] = slot;
    b.slide_cap[k] = 0.25F * track.pitch_m * track.pitch_m;
    const Primitive2d* l =
        a.left == associate::kNone ? nullptr : &w_.eye[0].primitives[static_cast<std::size_t>(a.left)];
    const Primitive2d* r =
        a.right == associate::kNone ? nullptr : &w_.eye[1].primitives[static_cast<std::size_t>(a.right)];
    const Primitive2d& one = l != nullptr ? *l : *r;
    b.eyes[k] = l != nullptr ? Eye::kLeft : Eye::kRight;
    if (l != nullptr) b.left[k] = observed(*l, a.left_sense != 0, e.noise, bias2);
    if (r != nullptr) (both ? b.right[k] : b.left[k]) = observed(*r, a.right_sense != 0, e.noise, bias2);
    b.appearance[k] = (l != nullptr ? a.left_sense : a.right_sense) != 0 ? reversed(one.appearance) : one.appearance;
    float sigma_colour = one.sigma_colour;
    if (both) {
      const Appearance other = a.right_sense != 0 ? reversed(r->appearance) : r->appearance;
      Appearance& m = b.appearance[k];
      m.phase = atan2_of(sin_of(m.phase) + sin_of(other.phase), cos_of(m.phase) + cos_of(other.phase));
      for (std::size_t c = 0; c < 3; ++c) {
        m.left[c] = 0.5F * (m.left[c] + other.left[c]);
        m.right[c] = 0.5F * (m.right[c] + other.right[c]);
      }
      sigma_colour = 0.5F * (sigma_colour + r->sigma_colour);
    }
    const AppearanceState s = load(w_.appearance[slot / kBlockLanes], slot % kBlockLanes);
    const Geometry g = load(w_.geometry[slot / kBlockLanes], slot % kBlockLanes);
    const Vec3f viewer = unit_to(g.position, centres_[0]);
    b.q_phase[k] = phase_change2(angle_between(viewer, track.viewer));
    track.viewer = viewer;
    const Background hidden = background_sides(g, viewer, s, b.appearance[k], channels, track.hidden);
    b.sigma_left[k] = hidden.left ? kIgnore * sigma_colour : sigma_colour;
    b.sigma_right[k] = hidden.right ? kIgnore * sigma_colour : sigma_colour;
    b.sigma_phase[k] = hidden.left || hidden.right ? kIgnore * one.sigma_phase : one.sigma_phase;
    b.q_colour[k] = kColourDrift * kColourDrift;
    learn(s, b.appearance[k],
          {one.sigma_phase, sigma_colour, sigma_colour, b.q_phase[k], b.q_colour[k], hidden.left, hidden.right},
          track.observations - 1, track.reliability);
  }
  if (stereo + mono > 0)
    typical_misfit_ += kMisfitGain * (misfits / static_cast<float>(stereo + mono) - typical_misfit_);

  const auto count = [&](std::span<const UpdateOutcome> outcomes) {
    for (const UpdateOutcome o : outcomes) {
      report.updated += o == UpdateOutcome::kUpdated;
      report.not_positive_definite += o == UpdateOutcome::kNotPositiveDefinite;
      report.update_behind += o == UpdateOutcome::kBehind;
    }
  };
  const auto refused = [](std::span<const UpdateOutcome> outcomes) {
    const auto n = std::count(outcomes.begin(), outcomes.end(), UpdateOutcome::kUpdated);
    return static_cast<std::uint32_t>(outcomes.size() - static_cast<std::size_t>(n));
  };
  const auto both_appearances = [&](std::size_t first, std::size_t n) {
    const auto part = [&](auto span) { return span.subspan(first, n); };
    kernels_.update_roll(w_.geometry, part(b.slots), pose_, optics_, params_.filter.sigma_roll, part(b.outcomes));
    report.roll_refused += refused(part(b.outcomes));
    kernels_.update_appearance(w_.appearance, part(b.slots), part(b.appearance), part(b.sigma_phase),
                               part(b.sigma_left), part(b.sigma_right), part(b.q_phase), part(b.q_colour),
                               part(b.outcomes));
    report.appearance_refused += refused(part(b.outcomes));
  };
  if (stereo > 0) {
    kernels_.update_stereo(w_.geometry, b.slots.first(stereo), b.left.first(stereo), b.right.first(stereo), pose_,
                           optics_, b.outcomes.first(stereo), b.slide_cap.first(stereo));
    count(b.outcomes.first(stereo));
    both_appearances(0, stereo);
  }
  if (mono > 0) {
    const std::size_t first = capacity - mono;
    kernels_.update_mono(w_.geometry, b.slots.last(mono), b.left.last(mono), b.eyes.last(mono), pose_, optics_,
                         b.outcomes.last(mono), b.slide_cap.last(mono));
    count(b.outcomes.last(mono));
    both_appearances(first, mono);
  }
}

}  // namespace accrete
