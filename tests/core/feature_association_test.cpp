// One association and one existence for all kinds of features: as the edge's own, and for junctions and patches.
#include <gtest/gtest.h>

#include "core/feature_world.h"
#include "feature/judge.h"
#include "math/record_state.h"

namespace accrete::test {
namespace {

using associate::AssociateOutcome;

TEST(FeatureGate, quantiles_are_those_of_chi_squared) {
  struct Row {
    int dof;
    float p99, p999;
  };
  for (const Row& r : {Row{2, 9.21F, 13.82F},
                       {4, 13.28F, 18.47F},
                       {6, 16.81F, 22.46F},
                       {7, 18.48F, 24.32F},
                       {11, 24.72F, 31.26F},
                       {13, 27.69F, 34.53F}}) {  // METHOD 5.3
    EXPECT_NEAR(feature::chi_squared(r.dof, 2.3263), r.p99, 0.006F * r.p99) << r.dof;
    if (r.dof < 6) continue;
    EXPECT_NEAR(feature::chi_squared(r.dof, 3.0902), r.p999, 0.012F * r.p999) << r.dof;
  }
}

TEST(FeatureGate, of_an_edge_is_the_edges_own) {
  Dice dice(1);
  const Optics optics;
  const Pose pose;
  const auto cameras = feature::cameras<float>(pose.aligned(), optics.aligned());
  for (int k = 0; k < 100; ++k) {
    Truth<Edge> truth(dice);
    truth.edge = dice.edge(1e-3, 0.02, 0.3);
    feature::Expected<Edge> e{};
    e.estimate.x = truth.state();
    for (int i = 0; i < 6; ++i)
      for (int j = i; j < 6; ++j) e.estimate.P(i, j) = static_cast<float>(truth.edge.P(i, j));
    std::vector<GeometryBlock> block(1);
    store(oracle::record_of(truth.edge), block[0], 0);
    const std::uint32_t slot = 0;
    PredictedObservation p;
    predict_observations(block, {&slot, 1}, pose.aligned(), optics.aligned(), {&p, 1});
    ASSERT_TRUE(p.valid);
    const Edge::View<float> seen[2] = {truth.observe(dice, pose, optics, 0),
                                       truth.observe(dice, pose, optics, optics.baseline)};
    const auto element = [](const Edge::View<float>& v) {
      return LineElement{v.x, v.y, v.c, v.s, v.sigma_px, v.sigma_angle};
    };
    const LineElement l = element(seen[0]), r = element(seen[1]);
    const associate::Residual rl = associate::residual(p.x_l, p.y_l, p.c_l, p.s_l, l),
                              rr = associate::residual(p.x_r, p.y_r, p.c_r, p.s_r, r);
    const auto root = feature::root_of<Edge>(e.estimate.P);
    ASSERT_TRUE(root.good);
    const auto both = feature::geometry_likelihood<Edge, 2>(e, root, cameras.data(), seen);
    const auto one = feature::geometry_likelihood<Edge, 1>(e, root, &cameras[1], &seen[1]);
    const auto own_both = associate::stereo_likelihood(p, rl, l, rr, r, {});
    const auto own_one = associate::mono_likelihood(p, 1, rr, r, {});
    EXPECT_NEAR(both.d2, own_both.d2, 0.02F * (1 + own_both.d2));
    EXPECT_NEAR(both.log_g, own_both.log_g, 0.03F);
    EXPECT_NEAR(one.d2, own_one.d2, 0.02F * (1 + own_one.d2));
    EXPECT_NEAR(one.log_g, own_one.log_g, 0.03F);

    Appearance mean, other;
    mean.phase = static_cast<float>(dice.uniform(-3, 3));
    other.phase = static_cast<float>(dice.uniform(-3, 3));
    float variance[7];
    for (std::size_t i = 0; i < 3; ++i) {
      mean.left[i] = static_cast<float>(dice.uniform(0, 1));
      mean.right[i] = static_cast<float>(dice.uniform(0, 1));
      other.left[i] = mean.left[i] + static_cast<float>(0.1 * dice.normal());
      other.right[i] = mean.right[i] + static_cast<float>(0.3 * dice.normal());
    }
    const auto flat = [](const Appearance& a) {
      return feature::Appearances<Edge>{a.phase, a.left[0], a.left[1], a.left[2], a.right[0], a.right[1], a.right[2]};
    };
    e.mean = flat(mean);
    for (std::size_t i = 0; i < 7; ++i) e.variance[i] = variance[i] = static_cast<float>(dice.uniform(1e-4, 0.02));
    e.independent_channels = 2;
    const auto generic = feature::appearance_likelihood<Edge>(e, flat(other), 0.2F, 0.05F);
    const auto own = associate::appearance_likelihood(mean, variance, other, 0.2F, 0.05F, 2);
    EXPECT_NEAR(generic.d2, own.d2, 1e-4F * (1 + own.d2));
    EXPECT_NEAR(generic.log_g, own.log_g, 1e-3F);
    EXPECT_EQ(Edge::described(flat(mean), 1), flat(reversed(mean)));
  }
}

template <class F>
feature::Appearances<F> colours(Dice& dice) {
  feature::Appearances<F> a;
  for (float& v : a) v = static_cast<float>(dice.uniform(0, 1));
  return a;
}

// Chance views: `per_px2` of them, of any colour.
template <class F>
feature::Observation<F> observation(const typename F::template View<float>& view, const feature::Appearances<F>& a,
                                    float per_px2 = 1e-4F) {
  const float log_appearance = 0;  // colours uniform in 0 .. 1
  return {view, a, 0.2F, 0.03F, log_of(per_px2), log_appearance};
}

// An image of features, its two eyes, and the memory that association needs.
template <class F>
struct Scene {
  using Views = std::vector<feature::Observation<F>>;
  Views seen[2];
  std::vector<associate::Hypothesis> hypotheses;
  std::vector<std::int32_t> left_owner, right_owner;
  std::vector<associate::Association> out;

  [[nodiscard]] std::array<std::span<const feature::Observation<F>>, 2> spans() const { return {seen[0], seen[1]}; }
  const std::vector<associate::Association>& associate(const std::vector<feature::Expected<F>>& expected,
                                                       const feature::Camera<float>* cameras) {
    hypotheses.resize(expected.size() * associate::kPerExpected);
    left_owner.resize(seen[0].size());
    right_owner.resize(seen[1].size());
    out.assign(expected.size(), {});
    feature::associate_features<F>(expected, cameras, spans(), hypotheses, left_owner, right_owner, out);
    return out;
  }
};

template <class F>
feature::Expected<F> expect(const feature::Estimate<F, float>& e, const feature::Appearances<F>& mean) {
  feature::Expected<F> x{};
  x.estimate = e;
  x.mean = mean;
  x.variance.fill(1e-3F);
  x.visible = 0.9F;
  x.detection = 0.83F;
  return x;
}

template <class F>
feature::Estimate<F, float> born_from(Dice& dice, const Truth<F>& truth, const Optics& optics,
                                      feature::BothViews<F>& seen) {
  feature::Estimate<F, float> e;
  do {
    seen = {truth.observe(dice, {}, optics, 0), truth.observe(dice, {}, optics, optics.baseline)};
  } while (feature::birth<F>(seen.data(), optics.aligned(), e) != ReconstructOutcome::kOk);
  return e;
}

template <class F>
class FeatureAssociation : public testing::Test {};
using Kinds = testing::Types<Junction<2>, Junction<3>, Junction<4>, Patch>;
TYPED_TEST_SUITE(FeatureAssociation, Kinds);

// Two features 1.5 px from each other, alike but for their colours: each gets its own observations, in whatever
// description they come; exchanged colours exchange them.
TYPED_TEST(FeatureAssociation, near_features_are_told_apart_by_their_appearance) {
  using F = TypeParam;
  Dice dice(2);
  const Optics optics;
  const auto cameras = feature::cameras<float>(Pose().aligned(), optics.aligned());
  int right = 0, wrong = 0;
  for (int k = 0; k < 200; ++k) {
    Truth<F> a(dice), b = a;
    b.p.x() += 1.5 * a.p.z() / optics.focal;
    feature::BothViews<F> unused;
    const auto look_a = colours<F>(dice), look_b = colours<F>(dice);
    const std::vector<feature::Expected<F>> expected = {expect<F>(born_from(dice, a, optics, unused), look_a),
                                                        expect<F>(born_from(dice, b, optics, unused), look_b)};
    Scene<F> scene;
    for (int eye = 0; eye < 2; ++eye) {
      const int sense = k % F::kSenses;
      const double offset = eye == 0 ? 0 : optics.baseline;
      const auto one = a.observe(dice, {}, optics, offset), two = b.observe(dice, {}, optics, offset);
      // The second one first.
      scene.seen[eye] = {observation<F>(F::described(two, sense), F::described(look_b, sense)),
                         observation<F>(F::described(one, sense), F::described(look_a, sense))};
    }
    const auto& out = scene.associate(expected, cameras.data());
    for (std::size_t i = 0; i < 2; ++i) {
      if (out[i].outcome != AssociateOutcome::kStereo) continue;
      const std::int32_t own = i == 0 ? 1 : 0;
      (out[i].left == own && out[i].right == own ? right : wrong)++;
      EXPECT_EQ((out[i].left_sense + k % F::kSenses) % F::kSenses, 0);
    }
  }
  std::printf("of 400: %d right, %d wrong\n", right, wrong);
  EXPECT_GE(right, 380);
  EXPECT_LE(wrong, 4);
}

// The same code that judges edges: what is there is confirmed, what was chance is deleted.
TYPED_TEST(FeatureAssociation, existence_rises_for_what_is_there_and_falls_for_clutter) {
  using F = TypeParam;
  constexpr int kFrames = 25;
  constexpr std::size_t kTrue = 60, kFalse = 60;
  Dice dice(3);
  const Optics optics;
  const ExistenceParams params;
  struct Tracked {
    feature::Estimate<F, float> estimate;
    feature::Appearances<F> look;
    feature::History<F> history;
    bool alive = true;
  };
  std::vector<Truth<F>> truth;
  std::vector<Tracked> tracks;
  for (std::size_t i = 0; i < kTrue + kFalse; ++i) {
    const Truth<F> t(dice);  // of the false ones only this one view
    Tracked x{};
    x.look = colours<F>(dice);
    x.estimate = born_from(dice, t, optics, x.history.birth);
    x.history.counted = x.history.birth;
    x.history.track.state = State::kTentative;
    if (i < kTrue) truth.push_back(t);
    tracks.push_back(x);
  }
  for (std::uint32_t k = 1; k <= kFrames; ++k) {
    const Pose pose = turned_pose(1.5 * k);
    const auto cameras = feature::cameras<float>(pose.aligned(), optics.aligned());
    Scene<F> scene;
    for (int eye = 0; eye < 2; ++eye) {
      const double offset = eye == 0 ? 0 : optics.baseline;
      for (std::size_t i = 0; i < kTrue; ++i)
        if (dice.uniform(0, 1) < params.detection)
          scene.seen[eye].push_back(observation<F>(truth[i].observe(dice, pose, optics, offset), tracks[i].look));
      for (int i = 0; i < 60; ++i)  // chance, other in every frame and eye
        scene.seen[eye].push_back(observation<F>(Truth<F>(dice).observe(dice, pose, optics, offset), colours<F>(dice)));
    }
    std::vector<feature::Expected<F>> expected;
    std::vector<std::size_t> who;
    for (std::size_t i = 0; i < tracks.size(); ++i)
      if (tracks[i].alive) {
        expected.push_back(expect<F>(tracks[i].estimate, tracks[i].look));
        who.push_back(i);
      }
    scene.associate(expected, cameras.data());
    for (std::size_t e = 0; e < expected.size(); ++e) {
      Tracked& x = tracks[who[e]];
      const associate::Association& a = scene.out[e];
      const auto verdict =
          feature::judge<F>(x.history, a, expected[e], cameras.data(), scene.spans(), {0, 0, -1}, k, params);
      x.alive = verdict != existence::Verdict::kDelete;
      if (a.outcome == AssociateOutcome::kStereo) {
        const typename F::template View<float> seen[2] = {
            F::described(scene.seen[0][static_cast<std::size_t>(a.left)].view, a.left_sense),
            F::described(scene.seen[1][static_cast<std::size_t>(a.right)].view, a.right_sense)};
        feature::Estimate<F, float> estimate = x.estimate;
        const auto done = feature::update<F, 2>(estimate, cameras.data(), seen);
        if (done.good && done.visible) x.estimate = estimate;
      }
    }
  }
  std::size_t confirmed = 0, false_confirmed = 0, deleted = 0;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const bool is_confirmed = tracks[i].alive && tracks[i].history.track.state == State::kConfirmed;
    (i < kTrue ? confirmed : false_confirmed) += is_confirmed;
    deleted += i >= kTrue && !tracks[i].alive;
  }
  std::printf("confirmed: %zu of %zu true ones, %zu false ones; %zu of %zu false ones deleted\n", confirmed, kTrue,
              false_confirmed, deleted, kFalse);
  EXPECT_GE(confirmed, kTrue * 85 / 100);
  EXPECT_EQ(false_confirmed, 0U);
  EXPECT_GE(deleted, kFalse * 9 / 10);
}

// The same view again says nothing new, about any kind (METHOD 7.2).
TYPED_TEST(FeatureAssociation, a_view_that_has_not_changed_is_not_new) {
  using F = TypeParam;
  Dice dice(4);
  const Optics optics;
  const Truth<F> truth(dice);
  feature::BothViews<F> seen;
  const auto e = expect<F>(born_from(dice, truth, optics, seen), colours<F>(dice));
  const auto now = feature::cameras<float>(Pose().aligned(), optics.aligned());
  const auto later = feature::cameras<float>(turned_pose(5).aligned(), optics.aligned());
  feature::History<F> history{{}, seen, seen};
  history.track.state = State::kTentative;
  associate::Association match;
  match.outcome = AssociateOutcome::kStereo;
  match.log_likelihood_ratio = 3;
  for (std::uint32_t k = 0; k < 20; ++k)
    (void)feature::judge<F>(history, match, e, now.data(), {}, {0, 0, -1}, k, ExistenceParams{});
  EXPECT_EQ(history.track.novel_matches, 0U);
  EXPECT_EQ(history.track.log_odds, 0.0F);
  (void)feature::judge<F>(history, match, e, later.data(), {}, {0, 0, -1}, 21, ExistenceParams{});
  EXPECT_EQ(history.track.novel_matches, 1U);
  EXPECT_GT(history.track.log_odds, 2.0F);
}

}  // namespace
}  // namespace accrete::test
