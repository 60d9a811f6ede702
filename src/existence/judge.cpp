#include "existence/judge.h"

#include <algorithm>

#include "existence/evidence.h"

namespace accrete::existence {
namespace {

// Below this novelty a frame is the same view again: it neither counts nor becomes the reference.
constexpr float kNovel = 0.5F;
// Bound of one frame's evidence about motion, and of its sum: half and twice the decision threshold of 4.6, so that one
// chance match decides nothing, and that evidence can still turn round.
constexpr float kMotionStep = 2.3F, kMotionClamp = 9.2F;
// Below this probability of being visible a confirmed primitive that is not found counts as hidden.
constexpr float kHidden = 0.5F;

}  // namespace

Judgement judge(Track& track, const Evidence& look, float novelty, const ExistenceParams& params) {
  using associate::AssociateOutcome;
  const bool matched = look.outcome == AssociateOutcome::kStereo || look.outcome == AssociateOutcome::kMono;
  const bool informative = matched || look.outcome == AssociateOutcome::kMissed;
  if (matched) {
    ++track.observations;
    track.last_frame = look.frame;
    track.misses_in_row = 0;
  }
  if (!informative) return {Verdict::kUndecided, false};

  const float both_eyes = 1 - (1 - look.detection) * (1 - look.detection);
  track.visible = corrected_visibility(look.visible, matched, both_eyes);
  track.seen.count(look.toward_viewer, matched);
  if (!matched) ++track.misses_in_row;

  const bool counted = novelty >= kNovel;
  if (counted) {
    track.log_odds = updated_log_odds(track.log_odds, look.log_likelihood_ratio, novelty, params.clamp);
    track.novel_matches += matched && !look.repeated;
    if (look.distinguishable) {
      const float step = std::clamp(look.log_likelihood_ratio - look.static_log_ratio, -kMotionStep, kMotionStep);
      track.motion_log_odds = std::clamp(track.motion_log_odds + step, -kMotionClamp, kMotionClamp);
    }
  }

  const Verdict verdict = sequential(track, params);
  if (verdict == Verdict::kConfirm && track.state == State::kTentative) track.state = State::kConfirmed;
  if (track.state != State::kTentative)
    track.state = !matched && track.visible < kHidden ? State::kPreserved : State::kConfirmed;
  return {track.motion_log_odds <= -params.decide ? Verdict::kDelete : verdict, counted};
}

Verdict judge(Track& track, const Look& look, const ExistenceParams& params) {
  const float weight = novelty(track.counted, look.view, look.sigma_n_px, look.sigma_theta);
  const Judgement judgement = judge(track, look, weight, params);
  if (judgement.counted) track.counted = look.view;
  return judgement.verdict;
}

}  // namespace accrete::existence
