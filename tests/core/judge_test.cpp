// What looks do to a primitive: existence, state, and which motion it follows.
#include "existence/judge.h"

#include <gtest/gtest.h>

#include "core/eye.h"
#include "existence/evidence.h"
#include "existence/static_hypothesis.h"

namespace accrete::existence {
namespace {

using namespace test;
using associate::AssociateOutcome;

constexpr double kUpright = 1.5707963267948966;

View view_at(double x, double y = 0) {
  View v;
  v.x_l = static_cast<float>(x);
  v.x_r = static_cast<float>(x - 30);
  v.y_l = v.y_r = static_cast<float>(y);
  v.c_l = v.c_r = 0;
  v.s_l = v.s_r = 1;
  return v;
}
Look look_at(const View& view, AssociateOutcome outcome, float ratio, std::uint32_t frame = 1) {
  Look l{};
  l.outcome = outcome;
  l.log_likelihood_ratio = ratio;
  l.static_log_ratio = -1;
  l.visible = 0.9F;
  l.detection = 0.83F;
  l.view = view;
  l.sigma_n_px = 0.4F;
  l.sigma_theta = 0.04F;
  l.toward_viewer = {0, 0, -1};
  l.frame = frame;
  return l;
}
Track newborn() {
  Track t;
  t.state = State::kTentative;
  t.birth = t.counted = t.used = view_at(0);
  return t;
}
// Confirmed by matches at views that move on by 3 px.
Track confirmed(const ExistenceParams& params, double& x) {
  Track t = newborn();
  for (std::uint32_t k = 1; k < 12; ++k) {
    x += 3;
    Look l = look_at(view_at(x), AssociateOutcome::kStereo, 2, k);
    l.distinguishable = true;
    EXPECT_NE(judge(t, l, params), Verdict::kDelete);
  }
  EXPECT_EQ(t.state, State::kConfirmed);
  return t;
}

TEST(Judge, a_static_scene_verifies_nothing) {
  const ExistenceParams params;
  Track t = newborn();
  for (std::uint32_t k = 1; k <= 500; ++k) {
    Look l = look_at(view_at(0), AssociateOutcome::kStereo, 10, k);
    l.distinguishable = true;
    l.static_log_ratio = -10;
    EXPECT_EQ(judge(t, l, params), Verdict::kUndecided);
  }
  EXPECT_EQ(t.state, State::kTentative);
  EXPECT_EQ(t.novel_matches, 0U);
  EXPECT_EQ(t.log_odds, 0);
  EXPECT_EQ(t.motion_log_odds, 0);
  EXPECT_EQ(t.observations, 500U);  // seen it was, all the same
  EXPECT_EQ(t.last_frame, 500U);
  // Neither does it refute anything.
  for (std::uint32_t k = 501; k <= 600; ++k)
    EXPECT_EQ(judge(t, look_at(view_at(0), AssociateOutcome::kMissed, -10, k), params), Verdict::kUndecided);
  // A slow drift counts in the end: the view is compared with the last one that counted, not with the last one.
  double x = 0;
  for (std::uint32_t k = 601; k <= 700; ++k) {
    x += 0.15;
    Look l = look_at(view_at(x), AssociateOutcome::kStereo, 2, k);
    l.distinguishable = true;
    (void)judge(t, l, params);
  }
  EXPECT_EQ(t.state, State::kConfirmed);
  EXPECT_LT(t.novel_matches, 40U);
}

TEST(Judge, matches_at_novel_views_confirm_and_misses_delete) {
  const ExistenceParams params;
  double x = 0;
  const Track t = confirmed(params, x);
  EXPECT_GE(t.log_odds, params.decide);
  EXPECT_LE(t.log_odds, params.clamp);
  EXPECT_GE(t.novel_matches, static_cast<std::uint32_t>(params.min_novel_matches));
  Track u = newborn();
  Verdict verdict = Verdict::kUndecided;
  int frames = 0;
  for (; verdict == Verdict::kUndecided && frames < 50; ++frames)
    verdict = judge(u, look_at(view_at(3 * (frames + 1)), AssociateOutcome::kMissed, -1.2F), params);
  EXPECT_EQ(verdict, Verdict::kDelete);
  EXPECT_LE(frames, 6);
  EXPECT_EQ(u.misses_in_row, static_cast<std::uint32_t>(frames));
}

TEST(Judge, the_ambiguous_and_the_starved_change_nothing) {
  const ExistenceParams params;
  for (const AssociateOutcome outcome : {AssociateOutcome::kAmbiguous, AssociateOutcome::kStarved}) {
    double x = 0;
    Track t = confirmed(params, x);
    const Track before = t;
    for (int k = 0; k < 50; ++k) {
      x += 3;
      EXPECT_EQ(judge(t, look_at(view_at(x), outcome, -5), params), Verdict::kUndecided);
    }
    EXPECT_EQ(t.log_odds, before.log_odds);
    EXPECT_EQ(t.motion_log_odds, before.motion_log_odds);
    EXPECT_EQ(t.state, before.state);
    EXPECT_EQ(t.last_frame, before.last_frame);
    EXPECT_EQ(t.seen.visits, before.seen.visits);
  }
}

TEST(Judge, hidden_for_forty_frames_is_preserved_and_comes_back) {
  // The chain of visibility as the pipeline runs it: the geometry says that the face shows, something is in front.
  const ExistenceParams params;
  double x = 0;
  Track t = confirmed(params, x);
  const float both = 1 - (1 - params.detection) * (1 - params.detection);
  int preserved = 0;
  for (std::uint32_t k = 0; k < 40; ++k) {
    x += 3;
    Look l = look_at(view_at(x), AssociateOutcome::kMissed, 0, 100 + k);
    l.visible = predicted_visibility(t.visible, 0.9F, 0.02F);
    l.log_likelihood_ratio = std::log(1 - l.visible * both);
    ASSERT_NE(judge(t, l, params), Verdict::kDelete) << k;
    preserved += t.state == State::kPreserved;
  }
  EXPECT_GE(preserved, 35);
  x += 3;
  Look l = look_at(view_at(x), AssociateOutcome::kStereo, 3, 140);
  l.visible = predicted_visibility(t.visible, 0.9F, 0.02F);
  EXPECT_NE(judge(t, l, params), Verdict::kDelete);
  EXPECT_EQ(t.state, State::kConfirmed);
  EXPECT_EQ(t.visible, 1);
  // Visible for sure and never found again: that one goes.
  Verdict verdict = Verdict::kUndecided;
  for (int k = 0; k < 30 && verdict != Verdict::kDelete; ++k) {
    x += 3;
    Look miss = look_at(view_at(x), AssociateOutcome::kMissed, std::log(1 - both));
    miss.visible = 1;
    verdict = judge(t, miss, params);
  }
  EXPECT_EQ(verdict, Verdict::kDelete);
}

// One primitive, two worlds: its observation moves with the given motion, or stands still in the image.
struct History {
  Verdict verdict = Verdict::kUndecided;
  Track track = newborn();
  int frames = 0;

  History(double given, double real, std::uint64_t seed) {
    Dice dice(seed);
    const Appearance look = random_look(dice);
    const ExistenceParams params;
    std::vector<Primitive2d> far;
    for (int k = 0; k < 40; ++k)
      far.push_back(element(dice.uniform(-200, 200), dice.uniform(30, 200), dice.uniform(0, 3), random_look(dice)));
    for (; frames < 25 && verdict != Verdict::kDelete; ++frames) {
      const double at = given * (frames + 1), seen = real * (frames + 1);
      auto l = far, r = far;
      l.push_back(element(seen + dice.normal(0.1), 0, kUpright, look));
      r.push_back(element(seen - 30 + dice.normal(0.1), 0, kUpright, look));
      const SeenEye left(l), right(r);
      const auto e =
          expect_at(element(at, 0, kUpright, look).aligned, element(at - 30, 0, kUpright, look).aligned, look);
      Associator associate;
      const auto a = associate({&e, 1}, left, right)[0];
      Look now = look_at(view_at(at), a.outcome, a.log_likelihood_ratio, static_cast<std::uint32_t>(frames + 1));
      now.distinguishable = distinguishable(track, now.view, now.sigma_n_px, now.sigma_theta);
      now.static_log_ratio = static_log_ratio(track, look, left.view(), right.view(), params.detection);
      verdict = judge(track, now, params);
    }
  }
};

TEST(StaticHypothesis, an_edge_that_stands_still_is_told_from_one_that_moves) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const History moving(2.5, 2.5, seed);
    EXPECT_NE(moving.verdict, Verdict::kDelete);
    EXPECT_EQ(moving.track.state, State::kConfirmed);
    EXPECT_GE(moving.track.motion_log_odds, ExistenceParams{}.decide);
    // Predicted to move by so little that every match still lies in its gate at first: background all the same.
    const History standing(0.5, 0, seed);
    EXPECT_EQ(standing.verdict, Verdict::kDelete);
    EXPECT_LT(standing.track.motion_log_odds, 0);
    EXPECT_EQ(standing.track.state, State::kTentative);
  }
}

TEST(StaticHypothesis, motion_along_the_edge_tells_nothing) {
  const Track t = newborn();
  EXPECT_FALSE(distinguishable(t, view_at(0, 100), 0.4F, 0.04F));
  EXPECT_FALSE(distinguishable(t, view_at(0), 0.4F, 0.04F));
  EXPECT_FALSE(distinguishable(t, view_at(1), 0.4F, 0.04F));  // 2.5 deviations
  EXPECT_TRUE(distinguishable(t, view_at(2), 0.4F, 0.04F));
}

TEST(StaticHypothesis, is_the_product_of_two_eyes_and_blind_to_reversal) {
  Dice dice(3);
  const Appearance look = random_look(dice);
  Track t = newborn();
  const SeenEye none({}), both_l({element(0, 1, kUpright, look)}), both_r({element(-30, 1, kUpright, look)});
  const auto ratio = [&](const SeenEye& l, const SeenEye& r) {
    return static_log_ratio(t, look, l.view(), r.view(), 0.83F);
  };
  // Nothing there: two misses.
  EXPECT_NEAR(ratio(none, none), 2 * std::log(0.17), 1e-4);
  EXPECT_NEAR(ratio(both_l, none) + ratio(none, both_r), ratio(both_l, both_r) + ratio(none, none), 1e-3);
  EXPECT_GT(ratio(both_l, both_r), 2);
  Primitive2d l = element(0, 1, kUpright, look);
  l.aligned = reversed(l.aligned);
  l.appearance = reversed(look);
  const SeenEye turned({l});
  EXPECT_NEAR(ratio(turned, both_r), ratio(both_l, both_r), 1e-3);
  // Elsewhere, or of another look, it is no evidence of standing still.
  EXPECT_LT(ratio(SeenEye({element(6, 1, kUpright, look)}), SeenEye({element(-24, 1, kUpright, look)})), -2);
}

}  // namespace
}  // namespace accrete::existence
