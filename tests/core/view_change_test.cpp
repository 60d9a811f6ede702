// Which side of an edge is background, against geometry in double precision and the laws that it must keep.
#include "filter/view_change.h"

#include <gtest/gtest.h>

#include "accrete/geometry.h"
#include "base/angles.h"
#include "core/rig.h"

namespace accrete {
namespace {

using test::Dice;

Geometry random_geometry(std::uint64_t seed) {
  Dice dice(seed);
  Quaternion q;
  q.x = dice.normal(), q.y = dice.normal(), q.z = dice.normal(), q.w = dice.normal();
  q = normalized(q).value();
  Geometry g;
  g.quaternion = {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z), static_cast<float>(q.w)};
  return g;
}

// Towards a viewer who stands `turned` rad to the right of the mean viewing direction, and `along` rad along the edge.
Vec3f viewer(const Geometry& g, double turned, double along = 0) {
  const Mat3 R =
      to_matrix({double{g.quaternion[0]}, double{g.quaternion[1]}, double{g.quaternion[2]}, double{g.quaternion[3]}});
  const Vec3 own{std::sin(along), std::cos(along) * std::sin(turned), -std::cos(along) * std::cos(turned)};
  const Vec3 v = R * own;
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

AppearanceState known(const Vec3f& left, const Vec3f& right) {
  AppearanceState s;
  s.mean.left = left;
  s.mean.right = right;
  s.mean.phase = kPi / 2;
  for (std::size_t k = 0; k < 7; ++k) s.covariance[packed_index(7, k, k)] = 1e-4F;
  return s;
}

const Vec3f kRed{0.8F, 0.3F, 0.3F}, kBlue{0.2F, 0.3F, 0.8F}, kWall{0.55F, 0.56F, 0.57F};

// One look at a red face on the left and a blue one on the right.
struct Crease {
  Geometry geometry;
  AppearanceState state = known(kRed, kBlue);
  HiddenSides hidden{};

  Background look(double turned, const Vec3f& left, const Vec3f& right) {
    Appearance seen = state.mean;
    seen.left = left, seen.right = right;
    return background_sides(geometry, viewer(geometry, turned, 0.3), state, seen, 3, hidden);
  }
};

Vec3f times(const Vec3f& c, float gain) { return {gain * c[0], gain * c[1], gain * c[2]}; }

TEST(ViewChange, turned_is_the_angle_about_the_tangent) {
  Dice dice(1);
  for (int k = 0; k < 500; ++k) {
    const Geometry g = random_geometry(dice.bits());
    const double turned = dice.uniform(-3.1, 3.1), along = dice.uniform(-1.3, 1.3);
    EXPECT_NEAR(turned_about_tangent(g, viewer(g, turned, along)), turned, 2e-6 / std::cos(along));
  }
}

TEST(ViewChange, what_a_turn_changes_grows_with_it) {
  EXPECT_FLOAT_EQ(phase_change2(0), 0.02F * 0.02F);
  EXPECT_FLOAT_EQ(phase_change2(0.2F), 0.12F * 0.12F);
  EXPECT_FLOAT_EQ(colour_change2(0), 0.005F * 0.005F);
  EXPECT_FLOAT_EQ(colour_change2(0.5F), 0.055F * 0.055F);
}

TEST(ViewChange, a_face_that_turns_away_stays_background_until_the_viewer_comes_back) {
  Dice dice(2);
  for (int k = 0; k < 50; ++k) {
    Crease c;
    c.geometry = random_geometry(dice.bits());
    EXPECT_FALSE(c.look(0.4, kRed, kBlue).left);
    EXPECT_TRUE(c.look(0.8, kWall, kBlue).left);
    EXPECT_TRUE(c.look(0.9, kRed, kBlue).left) << "beyond, whatever its colour";
    EXPECT_TRUE(c.look(1.2, kWall, kBlue).left);
    EXPECT_FALSE(c.look(0.7, kRed, kBlue).left);
    EXPECT_FALSE(c.look(-0.5, kRed, kBlue).left);
    EXPECT_FALSE(c.look(-0.5, kRed, kBlue).right);
    EXPECT_TRUE(c.look(-0.9, kRed, kWall).right);
    EXPECT_TRUE(c.look(-1.0, kRed, kBlue).right);
  }
}

TEST(ViewChange, the_side_that_the_viewer_comes_nearer_to_is_no_background) {
  Crease c;
  c.geometry = random_geometry(3);
  EXPECT_FALSE(c.look(0.8, kRed, kWall).right);
  EXPECT_FALSE(c.look(-0.8, kWall, kBlue).left);
}

TEST(ViewChange, light_that_changes_on_both_sides_hides_nothing) {
  Crease c;
  c.geometry = random_geometry(4);
  for (const float gain : {0.55F, 1.2F}) {
    const Background b = c.look(0.9, times(kRed, gain), times(kBlue, gain));
    EXPECT_FALSE(b.left || b.right) << gain;
  }
  // Nor does light on one of the faces hide the other.
  EXPECT_FALSE(c.look(0.9, kRed, times(kBlue, 0.5F)).left);
  // The same brightness on the left alone is another thing.
  EXPECT_TRUE(c.look(0.9, times(kRed, 0.55F), kBlue).left);
  // A black side says nothing about the light: noise on it explains no change of the other.
  Crease black;
  black.geometry = c.geometry;
  black.state = known(kRed, {0.01F, 0.01F, 0.01F});
  EXPECT_TRUE(black.look(0.9, times(kRed, 0.55F), {0.0055F, 0.0055F, 0.0055F}).left);
}

TEST(ViewChange, four_times_the_light_is_another_surface) {
  Crease c;
  c.geometry = random_geometry(4);
  const Vec3f left{0.2F, 0.1F, 0.1F}, right{0.1F, 0.1F, 0.2F};
  c.state = known(left, right);
  EXPECT_FALSE(c.look(0.9, times(left, 1.9F), times(right, 1.9F)).left);
  EXPECT_TRUE(c.look(0.9, times(left, 4), times(right, 4)).left);
}

TEST(ViewChange, a_side_that_is_hardly_known_cannot_surprise) {
  for (std::size_t side = 0; side < 2; ++side) {
    Crease c;
    c.geometry = random_geometry(7);
    for (std::size_t k = 1 + 3 * side; k < 4 + 3 * side; ++k) c.state.covariance[packed_index(7, k, k)] = 0.1F;
    EXPECT_EQ(c.look(0.9, kWall, kBlue).left, side == 1);
    EXPECT_EQ(c.look(-0.9, kRed, kWall).right, side == 0);
  }
}

TEST(ViewChange, beyond_goes_on_behind_the_edge) {
  Crease c;
  c.geometry = random_geometry(8);
  EXPECT_TRUE(c.look(3.0, kWall, kBlue).left);
  EXPECT_TRUE(c.look(-3.1, kRed, kBlue).left);
}

TEST(ViewChange, grey_counts_as_one_channel) {
  Crease c;
  c.geometry = random_geometry(5);
  c.state = known({0.5F, 0.5F, 0.5F}, {0.2F, 0.2F, 0.2F});
  Appearance seen = c.state.mean;
  seen.left = {0.62F, 0.62F, 0.62F};  // d2 5.5 in one channel
  HiddenSides one, three;
  const Vec3f v = viewer(c.geometry, 0.9);
  EXPECT_FALSE(background_sides(c.geometry, v, c.state, seen, 1, one).left);
  EXPECT_TRUE(background_sides(c.geometry, v, c.state, seen, 3, three).left);
}

TEST(ViewChange, is_blind_to_reversal) {
  Dice dice(6);
  for (int k = 0; k < 200; ++k) {
    const Geometry g = random_geometry(dice.bits());
    const Appearance a = test::random_look(dice), b = test::random_look(dice);
    AppearanceState s = known(a.left, a.right);
    Appearance seen = s.mean;
    if (dice.uniform() < 0.7) seen.left = b.left;
    if (dice.uniform() < 0.7) seen.right = b.right;
    const Geometry r = reversed(g);
    const AppearanceState rs = reversed(s);
    HiddenSides hidden, rhidden;
    for (int look = 0; look < 4; ++look) {
      const Vec3f v = viewer(g, dice.uniform(-1.4, 1.4), 0.2);
      const Background x = background_sides(g, v, s, seen, 2, hidden);
      const Background y = background_sides(r, v, rs, reversed(seen), 2, rhidden);
      EXPECT_EQ(x.left, y.right);
      EXPECT_EQ(x.right, y.left);
    }
  }
}

}  // namespace
}  // namespace accrete
