// Stereo matching on primitives of edges whose place in space is known, seen by a verged rig with lenses.
#include "stereo/match.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "core/rig.h"

namespace accrete::stereo {
namespace {

using namespace test;

struct Matcher {
  std::vector<StereoMatch> out = std::vector<StereoMatch>(4096);
  StepReport report;

  std::span<const StereoMatch> operator()(std::span<const Primitive2d> left, std::span<const Primitive2d> right,
                                          const Rig& rig, const StereoParams& params = {}) {
    std::vector<std::uint16_t> lo(left.size()), ro(right.size());
    std::vector<std::uint32_t> lb(kRows + 1), rb(kRows + 1);
    std::vector<Candidates> candidates(left.size());
    std::vector<float> best(right.size());
    Scratch scratch{{lo, lb}, {ro, rb}, candidates, best};
    report = {};
    const std::size_t n = match(left, right, params, rig.optics, rig.rig.left.width_px, scratch, out, report);
    EXPECT_EQ(report.stereo_matches, n);
    return std::span<const StereoMatch>(out).first(n);
  }
};

// Edges that both eyes see, the right one elsewhere on the edge and in another order.
struct Scene {
  std::vector<Edge> edges;
  std::vector<Primitive2d> left, right;
  std::vector<std::uint16_t> right_of;  // index in `right` of edge i

  Scene(const Rig& rig, std::size_t n, std::uint64_t seed, double slide = 3) {
    Dice dice(seed);
    while (edges.size() < n) add(rig, random_edge(dice), dice.uniform(-slide, slide));
    right_of.resize(n);
    std::iota(right_of.begin(), right_of.end(), std::uint16_t{0});
    for (std::size_t i = n; i > 1; --i) std::swap(right_of[i - 1], right_of[dice.below(i)]);
    std::vector<Primitive2d> shuffled(n);
    for (std::size_t i = 0; i < n; ++i) shuffled[right_of[i]] = right[i];
    right = shuffled;
  }
  Scene() = default;
  bool add(const Rig& rig, const Edge& e, double slide) {
    Primitive2d l, r;
    if (!rig.see(e, 0, 0, l) || !rig.see(e, 1, slide, r)) return false;
    edges.push_back(e);
    left.push_back(l);
    right.push_back(r);
    return true;
  }
};
double disparity_of(const Rig& rig, const Edge& e) {
  return rig.aligned.focal_px * rig.aligned.baseline_m / (rig.aligned.R_a_l * e.p)[2];
}
bool degenerate(const Primitive2d& p, const StereoParams& params) {
  return std::fabs(p.aligned.s) < std::sin(params.min_psi);
}

TEST(StereoMatch, finds_the_edges_of_a_verged_rig_with_their_disparity) {
  const Rig rig;
  const Scene s(rig, 250, 1);
  Matcher matcher;
  const auto matches = matcher(s.left, s.right, rig);
  std::map<std::uint16_t, StereoMatch> best;
  for (const StereoMatch& m : matches) best.emplace(m.left, m);  // the first of each is the best
  const StereoParams params;
  int found = 0, expected = 0;
  std::uint32_t refused = 0;
  for (std::uint16_t i = 0; i < s.edges.size(); ++i) {
    if (degenerate(s.left[i], params)) {
      ++refused;
      EXPECT_FALSE(best.count(i));
      continue;
    }
    const Primitive2d& r = s.right[s.right_of[i]];
    // Near the limit the right element may be degenerate, or turned too far against the left one.
    const double cosine =
        double{s.left[i].aligned.c} * double{r.aligned.c} + double{s.left[i].aligned.s} * double{r.aligned.s};
    if (degenerate(r, params) || std::fabs(cosine) < 0.75) continue;
    ++expected;
    if (!best.count(i) || best[i].right != s.right_of[i]) continue;
    ++found;
    const StereoMatch& m = best[i];
    // Exact wherever on the edge the right element was taken; float of aligned pixels at shallow angles.
    EXPECT_NEAR(double{m.disparity_px}, disparity_of(rig, s.edges[i]), 0.01);
    EXPECT_EQ(m.right_reversed, cosine < 0);
    EXPECT_GE(m.similarity, params.min_similarity);
  }
  EXPECT_EQ(matcher.report.stereo_refused_epipolar, refused);
  EXPECT_GT(refused, 10U);
  EXPECT_GT(expected, 150);
  EXPECT_EQ(found, expected);
}

TEST(StereoMatch, every_pair_shares_an_epipolar_line_and_a_disparity_in_range) {
  const Rig rig;
  const Scene s(rig, 400, 2);
  StereoParams params;
  params.min_depth_m = 0.6F;
  params.max_depth_m = 0.9F;
  params.min_similarity = 0;  // rivals wherever geometry allows them
  Matcher matcher;
  const auto matches = matcher(s.left, s.right, rig, params);
  EXPECT_GT(matches.size(), 100U);
  const double fb = rig.aligned.focal_px * rig.aligned.baseline_m;
  for (const StereoMatch& m : matches) {
    const LineElement &l = s.left[m.left].aligned, &r = s.right[m.right].aligned;
    // The right element, slid along itself to the left one's row.
    const double slide = double{l.y_px - r.y_px} / double{r.s};
    EXPECT_LT(std::fabs(slide), 6);
    EXPECT_NEAR(double{m.disparity_px}, double{l.x_px} - (double{r.x_px} + slide * double{r.c}), 1e-3);
    EXPECT_GE(double{m.disparity_px}, fb / 0.9 - 0.01);
    EXPECT_LE(double{m.disparity_px}, fb / 0.6 + 0.01);
  }
}

TEST(StereoMatch, without_limits_the_range_ends_at_half_the_image) {
  const Rig rig(false);
  // Two elements at a chosen disparity.
  const auto pair = [&](double disparity) {
    Primitive2d l, r;
    EXPECT_TRUE(rig.see({{0, 0, 1}, {0, 1, 0}, {}}, 0, 0, l));
    r = l;
    r.aligned.x_px = static_cast<float>(double{l.aligned.x_px} - disparity);
    Matcher matcher;
    return matcher({&l, 1}, {&r, 1}, rig).size();
  };
  EXPECT_EQ(pair(-2), 0U);
  EXPECT_EQ(pair(0), 0U);
  EXPECT_EQ(pair(5), 1U);
  EXPECT_EQ(pair(rig.rig.left.width_px / 2 - 1), 1U);
  EXPECT_EQ(pair(rig.rig.left.width_px / 2 + 1), 0U);
}

// An upright element of one look at an aligned place.
Primitive2d upright(double x, double y, const Appearance& look = {}) {
  Primitive2d p;
  p.theta = kPi / 2;
  p.aligned = {static_cast<float>(x), static_cast<float>(y), 0, 1, 0.2F, 0.02F};
  p.appearance = look;
  p.sigma_phase = 0.25F;
  p.sigma_colour = 0.02F;
  return p;
}

TEST(StereoMatch, rivals_share_the_probability_of_one) {
  const Rig rig;
  const std::vector<Primitive2d> left = {upright(50, 0)};
  for (int rivals = 1; rivals <= 4; ++rivals) {
    std::vector<Primitive2d> right;
    for (int k = 0; k < rivals; ++k) right.push_back(upright(30 - 12 * k, 1));
    Matcher matcher;
    const auto matches = matcher(left, right, rig);
    ASSERT_EQ(matches.size(), static_cast<std::size_t>(rivals));
    float sum = 0;
    for (const StereoMatch& m : matches) {
      EXPECT_NEAR(m.probability, matches[0].probability, 1e-5);  // equally like
      sum += m.probability;
    }
    EXPECT_NEAR(sum, 0.2F, 1e-5);  // the prior of docs/math/stereo.md
    EXPECT_EQ(matcher.report.stereo_ambiguous, rivals > 1 ? 1U : 0U);
  }
  // The less alike of two rivals gets less.
  Appearance other;
  other.phase = 0.8F;
  const std::vector<Primitive2d> right = {upright(10, 0, other), upright(30, 0)};
  Matcher matcher;
  const auto matches = matcher(left, right, rig);
  ASSERT_EQ(matches.size(), 2U);
  EXPECT_EQ(matches[0].right, 1);
  EXPECT_GT(matches[0].probability, matches[1].probability);
  // And no more of them than asked for.
  StereoParams params;
  params.max_rivals = 1;
  EXPECT_EQ(matcher(left, right, rig, params).size(), 1U);
}

TEST(StereoMatch, two_samples_of_one_contour_are_no_rivals) {
  const Rig rig;
  const std::vector<Primitive2d> left = {upright(50, 0)}, right = {upright(30, -3), upright(30, 3), upright(30.5, 1)};
  Matcher matcher;
  EXPECT_EQ(matcher(left, right, rig).size(), 1U);
  EXPECT_EQ(matcher.report.stereo_ambiguous, 0U);
}

TEST(StereoMatch, a_right_element_that_fits_another_left_one_far_better_is_not_taken) {
  const Rig rig;
  Appearance other;
  other.phase = 2.2F;
  const std::vector<Primitive2d> left = {upright(50, 0), upright(70, 0, other)}, right = {upright(30, 0)};
  Matcher matcher;
  // Alone, the second is similar enough.
  EXPECT_EQ(matcher(std::span(left).last(1), right, rig).size(), 1U);
  const auto matches = matcher(left, right, rig);
  ASSERT_EQ(matches.size(), 1U);
  EXPECT_EQ(matches[0].left, 0);
}

TEST(StereoMatch, far_less_alike_is_no_rival) {
  const Rig rig;
  Appearance other;
  other.phase = 2.2F;  // still similar enough to match alone
  const std::vector<Primitive2d> left = {upright(50, 0)}, right = {upright(10, 0, other), upright(30, 0)};
  Matcher matcher;
  EXPECT_EQ(matcher(left, std::span(right).first(1), rig).size(), 1U);
  const auto matches = matcher(left, right, rig);
  ASSERT_EQ(matches.size(), 1U);
  EXPECT_EQ(matches[0].right, 1);
}

TEST(StereoMatch, right_elements_along_the_epipolar_line_are_not_taken) {
  const Rig rig;
  const StereoParams params;
  const auto turned = [](double x, double angle) {
    Primitive2d p = upright(x, 0);
    p.aligned.c = static_cast<float>(std::cos(angle));
    p.aligned.s = static_cast<float>(std::sin(angle));
    return p;
  };
  const std::vector<Primitive2d> left = {turned(50, double{params.min_psi} + 0.05)};
  const std::vector<Primitive2d> steep = {turned(30, double{params.min_psi} + 0.1)};
  const std::vector<Primitive2d> flat = {turned(30, double{params.min_psi} - 0.1)};
  Matcher matcher;
  EXPECT_EQ(matcher(left, steep, rig).size(), 1U);
  EXPECT_EQ(matcher(left, flat, rig).size(), 0U);
}

TEST(StereoMatch, unlike_elements_do_not_match) {
  const Rig rig;
  Appearance white, black;
  white.left = white.right = {1, 1, 1};
  black.phase = kPi;
  const std::vector<Primitive2d> left = {upright(50, 0, white)}, right = {upright(30, 0, black)};
  Matcher matcher;
  EXPECT_TRUE(matcher(left, right, rig).empty());
}

TEST(StereoMatch, neighbours_along_a_contour_support_each_other) {
  const Rig rig;
  // In the image plane, and slanted so much that the disparity changes by more than neighbours may differ.
  for (const double slant : {0.0, 3.0}) {
    // A long straight edge in space, sampled at different places in both eyes; and one sample on its own.
    std::vector<Primitive2d> left, right;
    Dice dice(3);
    const Vec3 t = unit({0.2, 1, slant});
    const Appearance look = random_look(dice);
    for (int k = -6; k <= 6; ++k) {
      const Edge e{Vec3{0, 0, 0.8} + (0.0075 * k * std::sqrt(1 + slant * slant)) * t, t, look};
      Primitive2d p;
      ASSERT_TRUE(rig.see(e, 0, 0, p));
      left.push_back(p);
      ASSERT_TRUE(rig.see(e, 1, dice.uniform(-2, 2), p));
      right.push_back(p);
    }
    Edge lone{{0.15, 0.1, 0.9}, t, random_look(dice)};
    Primitive2d p;
    ASSERT_TRUE(rig.see(lone, 0, 0, p));
    left.push_back(p);
    ASSERT_TRUE(rig.see(lone, 1, 0, p));
    right.push_back(p);
    Matcher matcher;
    const auto matches = matcher(left, right, rig);
    int on_contour = 0;
    for (const StereoMatch& m : matches) {
      EXPECT_EQ(m.group_consistent, m.left < 13) << m.left;
      on_contour += m.left < 13;
    }
    EXPECT_GE(on_contour, 13);
  }
}

TEST(StereoMatch, capacity_is_kept_and_counted) {
  const Rig rig;
  const Scene s(rig, 200, 4);
  Matcher all, few;
  const std::size_t full = all(s.left, s.right, rig).size();
  few.out.resize(20);
  EXPECT_EQ(few(s.left, s.right, rig).size(), 20U);
  EXPECT_EQ(few.report.stereo_refused_capacity, full - 20);
  few.out.clear();
  EXPECT_TRUE(few(s.left, s.right, rig).empty());
  EXPECT_TRUE(all({}, s.right, rig).empty());
  EXPECT_TRUE(all(s.left, {}, rig).empty());
}

TEST(StereoMatch, does_not_depend_on_how_elements_are_described) {
  const Rig rig;
  const Scene s(rig, 200, 5);
  Matcher one, two;
  const auto a = one(s.left, s.right, rig);
  auto left = s.left, right = s.right;
  Dice dice(6);
  for (auto* list : {&left, &right})
    for (Primitive2d& p : *list)
      if (dice.chance(0.5)) {
        p.aligned = reversed(p.aligned);
        p.appearance = reversed(p.appearance);
      }
  const auto b = two(left, right, rig);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].left, b[i].left);
    EXPECT_EQ(a[i].right, b[i].right);
    EXPECT_NEAR(a[i].disparity_px, b[i].disparity_px, 1e-3);
    EXPECT_NEAR(a[i].probability, b[i].probability, 1e-4);
  }
}

}  // namespace
}  // namespace accrete::stereo
