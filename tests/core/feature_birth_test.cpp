// Births of junctions and patches: exact, refused with a reason, and blind to how a view is described.
#include <gtest/gtest.h>

#include <limits>

#include "core/feature_world.h"

namespace accrete::test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

template <class F>
ReconstructOutcome born(const typename F::template View<float>& l, const typename F::template View<float>& r) {
  const typename F::template View<float> seen[2] = {l, r};
  feature::Estimate<F, float> e;
  return feature::birth<F>(seen, Optics().aligned(), e);
}

TEST(FeatureBirth, of_exact_views_is_the_truth) {
  Dice dice(10);
  const Optics optics;
  const auto check = [&]<class F>(const Truth<F>& truth) {
    const typename F::template View<float> seen[2] = {truth.observe(dice, {}, optics, 0, 0),
                                                      truth.observe(dice, {}, optics, optics.baseline, 0)};
    feature::Estimate<F, float> e;
    ASSERT_EQ(feature::birth<F>(seen, optics.aligned(), e), ReconstructOutcome::kOk);
    EXPECT_LT((e.x.p.template cast<double>() - truth.p).norm(), 1e-5);
    EXPECT_LT(truth.direction_error(e.x), 2e-3);
    EXPECT_GT(oracle::smallest_scaled_eigenvalue(oracle::to_matrix(e.P)), 0);
  };
  for (int k = 0; k < 50; ++k) {
    check(Truth<Junction<2>>(dice));
    check(Truth<Junction<4>>(dice));
    check(Truth<Patch>(dice));
  }
}

TEST(FeatureBirth, of_a_junction_is_refused_with_a_reason) {
  using F = Junction<3>;
  Dice dice(11);
  const Optics optics;
  const Truth<F> truth(dice);
  const F::View<float> l = truth.observe(dice, {}, optics, 0, 0),
                       r = truth.observe(dice, {}, optics, optics.baseline, 0);
  EXPECT_EQ(born<F>(l, r), ReconstructOutcome::kOk);
  EXPECT_EQ(born<F>(r, l), ReconstructOutcome::kBehind);  // the disparity is negative
  const auto with = [](F::View<float> v, int arm, double degrees) {
    v.c[arm] = static_cast<float>(std::cos(degrees * kDegree));
    v.s[arm] = static_cast<float>(std::sin(degrees * kDegree));
    return v;
  };
  const double first = std::atan2(l.s[0], l.c[0]) / kDegree;
  EXPECT_EQ(born<F>(with(l, 1, first + 10), r), ReconstructOutcome::kDegenerate) << "parallel arms";
  EXPECT_EQ(born<F>(with(l, 0, 10), with(r, 0, 10)), ReconstructOutcome::kDegenerate) << "an epipolar arm";
  EXPECT_EQ(born<F>(F::described(l, 0), F::described(r, 1)), ReconstructOutcome::kDegenerate) << "other arms";
  F::View<float> swapped = l;
  std::swap(swapped.c[0], swapped.c[1]);
  std::swap(swapped.s[0], swapped.s[1]);
  EXPECT_EQ(born<F>(swapped, r), ReconstructOutcome::kDegenerate) << "another cyclic order";
  for (float F::View<float>::*member : {&F::View<float>::x, &F::View<float>::y, &F::View<float>::sigma_px}) {
    F::View<float> broken = l;
    broken.*member = kNaN;
    EXPECT_NE(born<F>(broken, r), ReconstructOutcome::kOk);
  }
  F::View<float> infinite = l;
  infinite.x = r.x;  // no disparity
  EXPECT_NE(born<F>(infinite, r), ReconstructOutcome::kOk);
}

TEST(FeatureBirth, of_a_patch_is_refused_with_a_reason) {
  Dice dice(12);
  const Optics optics;
  const Truth<Patch> truth(dice);
  const auto at = [&](const Truth<Patch>& t, Patch::View<float>* seen) {
    seen[0] = t.observe(dice, {}, optics, 0, 0);
    seen[1] = t.observe(dice, {}, optics, optics.baseline, 0);
  };
  Patch::View<float> v[2];
  at(truth, v);
  EXPECT_EQ(born<Patch>(v[0], v[1]), ReconstructOutcome::kOk);
  EXPECT_EQ(born<Patch>(v[1], v[0]), ReconstructOutcome::kBehind);
  Truth<Patch> turned = truth;  // seen edge-on: 86 degrees between normal and ray
  turned.R = oracle::exp_so3(Vector3d(0, 86 * kDegree, 0)) * with_axis(truth.p, 2);
  at(turned, v);
  EXPECT_EQ(born<Patch>(v[0], v[1]), ReconstructOutcome::kDegenerate);
  Patch::View<float> view;
  EXPECT_FALSE(Patch::look(turned.state(), feature::cameras<float>(Pose().aligned(), optics.aligned())[0], view));
  turned.R.col(1) = -truth.R.col(1);  // from behind
  turned.R.col(2) = -truth.R.col(2);
  turned.R.col(0) = truth.R.col(0);
  at(turned, v);
  EXPECT_EQ(born<Patch>(v[0], v[1]), ReconstructOutcome::kDegenerate);
  at(truth, v);
  v[1].a[0][1] = kNaN;
  EXPECT_NE(born<Patch>(v[0], v[1]), ReconstructOutcome::kOk);
  at(truth, v);
  for (auto& row : v[0].a) row[0] = row[1] = 0;
  EXPECT_NE(born<Patch>(v[0], v[1]), ReconstructOutcome::kOk) << "no shape";
}

// Born from lists of arms that begin elsewhere, junctions are the same junction.
TEST(FeatureBirth, does_not_depend_on_the_arm_that_is_listed_first) {
  using F = Junction<4>;
  Dice dice(13);
  const Optics optics;
  const Truth<F> truth(dice);
  const F::View<float> l = truth.observe(dice, {}, optics, 0), r = truth.observe(dice, {}, optics, optics.baseline);
  const auto cameras = feature::cameras<float>(Pose().aligned(), optics.aligned());
  const F::View<float> again[2] = {truth.observe(dice, {}, optics, 0),
                                   truth.observe(dice, {}, optics, optics.baseline)};
  feature::Estimate<F, float> first;
  for (int sense = 0; sense < F::kSenses; ++sense) {
    const F::View<float> seen[2] = {F::described(l, sense), F::described(r, sense)};
    const F::View<float> next[2] = {F::described(again[0], sense), F::described(again[1], sense)};
    feature::Estimate<F, float> e;
    ASSERT_EQ(feature::birth<F>(seen, optics.aligned(), e), ReconstructOutcome::kOk);
    const auto done = feature::update<F, 2>(e, cameras.data(), next);
    ASSERT_TRUE(done.good);
    if (sense == 0) first = e;
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(e.x.p[i], first.x.p[i], 2e-2F * std::sqrt(first.P(i, i)));
    for (int i = 0; i < 4; ++i) {
      const Vector3<float> a = rotation_matrix(e.x.arm[i]).col(0),
                           b = rotation_matrix(first.x.arm[(i + sense) % 4]).col(0);
      EXPECT_LT((a - b).norm(), 5e-3);
    }
  }
}

}  // namespace
}  // namespace accrete::test
