// Is an edge expected to be seen? Seen directions, the border of the image, and visibility from frame to frame.
#include "predict/visibility.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/rig.h"
#include "existence/evidence.h"

namespace accrete {
namespace {

using test::Dice;

using Direction = std::array<float, 3>;

Direction random_direction(Dice& dice) {
  const Vec3 v = test::unit({dice.normal(), dice.normal(), dice.normal()});
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}
std::size_t bin_of(const Direction& d) {
  SeenDirections seen;
  seen.count(d, true);
  for (std::size_t b = 0; b < SeenDirections::kBins; ++b)
    if (seen.visits[b] != 0) return b;
  return SeenDirections::kBins;
}

TEST(SeenDirections, bins_cover_the_sphere_evenly) {
  // Which directions fall into a bin: their mean is its direction, if all of them are unit vectors.
  Dice dice(1);
  constexpr int draws = 200000;
  std::vector<Vec3> sum(SeenDirections::kBins);
  std::vector<int> count(SeenDirections::kBins);
  std::vector<std::pair<Direction, std::size_t>> drawn;
  for (int k = 0; k < draws; ++k) {
    const Direction d = random_direction(dice);
    const std::size_t b = bin_of(d);
    ASSERT_LT(b, SeenDirections::kBins);
    sum[b] = sum[b] + Vec3{d[0], d[1], d[2]};
    ++count[b];
    drawn.emplace_back(d, b);
  }
  // Twelve vertices of the icosahedron with five neighbours each, thirty middles of its edges: two sizes of cells.
  std::vector<double> share;
  for (const int n : count) share.push_back(static_cast<double>(n) / draws);
  std::sort(share.begin(), share.end());
  for (std::size_t i = 0; i < 12; ++i) EXPECT_NEAR(share[i], share[6], 0.1 * share[6]);
  for (std::size_t i = 12; i < SeenDirections::kBins; ++i) EXPECT_NEAR(share[i], share[27], 0.1 * share[27]);
  EXPECT_GT(share.front(), 0.015);
  EXPECT_LT(share.back(), 0.035);
  // Nothing lies farther than 22 degrees from the middle of its bin, and every bin has its opposite.
  for (Vec3& s : sum) s = test::unit(s);
  for (const auto& [d, b] : drawn) ASSERT_GT(dot(sum[b], Vec3{d[0], d[1], d[2]}), std::cos(22 * double{kPi} / 180));
  for (const Vec3& s : sum) {
    const Direction back = {static_cast<float>(-s[0]), static_cast<float>(-s[1]), static_cast<float>(-s[2])};
    EXPECT_GT(dot(sum[bin_of(back)], -1.0 * s), 0.999);
  }
}

TEST(SeenDirections, recent_looks_weigh_more_and_counts_never_overflow) {
  SeenDirections seen;
  const Direction d = {0, 0, 1};
  for (int k = 0; k < 1000; ++k) seen.count(d, true);
  const float shown = face_probability(seen, d, 0, 0.5F);
  EXPECT_GT(shown, 0.9F);
  for (int k = 0; k < 40; ++k) seen.count(d, false);
  EXPECT_LT(face_probability(seen, d, 0, 0.5F), 0.2F);
  for (std::size_t b = 0; b < SeenDirections::kBins; ++b) EXPECT_LE(seen.hits[b], seen.visits[b]);
}

TEST(FaceProbability, of_an_edge_never_seen_is_the_prior_of_its_angle) {
  const SeenDirections none;
  const Direction d = {0, 1, 0};
  const auto face = [&](double degrees, float sigma_roll) {
    return face_probability(none, d, static_cast<float>(std::cos(degrees * double{kPi} / 180)), sigma_roll);
  };
  for (const float roll : {0.01F, 0.3F, 0.87F}) {
    float last = 1;
    for (double a = 0; a <= 180; a += 10) {
      const float f = face(a, roll);
      EXPECT_GT(f, 0);
      EXPECT_LE(f, last);
      last = f;
    }
    EXPECT_NEAR(face(70, roll), 0.5, 0.01);  // METHOD 7.3
  }
  // What is not known of the roll softens it, as the mean over the roll's distribution does.
  EXPECT_GT(face(20, 0.01F), 0.99F);
  EXPECT_LT(face(120, 0.01F), 0.01F);
  for (const double a : {0.0, 40.0, 70.0, 100.0, 140.0}) {
    double mean = 0, weight = 0;
    for (double r = -3; r <= 3; r += 0.01) {
      const double w = std::exp(-0.5 * r * r);
      mean += w / (1 + std::exp((a + r * 50 - 70) / 8));
      weight += w;
    }
    EXPECT_NEAR(face(a, 50 * kPi / 180), mean / weight, 0.03) << a;
  }
}

TEST(FaceProbability, what_was_seen_from_here_beats_the_prior) {
  const Direction here = {0, 0, -1}, near = {0.17F, 0, -0.985F}, side = {1, 0, 0};
  SeenDirections shown, hidden;
  for (int k = 0; k < 8; ++k) {
    shown.count(here, true);
    hidden.count(here, false);
  }
  // The angle says no, the looks say yes; and the other way round.
  EXPECT_GT(face_probability(shown, here, -1, 0.3F), 0.85F);
  EXPECT_LT(face_probability(hidden, here, 1, 0.3F), 0.15F);
  EXPECT_GT(face_probability(shown, near, -1, 0.3F), 0.6F);  // also for a direction beside it
  EXPECT_NEAR(face_probability(shown, side, -1, 0.3F), face_probability({}, side, -1, 0.3F), 1e-6);  // not for another
}

TEST(InsideProbability, is_one_inside_nothing_outside_and_half_at_the_margin) {
  const test::Rig rig;
  const Camera& camera = rig.rig.left;
  const auto at = [&](double x, double y, float sigma) {
    // The aligned point of a raw pixel.
    Primitive2d p;
    p.x_px = static_cast<float>(x);
    p.y_px = static_cast<float>(y);
    EXPECT_TRUE(extract::undistort(camera, rig.aligned.R_a_l, rig.aligned.focal_px, p));
    return inside_probability(camera, rig.aligned.R_a_l, rig.aligned.focal_px, p.aligned.x_px, p.aligned.y_px, sigma,
                              12);
  };
  const double w = camera.width_px - 1, h = camera.height_px - 1;
  EXPECT_EQ(at(w / 2, h / 2, 1), 1);
  EXPECT_NEAR(at(12, h / 2, 3), 0.5, 0.01);
  EXPECT_NEAR(at(w - 12, h / 2, 3), 0.5, 0.01);
  EXPECT_NEAR(at(w / 2, 12, 3), 0.5, 0.01);
  EXPECT_NEAR(at(w / 2, h - 12, 3), 0.5, 0.01);
  EXPECT_NEAR(at(12, 12, 3), 0.25, 0.01);
  EXPECT_NEAR(at(15, h / 2, 3), 0.8413, 0.01);
  EXPECT_EQ(at(2, h / 2, 1), 0);
  // Behind the camera, or where the lens model ends.
  EXPECT_EQ(inside_probability(camera, {1, 0, 0, 0, -1, 0, 0, 0, -1}, 600, 0, 0, 1, 12), 0);
  EXPECT_EQ(inside_probability(camera, rig.aligned.R_a_l, 600, 1e6F, 1e6F, 1, 12), 0);
}

TEST(VisibilityChain, is_a_markov_chain) {
  for (float last = 0; last <= 1; last += 0.125F)
    for (float face = 0; face <= 1; face += 0.125F)
      for (const float turned : {0.0F, 0.05F, 0.5F, 3.0F}) {
        const float v = existence::predicted_visibility(last, face, turned);
        EXPECT_GE(v, 0);
        EXPECT_LE(v, 1);
        // Linear in what it was, and from one frame to the next more of it never means less.
        const float v0 = existence::predicted_visibility(0, face, turned),
                    v1 = existence::predicted_visibility(1, face, turned);
        EXPECT_NEAR(v, (1 - last) * v0 + last * v1, 1e-5);
        if (turned < 1) {
          EXPECT_GE(v1, v0 - 1e-6F);
        }
        EXPECT_LE(v1, face + 1e-6F);  // a face that is turned away hides, whatever was before
      }
  // Hidden stays hidden while nothing turns; once the view has turned it is what the geometry says.
  EXPECT_NEAR(existence::predicted_visibility(0, 0.9F, 0), 0, 1e-6);
  EXPECT_GT(existence::predicted_visibility(0, 0.9F, 3.14F), 0.7F);
}

TEST(VisibilityChain, a_look_corrects_by_bayes) {
  Dice dice(2);
  for (int k = 0; k < 200; ++k) {
    const double v = dice.uniform(0, 1), d = dice.uniform(0.01, 0.99);
    EXPECT_EQ(existence::corrected_visibility(static_cast<float>(v), true, static_cast<float>(d)), 1);
    // P(visible | not found) = v (1 - d) / (v (1 - d) + 1 - v).
    EXPECT_NEAR(existence::corrected_visibility(static_cast<float>(v), false, static_cast<float>(d)),
                v * (1 - d) / (v * (1 - d) + 1 - v), 1e-5);
  }
}

}  // namespace
}  // namespace accrete
