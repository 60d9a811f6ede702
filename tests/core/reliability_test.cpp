// What is learned of the invariance of an appearance: nothing of what is constant, the variance of what is not.
#include "filter/reliability.h"

#include <gtest/gtest.h>

#include "base/angles.h"
#include "filter/update.h"
#include "numeric/dice.h"

namespace accrete {
namespace {

constexpr float kSigma = 0.03F;

// A track whose left red channel swings by `swing` and whose phase swings by `phase`, updated by the filter.
Reliability track(unsigned seed, float swing, float phase, int looks, bool left_is_background = false) {
  oracle::Dice dice(seed);
  std::vector<AppearanceBlock> block(1);
  AppearanceState s;
  s.mean = {3.0F, {0.5F, 0.4F, 0.3F}, {0.2F, 0.3F, 0.4F}};
  for (std::size_t i = 0; i < 7; ++i) s.covariance[packed_index(7, i, i)] = kSigma * kSigma;
  store(s, block[0], 0);
  Reliability r;
  const std::vector<std::uint32_t> slot{0};
  const std::vector<float> sigma{kSigma}, q{1e-8F};
  for (int n = 1; n <= looks; ++n) {
    const auto noise = [&] { return kSigma * static_cast<float>(dice.normal()); };
    const auto angle = static_cast<float>(dice.uniform(0, 2 * double{kPi}));
    Appearance seen{wrap_two_pi(3.0F + phase * std::sin(angle) + noise()), {}, {}};
    for (std::size_t c = 0; c < 3; ++c) {
      seen.left[c] = std::array{0.5F, 0.4F, 0.3F}[c] + noise() + (c == 0 ? swing * std::cos(angle) : 0.0F);
      seen.right[c] = std::array{0.2F, 0.3F, 0.4F}[c] + noise();
    }
    learn(load(block[0], 0), seen, {kSigma, kSigma, kSigma, 1e-8F, 1e-8F, left_is_background, false},
          static_cast<std::uint32_t>(n), r);
    std::vector<UpdateOutcome> out(1);
    const std::vector<Appearance> look{seen};
    update_appearance(block, slot, look, sigma, sigma, sigma, q, q, out);
    EXPECT_EQ(out[0], UpdateOutcome::kUpdated);
  }
  return r;
}

TEST(Reliability, is_nothing_in_the_mean_for_what_is_constant) {
  double sum = 0;
  for (unsigned seed = 0; seed < 100; ++seed)
    for (const float e : track(seed, 0, 0, 60).excess) sum += double{e} / 700;
  EXPECT_NEAR(sum, 0, 0.05 * kSigma * kSigma);
}

TEST(Reliability, is_the_variance_of_what_changes) {
  double red = 0, phase = 0, others = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    const Reliability r = track(seed, 0.2F, 0.4F, 60);
    red += r.scatter(1) / 100;
    phase += r.scatter(0) / 100;
    others += (r.scatter(2) + r.scatter(4)) / 200;
  }
  EXPECT_NEAR(red, 0.5 * 0.2 * 0.2, 0.003);  // of a sine: half the square of its amplitude
  EXPECT_NEAR(phase, 0.5 * 0.4 * 0.4, 0.01);
  EXPECT_LT(others, 0.5 * kSigma * kSigma);
}

TEST(Reliability, learns_nothing_from_background) {
  const Reliability r = track(1, 0.3F, 0.5F, 40, true);
  for (const std::size_t i : {0U, 1U, 2U, 3U}) EXPECT_EQ(r.excess[i], 0.0F);
  EXPECT_NE(r.excess[4], 0.0F);
}

TEST(Reliability, goes_with_its_sides) {
  const Reliability r{{0, 1, 2, 3, 4, 5, 6}};
  EXPECT_EQ(reversed(r).excess, (std::array<float, 7>{0, 4, 5, 6, 1, 2, 3}));
  EXPECT_EQ(reversed(reversed(r)).excess, r.excess);
  const Reliability below{{-1, 0.5F}};
  EXPECT_EQ(below.scatter(0), 0.0F);
  EXPECT_EQ(below.scatter(1), 0.5F);
}

}  // namespace
}  // namespace accrete
