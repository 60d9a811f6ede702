// Likeness of two 2D-primitives: its range, its symmetries, and what each difference costs.
#include "stereo/similarity.h"

#include <gtest/gtest.h>

#include "core/rig.h"

namespace accrete::stereo {
namespace {

using test::Dice;

Primitive2d random_primitive(Dice& dice) {
  Primitive2d p;
  const double theta = dice.uniform(0, double{kPi});
  p.theta = static_cast<float>(theta);
  p.aligned.c = static_cast<float>(std::cos(theta));
  p.aligned.s = static_cast<float>(std::sin(theta));
  p.appearance = test::random_look(dice);
  p.has_flow = dice.chance(0.5);
  p.flow_px = static_cast<float>(dice.uniform(-2, 2));
  return p;
}
// The same primitive, described in the other direction: the normal turns round, and with it the sign of the flow.
Primitive2d turned_round(const Primitive2d& p) {
  Primitive2d r = p;
  r.aligned = reversed(p.aligned);
  r.appearance = reversed(p.appearance);
  r.flow_px = -p.flow_px;
  return r;
}
bool same_sense(const Primitive2d& a, const Primitive2d& b) {
  return a.aligned.c * b.aligned.c + a.aligned.s * b.aligned.s > 0;
}
float similar(const Primitive2d& a, const Primitive2d& b) { return similarity(a, b, same_sense(a, b)); }
float mismatched(const Primitive2d& a, const Primitive2d& b) { return mismatch(a, b, same_sense(a, b)); }

TEST(Similarity, does_not_depend_on_how_either_edge_is_described) {
  Dice dice(1);
  for (int k = 0; k < 500; ++k) {
    const Primitive2d a = random_primitive(dice), b = random_primitive(dice);
    const Primitive2d ra = turned_round(a), rb = turned_round(b);
    const float s = similar(a, b), m = mismatched(a, b);
    EXPECT_NEAR(similar(ra, b), s, 2e-6);
    EXPECT_NEAR(similar(a, rb), s, 2e-6);
    EXPECT_NEAR(similar(ra, rb), s, 2e-6);
    EXPECT_NEAR(mismatched(ra, b), m, 1e-4F * (1 + m));
    EXPECT_NEAR(mismatched(a, rb), m, 1e-4F * (1 + m));
    EXPECT_NEAR(mismatched(ra, rb), m, 1e-4F * (1 + m));
    EXPECT_NEAR(similar(b, a), s, 2e-6);
    EXPECT_NEAR(mismatched(b, a), m, 1e-4F * (1 + m));
  }
}

TEST(Similarity, is_one_for_the_same_and_lies_between_nothing_and_one) {
  Dice dice(2);
  for (int k = 0; k < 500; ++k) {
    const Primitive2d a = random_primitive(dice), b = random_primitive(dice);
    EXPECT_NEAR(similar(a, a), 1, 1e-6);
    EXPECT_NEAR(similar(a, turned_round(a)), 1, 2e-6);
    EXPECT_NEAR(mismatched(a, a), 0, 1e-5);
    EXPECT_GE(similar(a, b), 0);
    EXPECT_LT(similar(a, b), 1);
    EXPECT_GT(mismatched(a, b), 0);
  }
}

TEST(Similarity, is_nothing_for_opposites) {
  // At right angles, half a turn of phase, black against white, flow against flow.
  Primitive2d a, b;
  b.aligned.c = 0;
  b.aligned.s = 1;
  a.appearance.phase = 0;
  b.appearance.phase = kPi;
  a.appearance.left = a.appearance.right = {1, 1, 1};
  EXPECT_NEAR(similarity(a, b, true), 0, 1e-3);
  a.has_flow = b.has_flow = true;
  a.flow_px = 100;
  b.flow_px = -100;
  EXPECT_NEAR(similarity(a, b, true), 0, 2e-3);
}

TEST(Similarity, each_modality_costs_what_its_weight_says) {
  // The weights sum to one with and without flow: METHOD's (.2 .25 .4 .15) and (.25 .3 .45).
  const Primitive2d a;
  const auto cost = [&](auto change, bool flow) {
    Primitive2d p = a, q = a;
    p.has_flow = q.has_flow = flow;
    change(q);
    return 1 - similarity(p, q, true);
  };
  const auto angle = [](Primitive2d& q) {
    q.aligned.c = 0;
    q.aligned.s = 1;
  };
  const auto phase = [](Primitive2d& q) { q.appearance.phase = kPi; };
  const auto colour = [](Primitive2d& q) { q.appearance.left = q.appearance.right = {1, 1, 1}; };
  const auto one_side = [](Primitive2d& q) { q.appearance.left = {1, 1, 1}; };
  EXPECT_NEAR(cost(angle, false) + cost(phase, false) + cost(colour, false), 1, 1e-3);
  const float without_flow = cost(angle, true) + cost(phase, true) + cost(colour, true);
  EXPECT_LT(without_flow, 0.95F);
  EXPECT_NEAR(without_flow + cost([](Primitive2d& q) { q.flow_px = 1e6F; }, true), 1, 1e-3);
  EXPECT_NEAR(cost(one_side, false), 0.5F * cost(colour, false), 1e-4);
  // Flow counts only where both have one.
  Primitive2d p = a, q = a;
  p.has_flow = true;
  p.flow_px = 3;
  EXPECT_NEAR(similarity(p, q, true), 1, 1e-6);
}

TEST(Mismatch, one_side_may_be_another_background) {
  Primitive2d a, b;
  b.appearance.left = {1, 1, 1};
  const float one = mismatch(a, b, true);
  b.appearance.right = {1, 1, 1};
  const float both = mismatch(a, b, true);
  EXPECT_LE(one, 9.001F);  // capped: 3 sigma
  EXPECT_NEAR(both, 2 * one, 1e-4);
}

TEST(Mismatch, phases_are_compared_on_the_circle) {
  Primitive2d a, b;
  a.appearance.phase = kPi - 0.05F;
  b.appearance.phase = -kPi + 0.05F;
  const float across = mismatch(a, b, true);
  a.appearance.phase = 0.05F;
  b.appearance.phase = -0.05F;
  EXPECT_NEAR(across, mismatch(a, b, true), 1e-4);
}

}  // namespace
}  // namespace accrete::stereo
