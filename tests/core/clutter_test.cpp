// The density of chance observations: normalised, local, and aware of what colour says.
#include "associate/clutter.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/eye.h"

namespace accrete::associate {
namespace {

using test::Dice;
using test::SeenEye;

std::vector<Primitive2d> with_colours(const std::function<std::array<float, 3>(Dice&)>& colour, std::uint64_t seed) {
  Dice dice(seed);
  std::vector<Primitive2d> out;
  for (int k = 0; k < 3000; ++k) {
    Appearance a;
    a.phase = static_cast<float>(dice.uniform(-3.14, 3.14));
    a.left = colour(dice);
    a.right = colour(dice);
    out.push_back(test::element(dice.uniform(-300, 300), dice.uniform(-200, 200), dice.uniform(0, 3.14), a));
  }
  return out;
}

TEST(Clutter, grey_has_one_independent_channel_and_colour_up_to_three) {
  const auto value = [](Dice& d) { return static_cast<float>(d.uniform()); };
  const SeenEye grey(with_colours(
      [&](Dice& d) {
        const float v = value(d);
        return std::array{v, v, v};
      },
      1));
  EXPECT_NEAR(grey.clutter().independent_channels, 1, 0.01);
  const SeenEye all(with_colours([&](Dice& d) { return std::array{value(d), value(d), value(d)}; }, 2));
  EXPECT_NEAR(all.clutter().independent_channels, 3, 0.05);
  const SeenEye two(with_colours(
      [&](Dice& d) {
        const float v = value(d);
        return std::array{v, value(d), 0.5F};
      },
      3));
  EXPECT_NEAR(two.clutter().independent_channels, 2, 0.05);
  // One colour everywhere, and nothing at all.
  const SeenEye flat(with_colours([](Dice&) { return std::array{0.3F, 0.4F, 0.5F}; }, 4));
  EXPECT_EQ(flat.clutter().independent_channels, 1);
  const SeenEye nothing({});
  EXPECT_EQ(nothing.clutter().independent_channels, 1);
  EXPECT_TRUE(std::isfinite(nothing.clutter().log_appearance({})));
}

TEST(Clutter, a_grey_difference_counts_once_and_not_for_three_channels) {
  const SeenEye grey(with_colours(
      [](Dice& d) {
        const auto v = static_cast<float>(d.uniform());
        return std::array{v, v, v};
      },
      9));
  const Clutter& c = grey.clutter();
  Appearance mean, off;
  mean.left = mean.right = off.left = off.right = c.mean;
  for (float& v : off.left) v += 0.2F;
  EXPECT_NEAR(c.log_appearance(mean) - c.log_appearance(off), 0.5F * 0.04F / c.variance[0], 0.01);
}

TEST(Clutter, densities_integrate_to_one) {
  const SeenEye eye(with_colours(
      [](Dice& d) {
        return std::array{static_cast<float>(d.uniform()), static_cast<float>(d.uniform()),
                          static_cast<float>(d.uniform())};
      },
      5));
  const Clutter& c = eye.clutter();
  double phase = 0, angle = 0;
  for (const float v : c.phase_density) phase += double{v} * 2 * double{kPi} / Clutter::kPhaseBins;
  for (const float v : c.angle_density) angle += double{v} * double{kPi} / Clutter::kAngleBins;
  EXPECT_NEAR(phase, 1, 1e-5);
  EXPECT_NEAR(angle, 1, 1e-5);
  // Over phase, with the colours at their mean: what is left is the height of two independent Gaussians of colour.
  Appearance a;
  a.left = a.right = c.mean;
  double sum = 0;
  constexpr int n = 4000;
  for (int k = 0; k < n; ++k) {
    a.phase = static_cast<float>((k + 0.5) / n * 2 * double{kPi} - double{kPi});
    sum += std::exp(double{c.log_appearance(a)}) * 2 * double{kPi} / n;
  }
  double height = 1;
  for (const float v : c.variance) height /= 2 * double{kPi} * double{v};
  EXPECT_NEAR(sum / std::pow(height, double{c.independent_channels} / 3), 1, 1e-3);
}

TEST(Clutter, is_blind_to_reversal) {
  auto primitives = with_colours(
      [](Dice& d) {
        return std::array{static_cast<float>(d.uniform()), static_cast<float>(d.uniform(0.2, 0.5)), 0.1F};
      },
      6);
  auto turned = primitives;
  for (std::size_t i = 0; i < turned.size(); i += 2) turned[i].aligned = reversed(turned[i].aligned);
  const SeenEye eye(primitives), other(turned);
  Dice dice(7);
  for (std::size_t i = 0; i < 200; ++i) {
    const Appearance a = test::random_look(dice);
    EXPECT_NEAR(eye.clutter().log_appearance(a), eye.clutter().log_appearance(reversed(a)), 1e-4);
    EXPECT_NEAR(eye.clutter().log_geometry(i), other.clutter().log_geometry(i), 1e-5);
  }
}

TEST(Clutter, what_is_common_is_dense) {
  // Upright dark edges in a crowd on the left, one slanted bright edge alone on the right.
  std::vector<Primitive2d> primitives;
  Appearance dark;
  dark.phase = 1.5F;
  dark.left = dark.right = {0.1F, 0.1F, 0.1F};
  for (int k = 0; k < 100; ++k)
    primitives.push_back(test::element(-300 + 6 * (k % 10), -30 + 6 * (k / 10), double{kPi} / 2, dark));
  Appearance bright;
  bright.phase = -0.2F;
  bright.left = bright.right = {0.9F, 0.9F, 0.9F};
  primitives.push_back(test::element(300, 0, 0.8, bright));
  const SeenEye eye(primitives);
  const Clutter& c = eye.clutter();
  EXPECT_GT(c.log_geometry(50), c.log_geometry(100) + 3);
  EXPECT_GT(c.log_appearance(dark), c.log_appearance(bright) + 2);
  // In the middle of the crowd: one primitive per 36 px^2, times the length of the gate.
  const float upright = *std::max_element(c.angle_density.begin(), c.angle_density.end());
  EXPECT_NEAR(c.density[45] / upright, 2 * kSlideGate / 36, 0.1 * double{kSlideGate} / 18);
}

}  // namespace
}  // namespace accrete::associate
