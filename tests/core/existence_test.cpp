// Existence as a sequential test: identities, the n-scan rules, and the scenario of METHOD 7.5.
#include <gtest/gtest.h>

#include <vector>

#include "core/rig.h"
#include "existence/evidence.h"
#include "existence/judge.h"
#include "existence/n_scan.h"

namespace accrete::existence {
namespace {

using associate::AssociateOutcome;
using test::Dice;

TEST(Evidence, probability_and_log_odds_are_inverse_to_each_other) {
  for (float l = -8; l <= 8; l += 0.25F) EXPECT_NEAR(log_odds(probability(l)), l, 2e-3);
  EXPECT_NEAR(probability(4.6F), 0.99, 1e-4);
  EXPECT_NEAR(log_odds(0.5F), 0, 1e-7);
}

// Musicki, Evans and Stankovic write the posterior as (1 - d) p / (1 - d p) with d = 1 - L; Bayes as L p / (1 - p + L
// p).
TEST(Evidence, an_update_of_log_odds_is_the_posterior_of_ipda) {
  Dice dice(1);
  for (int k = 0; k < 500; ++k) {
    const double p = dice.uniform(0.02, 0.98), L = std::exp(dice.uniform(-1.9, 1.9)), delta = 1 - L;
    const double bayes = L * p / (1 - p + L * p), ipda = (1 - delta) * p / (1 - delta * p);
    EXPECT_NEAR(bayes, ipda, 1e-12);
    const float l = updated_log_odds(log_odds(static_cast<float>(p)), static_cast<float>(std::log(L)), 1, 50);
    EXPECT_NEAR(probability(l), bayes, 1e-5);
  }
}

TEST(Evidence, one_frame_is_bounded_weighted_and_clamped) {
  // Beyond its bound more evidence is no more; the bound lies below what decides.
  const float most = updated_log_odds(0, 1e9F, 1, 50), least = updated_log_odds(0, -1e9F, 1, 50);
  EXPECT_GT(most, 1);
  EXPECT_LT(least, -1);
  EXPECT_LT(most, ExistenceParams{}.decide);
  EXPECT_GT(least, -ExistenceParams{}.decide);
  EXPECT_EQ(updated_log_odds(0, 100, 1, 50), most);
  EXPECT_NEAR(updated_log_odds(0.5F, 1, 0.3F, 50), 0.8, 1e-6);
  EXPECT_EQ(updated_log_odds(1.25F, 5, 0, 50), 1.25F);  // nothing new: nothing learnt
  EXPECT_EQ(updated_log_odds(5.9F, 2, 1, 6), 6);
  EXPECT_EQ(updated_log_odds(-5.9F, -2, 1, 6), -6);
}

View random_view(Dice& dice) {
  View v;
  const auto place = [&](float& x, float& y, float& c, float& s) {
    x = static_cast<float>(dice.uniform(-300, 300));
    y = static_cast<float>(dice.uniform(-200, 200));
    const double a = dice.uniform(0, 6.28);
    c = static_cast<float>(std::cos(a));
    s = static_cast<float>(std::sin(a));
  };
  place(v.x_l, v.y_l, v.c_l, v.s_l);
  place(v.x_r, v.y_r, v.c_r, v.s_r);
  return v;
}
View moved(const View& v, double across, double along, double turn) {
  View m = v;
  const auto move = [&](float& x, float& y, float& c, float& s) {
    const double c0 = c, s0 = s;
    x = static_cast<float>(x + along * c0 - across * s0);
    y = static_cast<float>(y + along * s0 + across * c0);
    c = static_cast<float>(c0 * std::cos(turn) - s0 * std::sin(turn));
    s = static_cast<float>(s0 * std::cos(turn) + c0 * std::sin(turn));
  };
  move(m.x_l, m.y_l, m.c_l, m.s_l);
  move(m.x_r, m.y_r, m.c_r, m.s_r);
  return m;
}
View reversed(const View& v) {
  View r = v;
  r.c_l = -v.c_l, r.s_l = -v.s_l, r.c_r = -v.c_r, r.s_r = -v.s_r;
  return r;
}

TEST(Novelty, is_nothing_for_the_same_view_and_grows_to_one) {
  Dice dice(2);
  for (int k = 0; k < 100; ++k) {
    const View v = random_view(dice);
    EXPECT_NEAR(novelty(v, v, 0.3F, 0.03F), 0, 1e-6);
    EXPECT_NEAR(novelty(v, moved(v, 0, 20, 0), 0.3F, 0.03F), 0, 1e-4);  // along the edge: nothing new
    float last = 0;
    for (const double across : {0.2, 0.6, 1.2, 3.0}) {
      const float n = novelty(v, moved(v, across, 0, 0), 0.3F, 0.03F);
      EXPECT_GT(n, last);
      last = n;
    }
    EXPECT_GT(last, 0.99F);
    EXPECT_GT(novelty(v, moved(v, 0, 0, 0.3), 0.3F, 0.03F), 0.99F);  // a turn alone is new
    // In units of what is known: the same step says less of an uncertain prediction.
    EXPECT_LT(novelty(v, moved(v, 1, 0, 0), 3, 0.3F), novelty(v, moved(v, 1, 0, 0), 0.3F, 0.03F));
  }
}

TEST(Novelty, is_blind_to_reversal) {
  Dice dice(3);
  for (int k = 0; k < 200; ++k) {
    const View a = random_view(dice), b = moved(a, dice.uniform(-1, 1), dice.uniform(-5, 5), dice.uniform(-0.1, 0.1));
    const float n = novelty(a, b, 0.4F, 0.04F);
    EXPECT_NEAR(novelty(reversed(a), b, 0.4F, 0.04F), n, 1e-4);
    EXPECT_NEAR(novelty(a, reversed(b), 0.4F, 0.04F), n, 1e-4);
    EXPECT_NEAR(deviations_apart(reversed(a), reversed(b), 0.4F, 0.04F), deviations_apart(a, b, 0.4F, 0.04F), 1e-3);
    EXPECT_NEAR(displacement_px(reversed(a), b), displacement_px(a, b), 1e-4);
  }
}

TEST(NScan, probabilistic_miss_run_with_constant_detection_is_the_classical_rule) {
  // METHOD 7.4: n = 2, 3, 4 for alpha = .05, .01, .001 at a detection rate of .83.
  EXPECT_EQ(classical_n(0.05, 0.83), 2);
  EXPECT_EQ(classical_n(0.01, 0.83), 3);
  EXPECT_EQ(classical_n(0.001, 0.83), 4);
  Dice dice(4);
  for (const double alpha : {0.2, 0.05, 0.01, 0.005, 0.001, 1e-4})
    for (const double detection : {0.3, 0.5, 0.7, 0.83, 0.9, 0.95, 0.99}) {
      const int n = classical_n(alpha, detection);
      // Whatever the history of matches and misses, both decide in the same frame.
      for (int history = 0; history < 20; ++history) {
        float run = 0;
        int misses = 0;
        for (int frame = 0; frame < 60; ++frame) {
          const bool matched = dice.chance(0.3);
          misses = matched ? 0 : misses + 1;
          run = miss_run(run, matched, static_cast<float>(detection));
          ASSERT_EQ(delete_by_miss_run(run, static_cast<float>(alpha)), misses >= n)
              << alpha << ' ' << detection << ' ' << misses;
        }
      }
    }
}

TEST(NScan, misses_where_nothing_can_be_seen_do_not_count) {
  float run = 0;
  for (int k = 0; k < 1000; ++k) run = miss_run(run, false, 0);
  EXPECT_EQ(run, 0);
  EXPECT_FALSE(delete_by_miss_run(run, 0.01F));
  // Partly visible: slower in proportion to what the look could have found.
  float dim = 0, clear = 0;
  int k_dim = 0, k_clear = 0;
  for (; !delete_by_miss_run(dim, 0.01F); ++k_dim) dim = miss_run(dim, false, 0.2F);
  for (; !delete_by_miss_run(clear, 0.01F); ++k_clear) clear = miss_run(clear, false, 0.83F);
  EXPECT_EQ(k_clear, 3);
  EXPECT_EQ(k_dim, classical_n(0.01, 0.2));
}

TEST(NScan, window_is_a_bayes_test_of_the_last_scans) {
  const std::vector<float> scans = {0.7F, -1.2F, -1.2F, 0.7F, -1.2F};
  EXPECT_TRUE(delete_by_window(scans, -2.1F));  // their sum is -2.2
  EXPECT_FALSE(delete_by_window(scans, -2.3F));
  EXPECT_FALSE(delete_by_window({}, -1));
}

TEST(NScan, sequential_test_needs_evidence_novel_views_and_the_given_motion) {
  const ExistenceParams params;
  Track t;
  t.log_odds = params.decide + 0.1F;
  t.novel_matches = static_cast<std::uint32_t>(params.min_novel_matches);
  t.motion_log_odds = params.decide + 0.1F;
  EXPECT_EQ(sequential(t, params), Verdict::kConfirm);
  Track u = t;
  u.log_odds = params.decide - 0.1F;
  EXPECT_EQ(sequential(u, params), Verdict::kUndecided);
  u = t;
  u.novel_matches -= 1;
  EXPECT_EQ(sequential(u, params), Verdict::kUndecided);
  u = t;
  u.motion_log_odds = 0;
  EXPECT_EQ(sequential(u, params), Verdict::kUndecided);
  u = t;
  u.log_odds = -params.decide - 0.1F;
  EXPECT_EQ(sequential(u, params), Verdict::kDelete);
}

// METHOD 7.5: true edges are matched in .83 of the frames in which they can be seen, false ones by chance in .41 of
// all. A hidden true edge is matched by chance, too. Hidden in frames 30 to 69; the prior is .46.
struct Scenario {
  double true_alive = 0, false_alive = 0;

  // `visibility(hidden)` is what the model believes.
  template <class Visibility>
  Scenario(Visibility visibility, std::uint64_t seed) {
    constexpr int tracks = 4000, frames = 100;
    constexpr double on_true = 0.83, on_false = 0.41;
    const ExistenceParams params;
    Dice dice(seed);
    for (int real = 0; real < 2; ++real) {
      int alive = 0;
      for (int k = 0; k < tracks; ++k) {
        Track track;
        track.log_odds = log_odds(0.46F);
        bool deleted = false;
        for (int frame = 0; frame < frames && !deleted; ++frame) {
          const bool hidden = frame >= 30 && frame < 70;
          const bool matched = !hidden && dice.chance(real != 0 ? on_true : on_false);
          // P(match | exists) over P(match | does not), where existing shows only as far as it is visible.
          const double v = visibility(hidden), p = v * on_true + (1 - v) * on_false;
          const double ratio = matched ? p / on_false : (1 - p) / (1 - on_false);
          track.log_odds = updated_log_odds(track.log_odds, static_cast<float>(std::log(ratio)), 1, params.clamp);
          deleted = sequential(track, params) == Verdict::kDelete;
        }
        alive += !deleted;
      }
      (real != 0 ? true_alive : false_alive) = static_cast<double>(alive) / tracks;
    }
  }
};

TEST(Occlusion, with_a_good_visibility_true_edges_survive_forty_hidden_frames_and_false_ones_do_not) {
  const Scenario good([](bool hidden) { return hidden ? 0.0 : 1.0; }, 1);
  EXPECT_GE(good.true_alive, 0.98);   // measured in METHOD: .994
  EXPECT_LE(good.false_alive, 0.01);  // .001
  const Scenario fair([](bool hidden) { return hidden ? 0.05 : 0.98; }, 2);
  EXPECT_GE(fair.true_alive, 0.97);
  EXPECT_LE(fair.false_alive, 0.01);
}

TEST(Occlusion, without_a_visibility_no_rule_preserves) {
  const Scenario blind([](bool) { return 1.0; }, 3);
  EXPECT_EQ(blind.true_alive, 0);
  // The classical rule, three misses in a row, at the same rates.
  Dice dice(4);
  int alive = 0;
  for (int k = 0; k < 4000; ++k) {
    float run = 0;
    bool deleted = false;
    for (int frame = 0; frame < 100 && !deleted; ++frame) {
      const bool hidden = frame >= 30 && frame < 70;
      run = miss_run(run, !hidden && dice.chance(0.83), 0.83F);
      deleted = delete_by_miss_run(run, 0.01F);
    }
    alive += !deleted;
  }
  EXPECT_EQ(alive, 0);
}

}  // namespace
}  // namespace accrete::existence
