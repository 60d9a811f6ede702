// One to one, by geometry and appearance; what is undecided is said to be.
#include "associate/associate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "core/eye.h"

namespace accrete::associate {
namespace {

using namespace test;

constexpr double kUpright = 1.5707963267948966;

// Contours and their expected primitives, the same look in both eyes, 30 px of disparity.
struct Scene {
  std::vector<Primitive2d> left, right;
  std::vector<Expected> expected;
  Dice dice;

  explicit Scene(std::uint64_t seed) : dice(seed) {}

  void add(double x, double y, double theta, const Appearance& look) {
    left.push_back(element(x, y, theta, look));
    right.push_back(element(x - 30, y, theta, look));
    // Expected a little beside it.
    const Primitive2d l = element(x + dice.normal(0.3), y + dice.normal(0.3), theta + dice.normal(0.01), look);
    const Primitive2d r = element(x - 30 + dice.normal(0.3), y + dice.normal(0.3), theta + dice.normal(0.01), look);
    expected.push_back(expect_at(l.aligned, r.aligned, look));
  }
  // Random elements that keep their distance from each other.
  static Scene random(std::size_t n, double distance, std::uint64_t seed) {
    Scene s(seed);
    for (int tries = 0; s.left.size() < n && tries < 100000; ++tries) {
      const double x = s.dice.uniform(-280, 280), y = s.dice.uniform(-200, 200);
      const bool free = std::none_of(s.left.begin(), s.left.end(), [&](const Primitive2d& p) {
        return std::hypot(p.aligned.x_px - x, p.aligned.y_px - y) < distance;
      });
      if (free) s.add(x, y, s.dice.uniform(0, 6.28), random_look(s.dice));
    }
    return s;
  }
};

bool one_to_one(const Associator& a) {
  std::set<std::int32_t> left, right;
  for (std::size_t i = 0; i < a.out.size(); ++i) {
    const Association& o = a.out[i];
    const bool matched = o.outcome == AssociateOutcome::kStereo || o.outcome == AssociateOutcome::kMono;
    if (!matched && (o.left != kNone || o.right != kNone)) return false;
    if (o.left != kNone &&
        (!left.insert(o.left).second || a.left_owner[static_cast<std::size_t>(o.left)] != static_cast<std::int32_t>(i)))
      return false;
    if (o.right != kNone && (!right.insert(o.right).second ||
                             a.right_owner[static_cast<std::size_t>(o.right)] != static_cast<std::int32_t>(i)))
      return false;
    if (o.outcome == AssociateOutcome::kStereo && (o.left == kNone || o.right == kNone)) return false;
    if (o.outcome == AssociateOutcome::kMono && (o.left == kNone) == (o.right == kNone)) return false;
  }
  const auto owned = [](const std::vector<std::int32_t>& v) {
    return static_cast<std::size_t>(std::count_if(v.begin(), v.end(), [](std::int32_t o) { return o != kNone; }));
  };
  return owned(a.left_owner) == left.size() && owned(a.right_owner) == right.size();
}

TEST(Associate, well_separated_primitives_find_their_own_observations) {
  Scene s = Scene::random(150, 20, 1);
  const SeenEye left(s.left), right(s.right);
  Associator associate;
  int stereo = 0;
  const auto& out = associate(s.expected, left, right);
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out[i].left != kNone) {
      EXPECT_EQ(out[i].left, static_cast<std::int32_t>(i));
    }
    if (out[i].right != kNone) {
      EXPECT_EQ(out[i].right, static_cast<std::int32_t>(i));
    }
    stereo += out[i].outcome == AssociateOutcome::kStereo;
    EXPECT_TRUE(std::isfinite(out[i].log_likelihood_ratio));
  }
  EXPECT_GT(stereo, 135);  // gates of 99 and 99.9 %
  EXPECT_TRUE(one_to_one(associate));
}

TEST(Associate, is_one_to_one_however_crowded) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Scene s(seed);
    const Appearance look = random_look(s.dice);
    // One look, few orientations, far denser than an image can be.
    for (int k = 0; k < 150; ++k)
      s.add(s.dice.uniform(-40, 40), s.dice.uniform(-40, 40), 0.2 * static_cast<double>(s.dice.below(3)), look);
    const SeenEye left(s.left), right(s.right);
    Associator associate;
    associate(s.expected, left, right);
    EXPECT_TRUE(one_to_one(associate)) << seed;
  }
}

TEST(Associate, order_of_primitives_and_of_observations_does_not_matter) {
  Scene s = Scene::random(120, 7, 2);
  const SeenEye left(s.left), right(s.right);
  Associator first;
  first(s.expected, left, right);
  Dice dice(3);
  for (int round = 0; round < 5; ++round) {
    const auto shuffle = [&](std::size_t n) {
      std::vector<std::size_t> order(n);
      std::iota(order.begin(), order.end(), std::size_t{0});
      for (std::size_t i = n; i > 1; --i) std::swap(order[i - 1], order[dice.below(i)]);
      return order;
    };
    const auto pe = shuffle(s.expected.size()), pl = shuffle(s.left.size()), pr = shuffle(s.right.size());
    std::vector<Expected> expected;
    std::vector<Primitive2d> l, r;
    for (const std::size_t i : pe) expected.push_back(s.expected[i]);
    for (const std::size_t i : pl) l.push_back(s.left[i]);
    for (const std::size_t i : pr) r.push_back(s.right[i]);
    const SeenEye left2(l), right2(r);
    Associator second;
    second(expected, left2, right2);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const Association &a = first.out[pe[i]], &b = second.out[i];
      EXPECT_EQ(a.outcome, b.outcome);
      EXPECT_NEAR(a.log_likelihood_ratio, b.log_likelihood_ratio, 1e-4);
      const auto name = [](std::int32_t k, const std::vector<std::size_t>& order) {
        return k == kNone ? kNone : static_cast<std::int32_t>(order[static_cast<std::size_t>(k)]);
      };
      EXPECT_EQ(a.left, name(b.left, pl));
      EXPECT_EQ(a.right, name(b.right, pr));
    }
  }
}

TEST(Associate, does_not_depend_on_how_observations_are_described) {
  Scene s = Scene::random(120, 12, 4);
  Associator one, two;
  const SeenEye l1(s.left), r1(s.right);
  one(s.expected, l1, r1);
  std::vector<bool> turned_l, turned_r;
  for (auto* list : {&s.left, &s.right})
    for (Primitive2d& p : *list) {
      const bool turn = s.dice.chance(0.5);
      (list == &s.left ? turned_l : turned_r).push_back(turn);
      if (!turn) continue;
      p.aligned = reversed(p.aligned);
      p.appearance = reversed(p.appearance);
    }
  const SeenEye l2(s.left), r2(s.right);
  two(s.expected, l2, r2);
  for (std::size_t i = 0; i < one.out.size(); ++i) {
    const Association &a = one.out[i], &b = two.out[i];
    EXPECT_EQ(a.outcome, b.outcome);
    EXPECT_EQ(a.left, b.left);
    EXPECT_EQ(a.right, b.right);
    EXPECT_NEAR(a.log_likelihood_ratio, b.log_likelihood_ratio, 2e-3F * (1 + std::fabs(a.log_likelihood_ratio)));
    if (a.left != kNone) {
      EXPECT_EQ(b.left_sense, (a.left_sense != 0) != turned_l[static_cast<std::size_t>(a.left)]);
    }
    if (a.right != kNone) {
      EXPECT_EQ(b.right_sense, (a.right_sense != 0) != turned_r[static_cast<std::size_t>(a.right)]);
    }
  }
}

// The bracket of METHOD 7.2, for two eyes that detect independently with p_d each.
TEST(Associate, likelihood_ratio_is_the_bracket_of_both_eyes) {
  Dice dice(5);
  const Appearance look = random_look(dice);
  // Something elsewhere, so that clutter is measured on more than one primitive.
  const std::vector<Primitive2d> far = {element(200, 100, 0.3, random_look(dice)),
                                        element(-200, 90, 2.3, random_look(dice))};
  for (const float visible : {1.0F, 0.7F, 0.2F, 0.0F})
    for (const float detection : {0.3F, 0.83F}) {
      for (int seen = 0; seen < 4; ++seen) {  // bit 0: in the left eye, bit 1: in the right one
        std::vector<Primitive2d> l = far, r = far;
        const Primitive2d pl = element(10, 5, 1, look), pr = element(-20, 5, 1, look);
        if ((seen & 1) != 0) l.push_back(pl);
        if ((seen & 2) != 0) r.push_back(pr);
        const SeenEye left(l), right(r);
        Expected e = expect_at(pl.aligned, pr.aligned, look);
        e.predicted.x_l += 0.2F;
        e.visible = visible;
        e.detection = detection;
        Associator associate;
        const Association a = associate({&e, 1}, left, right)[0];
        // P_G = 0.99; whether also 0.999 is taken in is below the tolerance.
        const double q = 1 - 0.99 * double{detection}, d = detection, v = visible;
        double bracket = 1 - v + v * q * q;
        const std::size_t i = far.size();
        const auto& P = e.predicted;
        const auto appearance = [&](const SeenEye& eye, float sp, float sc) {
          return double{appearance_likelihood(e.mean, e.variance, look, sp, sc, eye.clutter().independent_channels)
                            .log_g} -
                 double{eye.clutter().log_appearance(look)};
        };
        const Residual rl = residual(P.x_l, P.y_l, P.c_l, P.s_l, pl.aligned);
        const Residual rr = residual(P.x_r, P.y_r, P.c_r, P.s_r, pr.aligned);
        const double al = seen & 1 ? appearance(left, pl.sigma_phase, pl.sigma_colour) : 0;
        const double ar = seen & 2 ? appearance(right, pr.sigma_phase, pr.sigma_colour) : 0;
        if (seen == 1)
          bracket += v * d * (1 - d) *
                     std::exp(double{mono_likelihood(P, 0, rl, pl.aligned, e.noise).log_g} -
                              double{left.clutter().log_geometry(i)} + al);
        if (seen == 2)
          bracket += v * d * (1 - d) *
                     std::exp(double{mono_likelihood(P, 1, rr, pr.aligned, e.noise).log_g} -
                              double{right.clutter().log_geometry(i)} + ar);
        if (seen == 3)
          bracket += v * d * d *
                     std::exp(double{stereo_likelihood(P, rl, pl.aligned, rr, pr.aligned, e.noise).log_g} -
                              double{left.clutter().log_geometry(i)} - double{right.clutter().log_geometry(i)} + al);
        EXPECT_NEAR(a.log_likelihood_ratio, std::log(bracket), 0.02) << seen << ' ' << visible << ' ' << detection;
        // Something seen is evidence for, nothing seen against, and where nothing can be seen there is none.
        if (visible == 0) {
          EXPECT_NEAR(a.log_likelihood_ratio, 0, 1e-5);
        } else if (seen == 0) {
          EXPECT_LT(a.log_likelihood_ratio, 0);
          EXPECT_EQ(a.outcome, AssociateOutcome::kMissed);
        } else {
          EXPECT_GT(a.log_likelihood_ratio, 0);
          EXPECT_EQ(a.outcome, seen == 3 ? AssociateOutcome::kStereo : AssociateOutcome::kMono);
        }
      }
    }
}

TEST(Associate, certain_predictions_make_matches_count_more) {
  Dice dice(6);
  const Appearance look = random_look(dice);
  std::vector<Primitive2d> l = {element(0, 0, 1, look)}, r = {element(-30, 0, 1, look)};
  // A crowd of the same look all around, but beyond the widest gate.
  for (int k = 0; k < 400; ++k) {
    const double angle = dice.uniform(0, 6.28), distance = dice.uniform(25, 60), theta = dice.uniform(0, 3);
    l.push_back(element(distance * std::cos(angle), distance * std::sin(angle), theta, look));
    r.push_back(element(distance * std::cos(angle) - 30, distance * std::sin(angle), theta, look));
  }
  const SeenEye left(l), right(r);
  float last = 29;  // beyond that, ratios are cut off
  for (const double sigma : {0.2, 0.8, 2.0, 4.0}) {
    Associator associate;
    const Expected e = expect_at(l[0].aligned, r[0].aligned, look, sigma, 0.05 * sigma);
    const Association a = associate({&e, 1}, left, right)[0];
    EXPECT_EQ(a.outcome, AssociateOutcome::kStereo);
    EXPECT_LT(a.log_likelihood_ratio, last - 0.5F);
    last = a.log_likelihood_ratio;
  }
}

TEST(Associate, two_primitives_of_one_contour_and_one_observation_starve_one_of_them) {
  Dice dice(7);
  const Appearance look = random_look(dice);
  const Primitive2d l = element(0, 0, kUpright, look), r = element(-30, 0, kUpright, look);
  const SeenEye left({l}), right({r});
  const auto at = [&](double x, double y) {
    return expect_at(element(x, y, kUpright, look).aligned, element(x - 30, y, kUpright, look).aligned, look);
  };
  // Both on the vertical line, 1 px before and 2.5 px behind the observation.
  const std::vector<Expected> same = {at(0.1, -1), at(-0.1, 2.5)};
  Associator associate;
  const auto& out = associate(same, left, right);
  const int winner = out[0].outcome == AssociateOutcome::kStereo ? 0 : 1;
  EXPECT_EQ(out[static_cast<std::size_t>(winner)].outcome, AssociateOutcome::kStereo);
  EXPECT_EQ(out[static_cast<std::size_t>(1 - winner)].outcome, AssociateOutcome::kStarved);
  EXPECT_EQ(out[static_cast<std::size_t>(1 - winner)].log_likelihood_ratio, 0);
  EXPECT_TRUE(one_to_one(associate));
  // A primitive of another contour that reaches for the same observation has missed its own: that is evidence.
  std::vector<Expected> other = {at(0, 0), at(3.2, 0)};
  for (const std::size_t i : {std::size_t{0}, std::size_t{2}})
    other[1].predicted.covariance[packed_index(4, i, i)] = 1.0F;
  other[0].predicted.covariance[packed_index(4, 0, 0)] = other[0].predicted.covariance[packed_index(4, 2, 2)] = 0.01F;
  const auto& apart = associate(other, left, right);
  EXPECT_EQ(apart[0].outcome, AssociateOutcome::kStereo);
  EXPECT_NE(apart[1].outcome, AssociateOutcome::kStereo);
}

TEST(Associate, two_contours_that_fit_alike_are_ambiguous) {
  Dice dice(8);
  const Appearance look = random_look(dice);
  Appearance other = look;
  for (float& c : other.left) c = c > 0.5F ? 0 : 1;
  for (float& c : other.right) c = c > 0.5F ? 0 : 1;
  const Expected e =
      expect_at(element(0, 0, kUpright, look).aligned, element(-30, 0, kUpright, look).aligned, look, 1, 0.05);
  const auto run = [&](double first, double second, const Appearance& look2) {
    const SeenEye left({element(first, 0, kUpright, look), element(second, 0, kUpright, look2)});
    const SeenEye right({element(first - 30, 0, kUpright, look), element(second - 30, 0, kUpright, look2)});
    Associator associate;
    return associate({&e, 1}, left, right)[0];
  };
  const Association a = run(-1.2, 1.2, look);
  EXPECT_EQ(a.outcome, AssociateOutcome::kAmbiguous);
  EXPECT_EQ(a.log_likelihood_ratio, 0);
  EXPECT_EQ(a.left, kNone);
  // Not where one lies much nearer, nor where the looks decide.
  EXPECT_EQ(run(0, 2.9, look).left, 0);
  EXPECT_EQ(run(-1.2, 1.2, other).left, 0);
  // And two samples of one contour are no two contours.
  const SeenEye left({element(0, -2, kUpright, look), element(0.2, 2, kUpright, look)});
  const SeenEye right({element(-30, -2, kUpright, look), element(-29.8, 2, kUpright, look)});
  Associator associate;
  EXPECT_EQ(associate({&e, 1}, left, right)[0].outcome, AssociateOutcome::kStereo);
}

TEST(Associate, what_slid_too_far_or_looks_too_different_is_missed) {
  Dice dice(9);
  const Appearance look = random_look(dice);
  Appearance opposite = look;
  opposite.phase = look.phase > 0 ? look.phase - 3.1F : look.phase + 3.1F;
  for (auto* side : {&opposite.left, &opposite.right})
    for (float& c : *side) c = c > 0.5F ? 0 : 1;
  const Expected e = expect_at(element(0, 0, kUpright, look).aligned, element(-30, 0, kUpright, look).aligned, look);
  const auto run = [&](double x, double y, double theta, const Appearance& a) {
    const SeenEye left({element(x, y, theta, a)}), right({element(x - 30, y, theta, a)});
    Associator associate;
    return associate({&e, 1}, left, right)[0].outcome;
  };
  EXPECT_EQ(run(0.2, 1, kUpright, look), AssociateOutcome::kStereo);
  EXPECT_EQ(run(0.2, double{kSlideGate} + 0.5, kUpright, look), AssociateOutcome::kMissed);
  EXPECT_EQ(run(6, 0, kUpright, look), AssociateOutcome::kMissed);
  EXPECT_EQ(run(0, 0, kUpright + 0.5, look), AssociateOutcome::kMissed);
  EXPECT_EQ(run(0, 0, kUpright, opposite), AssociateOutcome::kMissed);
}

TEST(Associate, says_which_stereo_pairs_are_explained_although_not_matched) {
  // Two samples of the contour, one expected primitive between them: no birth at the one that it does not take.
  Dice dice(10);
  const Appearance look = random_look(dice);
  const SeenEye left(
      {element(0, -2, kUpright, look), element(0, 2.5, kUpright, look), element(100, 0, kUpright, look)});
  const SeenEye right(
      {element(-30, -2, kUpright, look), element(-30, 2.5, kUpright, look), element(70, 0, kUpright, look)});
  const Expected e = expect_at(element(0, 0, kUpright, look).aligned, element(-30, 0, kUpright, look).aligned, look);
  Associator associate;
  associate({&e, 1}, left, right);
  const auto explained = [&](std::size_t l, std::uint16_t r) {
    const Explained& x = associate.explained[l];
    return std::find(x.right.begin(), x.right.begin() + x.count, r) != x.right.begin() + x.count;
  };
  EXPECT_TRUE(explained(0, 0));
  EXPECT_TRUE(explained(1, 1));
  EXPECT_FALSE(explained(2, 2));
}

}  // namespace
}  // namespace accrete::associate
