// An eye that stands where the other one stood a frame ago.
#include "existence/repeated_view.h"

#include <gtest/gtest.h>

#include <memory>

#include "core/poster.h"
#include "existence/judge.h"

namespace accrete::existence {
namespace {

using associate::AssociateOutcome;
using associate::Association;

constexpr float kBaseline = 0.1F;

// A rig whose left eye is at `x`, looking along z.
EyeCentres eyes_at(float x) { return {Vec3f{x, 0, 0}, Vec3f{x + kBaseline, 0, 0}}; }

Association found(bool by_left, bool by_right) {
  Association a;
  a.outcome = by_left && by_right   ? AssociateOutcome::kStereo
              : by_left || by_right ? AssociateOutcome::kMono
                                    : AssociateOutcome::kMissed;
  a.left = by_left ? 3 : associate::kNone;
  a.right = by_right ? 4 : associate::kNone;
  return a;
}
const Association kByLeft = found(true, false), kByRight = found(false, true);

TEST(RepeatedView, is_that_of_an_eye_on_the_ray_of_the_other_one) {
  const Vec3f point{0.05F, 0, 1};
  EXPECT_TRUE(found_by_repetition(kByLeft, point, eyes_at(0), eyes_at(kBaseline)));
  EXPECT_TRUE(found_by_repetition(kByRight, point, eyes_at(0), eyes_at(-kBaseline)));
  // Near is the same, half-way is not, and neither is a rig that stands still: that is the novelty's to know.
  EXPECT_TRUE(found_by_repetition(kByLeft, point, eyes_at(0), eyes_at(1.05F * kBaseline)));
  EXPECT_FALSE(found_by_repetition(kByLeft, point, eyes_at(0), eyes_at(0.5F * kBaseline)));
  EXPECT_FALSE(found_by_repetition(kByLeft, point, eyes_at(0), eyes_at(0)));
  // On the ray, but nearer: the same view of this point, and another of those beside it.
  EyeCentres nearer = eyes_at(kBaseline);
  for (Vec3f& eye : nearer) eye = {0.5F * (eye[0] + point[0]), 0, 0.5F};
  EXPECT_TRUE(found_by_repetition(kByLeft, point, eyes_at(0), nearer));
  EXPECT_FALSE(found_by_repetition(kByLeft, {0.55F, 0, 1}, eyes_at(0), nearer));
}

TEST(RepeatedView, is_told_from_another_one_a_kilometre_away) {
  EXPECT_TRUE(found_by_repetition(kByLeft, {0, 0, 1000}, eyes_at(0), eyes_at(kBaseline)));
  EXPECT_FALSE(found_by_repetition(kByLeft, {0, 0, 1000}, eyes_at(0), eyes_at(0.5F * kBaseline)));
}

TEST(RepeatedView, is_nothing_to_what_the_other_eye_found_as_well_or_nobody) {
  const Vec3f point{0.05F, 0, 1};
  const EyeCentres before = eyes_at(0), now = eyes_at(kBaseline);  // the left eye repeats
  EXPECT_FALSE(found_by_repetition(kByRight, point, before, now));
  EXPECT_FALSE(found_by_repetition(found(true, true), point, before, now));
  EXPECT_FALSE(found_by_repetition(found(false, false), point, before, now));
}

TEST(RepeatedView, is_evidence_but_no_match_at_a_novel_view) {
  for (const bool repeated : {false, true}) {
    Track track;
    track.state = State::kTentative;
    Evidence evidence{};
    evidence.outcome = AssociateOutcome::kMono;
    evidence.log_likelihood_ratio = 2;
    evidence.visible = 0.9F;
    evidence.detection = 0.83F;
    evidence.toward_viewer = {0, 0, -1};
    evidence.repeated = repeated;
    EXPECT_EQ(judge(track, evidence, 1, ExistenceParams{}).verdict, Verdict::kUndecided);
    EXPECT_EQ(track.novel_matches, repeated ? 0U : 1U);
    EXPECT_EQ(track.observations, 1U);
    EXPECT_FLOAT_EQ(track.log_odds, 2);
  }
}

// What 14 frames of a rig that shuttles by `step` baselines along its own axis make of a pair of its first frame: after
// that the left eye alone finds it in every odd frame, and the right eye alone in every even one.
State after_shuttling(double step) {
  const test::Rig rig(false, 320, 240);
  const auto accumulator = std::make_unique<Accumulator<test::PosterLimits>>();
  EXPECT_EQ(accumulator->configure(rig.rig), Status::kOk);
  const double baseline = static_cast<double>(rig.optics.baseline_m);
  for (int k = 0; k < 14; ++k) {
    const bool away = k % 2 == 1;
    const Transform<World, Left> T_w_l{{}, {away ? step * baseline : 0, 0, 0}};
    test::Edge edge{T_w_l.inverse() * Vec3{0.1, 0, 0.9}, {0, 1, 0}, {}};
    edge.look.left = {0.8F, 0.2F, 0.1F};
    edge.look.right = {0.1F, 0.3F, 0.7F};
    Primitive2d seen[2];
    EXPECT_TRUE(rig.see(edge, 0, 0, seen[0]) && rig.see(edge, 1, 0, seen[1]));
    const std::size_t left = k == 0 || away ? 1 : 0, right = k == 0 || !away ? 1 : 0;
    const Timestamp t = test::Poster::time_of(k);
    const StepReport report =
        accumulator->step(ObservedFrame{{&seen[0], left}, {&seen[1], right}, t}, Motion::camera(t, T_w_l));
    EXPECT_EQ(report.status, Status::kOk);
    EXPECT_EQ(k == 0 ? report.born : report.matched_mono, 1U) << k;
  }
  return accumulator->model().state(0);
}

TEST(RepeatedView, over_and_over_confirms_nothing) {
  EXPECT_EQ(after_shuttling(1), State::kTentative);
  EXPECT_EQ(after_shuttling(0.5), State::kConfirmed);
}

}  // namespace
}  // namespace accrete::existence
