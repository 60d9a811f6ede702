// Are filters of other kinds than edges accurate and honest? Simulated junctions and patches with known truth.
#include <gtest/gtest.h>

#include "core/feature_world.h"
#include "feature/associate.h"

namespace accrete::test {
namespace {

constexpr int kFrames = 40;
constexpr std::size_t kFeatures = 1200;

struct Figures {
  double nees = 0, above_95 = 0, rms_mm = 0, rms_deg = 0;
};
struct Simulated {
  Figures frame[kFrames + 1];
  int born = 0, not_updated = 0, not_seen = 0;
};

// 95 % of chi-squared.
double chi2_95(int dof) { return feature::chi_squared(dof, 1.6449); }

template <class F>
Simulated simulate(double turn_deg, unsigned seed, double noise = 1) {
  const Optics optics;
  Dice dice(seed);
  Simulated run;
  std::vector<Truth<F>> truth;
  std::vector<feature::Estimate<F, float>> estimates;
  for (int k = 1; k <= kFrames; ++k) {
    const Pose pose = turned_pose((k - 1) * turn_deg / (kFrames - 1));
    const auto cameras = feature::cameras<float>(pose.aligned(), optics.aligned());
    const auto look = [&](const Truth<F>& w, int eye) {
      return w.observe(dice, pose, optics, eye == 0 ? 0 : optics.baseline, noise);
    };
    if (k == 1) {
      for (std::size_t i = 0; i < kFeatures; ++i) {
        const Truth<F> one(dice);
        const typename F::template View<float> seen[2] = {look(one, 0), look(one, 1)};
        feature::Estimate<F, float> e;
        if (feature::birth<F>(seen, optics.aligned(), e) != ReconstructOutcome::kOk) continue;
        truth.push_back(one);
        estimates.push_back(e);
      }
      run.born = static_cast<int>(truth.size());
    } else {
      for (std::size_t i = 0; i < truth.size(); ++i) {
        const typename F::template View<float> seen[2] = {look(truth[i], 0), look(truth[i], 1)};
        feature::Estimate<F, float> e = estimates[i];
        const auto done = feature::update<F, 2>(e, cameras.data(), seen);
        run.not_seen += !done.visible;
        run.not_updated += done.visible && !done.good;
        if (done.visible && done.good) estimates[i] = e;
      }
    }
    Figures& f = run.frame[k];
    const double n = run.born;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const double d2 = feature::normalised_error(estimates[i], truth[i].state());
      f.nees += d2 / n;
      f.above_95 += (d2 > chi2_95(F::kObservable)) / n;
      f.rms_mm += (estimates[i].x.p.template cast<double>() - truth[i].p).squaredNorm() / n;
      f.rms_deg += std::pow(truth[i].direction_error(estimates[i].x), 2) / n;
    }
    f.rms_mm = 1e3 * std::sqrt(f.rms_mm);
    f.rms_deg = std::sqrt(f.rms_deg) / kDegree;
  }
  return run;
}

template <class F>
class FeatureConsistency : public testing::Test {};
using Kinds = testing::Types<Junction<2>, Junction<3>, Junction<4>, Patch>;
TYPED_TEST_SUITE(FeatureConsistency, Kinds);

// Simulated once for all tests; the rows of the table of docs/math/features.md.
template <class F>
const Simulated& with_turn(int turn_deg) {
  const auto print = [](double turn, const Simulated& run) {
    std::printf("turn %2.0f degrees, %d degrees of freedom: born %d, not seen %d\n", turn, F::kObservable, run.born,
                run.not_seen);
    for (const int k : {1, 2, 5, 10, 20, 40}) {
      const Figures& f = run.frame[k];
      std::printf("  frame %2d: NEES %5.2f, above 95 %% %4.1f %%, rms position %.2f mm, direction %.2f degrees\n", k,
                  f.nees, 100 * f.above_95, f.rms_mm, f.rms_deg);
    }
    return run;
  };
  static const Simulated still = print(0, simulate<F>(0, 43)), turned = print(40, simulate<F>(40, 41));
  return turn_deg == 0 ? still : turned;
}

// The band that edges keep, 3.5 .. 5 of 4 degrees of freedom, and 3 to 8 % above the 95 % quantile in the end.
TYPED_TEST(FeatureConsistency, normalised_error_is_that_of_the_observable_degrees_of_freedom) {
  const Simulated& run = with_turn<TypeParam>(40);
  constexpr int kDof = TypeParam::kObservable;
  EXPECT_GE(run.born, 1150);
  EXPECT_EQ(run.not_updated, 0);
  EXPECT_LE(run.not_seen, run.born * kFrames / 200);  // arms in another order from there, patches seen edge-on
  for (const int k : {10, 40}) {
    EXPECT_GT(run.frame[k].nees, 3.5 / 4 * kDof) << "frame " << k;
    EXPECT_LT(run.frame[k].nees, 5.0 / 4 * kDof) << "frame " << k;
  }
  EXPECT_GT(run.frame[40].above_95, 0.03);
  EXPECT_LT(run.frame[40].above_95, 0.08);
}

// With a tenth of the noise nothing is left of the curvature, and the mean of 1200 is within three deviations. (A birth
// is more careful than that: what is added to its variances is no longer small.)
TYPED_TEST(FeatureConsistency, small_errors_are_exactly_consistent) {
  constexpr int kDof = TypeParam::kObservable;
  const Simulated run = simulate<TypeParam>(40, 42, 0.1);
  for (const int k : {10, 40}) {
    EXPECT_NEAR(run.frame[k].nees, kDof, 3 * std::sqrt(2.0 * kDof / run.born)) << "frame " << k;
    EXPECT_NEAR(run.frame[k].above_95, 0.05, 0.02);
  }
}

// Without a turn every frame says the same again: errors fall with the root of their number.
TYPED_TEST(FeatureConsistency, errors_fall_with_the_root_of_the_number_of_views) {
  const Simulated& run = with_turn<TypeParam>(0);
  for (const int k : {5, 10, 20, 40}) {
    EXPECT_NEAR(run.frame[1].rms_mm / run.frame[k].rms_mm / std::sqrt(k), 1, 0.12) << "frame " << k;
    EXPECT_NEAR(run.frame[1].rms_deg / run.frame[k].rms_deg / std::sqrt(k), 1, 0.2) << "frame " << k;
  }
}

// With a turn they fall faster: what one view hides in the depth the next one sees from the side.
TYPED_TEST(FeatureConsistency, accuracy_after_a_turn) {
  const Simulated& run = with_turn<TypeParam>(40);
  EXPECT_LT(run.frame[40].rms_mm, 0.2);
  EXPECT_LT(run.frame[40].rms_deg, 1.6);
  EXPECT_GT(run.frame[1].rms_mm, 10 * run.frame[40].rms_mm);
  EXPECT_GT(run.frame[1].rms_deg, 8 * run.frame[40].rms_deg);
}

}  // namespace
}  // namespace accrete::test
