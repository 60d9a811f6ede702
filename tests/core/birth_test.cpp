// New primitives from stereo pairs, and duplicates that become one.
#include "store/birth.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/eye.h"
#include "core/storage.h"
#include "existence/evidence.h"
#include "store/merge.h"

namespace accrete {
namespace {

using namespace test;

// Where the map lies, seen from the left camera.
Transform<Left, Map> map_pose() {
  const Vec3 axis = unit({0.3, 1, -0.2});
  const double s = std::sin(0.35), c = std::cos(0.35);
  return {{axis[0] * s, axis[1] * s, axis[2] * s, c}, {0.05, -0.1, 0.9}};
}
AlignedPose aligned_pose(const Rig& rig, const Transform<Left, Map>& T) {
  const Mat3 R = rig.aligned.R_a_l * to_matrix(T.rotation);
  const Vec3 t = rig.aligned.R_a_l * T.translation;
  AlignedPose pose;
  for (std::size_t i = 0; i < 9; ++i) pose.R[i] = static_cast<float>(R[i]);
  for (std::size_t i = 0; i < 3; ++i) pose.t[i] = static_cast<float>(t[i]);
  return pose;
}

// Pairs of edges that lie well across the epipolar line.
struct Births {
  Rig rig;
  std::vector<Edge> edges;
  std::vector<Primitive2d> left, right;
  std::vector<StereoMatch> matches;
  std::vector<std::int32_t> left_owner, right_owner;
  std::vector<associate::Explained> explained;
  Params params;
  StepReport report;

  explicit Births(std::size_t n, std::uint64_t seed = 1) {
    Dice dice(seed);
    while (edges.size() < n) {
      const Edge e = random_edge(dice);
      Primitive2d l, r;
      if (!rig.see(e, 0, 0, l) || !rig.see(e, 1, dice.uniform(-2, 2), r)) continue;
      if (std::fabs(l.aligned.s) < 0.5F || std::fabs(r.aligned.s) < 0.5F) continue;
      const bool turned = l.aligned.c * r.aligned.c + l.aligned.s * r.aligned.s < 0;
      const auto i = static_cast<std::uint16_t>(edges.size());
      matches.push_back({i, i, turned, false, 0, 1, static_cast<float>(dice.uniform(0.1, 0.5))});
      edges.push_back(e);
      left.push_back(l);
      right.push_back(r);
    }
    left_owner.assign(n, associate::kNone);
    right_owner.assign(n, associate::kNone);
    explained.resize(n);
  }
  void operator()(Store& store, std::uint32_t frame = 5) {
    give_birth(
        {left, right, matches, left_owner, right_owner, explained, aligned_pose(rig, map_pose()), rig.optics, frame},
        params, store, report);
  }
};

TEST(Birth, primitives_lie_on_their_edges_in_the_map_with_their_looks) {
  Births births(60);
  OwnedStore store(64);
  births(*store);
  EXPECT_EQ(births.report.born, 60U);
  EXPECT_EQ(store->size(), 60U);
  const auto T_m_l = map_pose().inverse();
  for (std::uint32_t i = 0; i < 60; ++i) {
    const Edge& e = births.edges[i];
    const Primitive3d p = store.view().at(i);
    const Vec3 x = T_m_l * e.p, t = to_matrix(T_m_l.rotation) * e.t;
    const Vec3 d = Vec3{p.geometry.position[0], p.geometry.position[1], p.geometry.position[2]} - x;
    EXPECT_LT(norm(d), 2e-4);
    // The direction may be the other one of the two; then phase and sides are, too.
    const double along = dot(Vec3{p.tangent[0], p.tangent[1], p.tangent[2]}, t);
    EXPECT_GT(std::fabs(along), 0.9999);
    const Appearance look = along > 0 ? e.look : reversed(e.look);
    EXPECT_NEAR(wrap_two_pi(p.appearance.mean.phase - look.phase), 0, 1e-3);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(p.appearance.mean.left[c], look.left[c], 1e-5);
      EXPECT_NEAR(p.appearance.mean.right[c], look.right[c], 1e-5);
    }
    const Track& track = store->tracks[i];
    EXPECT_NEAR(p.existence, births.matches[i].probability, 1e-5);
    EXPECT_EQ(track.state, State::kTentative);
    EXPECT_EQ(track.first_frame, 5U);
    EXPECT_EQ(track.last_frame, 5U);
    EXPECT_EQ(track.observations, 1U);
    EXPECT_EQ(track.novel_matches, 0U);
    const Vec3 viewer = unit(T_m_l.translation - x);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(track.viewer[c], viewer[c], 1e-3);
    // A pitch of 6 px at that depth.
    const double depth = (births.rig.aligned.R_a_l * e.p)[2];
    EXPECT_NEAR(track.pitch_m, 6 * depth / births.rig.aligned.focal_px, 2e-5);
  }
}

TEST(Birth, nothing_is_born_where_something_explains_the_pair) {
  Births births(4);
  OwnedStore store(16);
  births.left_owner[0] = 3;
  births.right_owner[1] = 0;
  births.explained[2].right[0] = 2;
  births.explained[2].count = 1;
  births.explained[3].right[0] = 1;  // another pair of the same left primitive
  births.explained[3].count = 1;
  births(*store);
  EXPECT_EQ(births.report.born, 1U);
  EXPECT_NEAR(store.view().at(0).existence, births.matches[3].probability, 1e-5);
}

TEST(Birth, excluded_boxes_refuse_and_count) {
  Births births(40);
  OwnedStore store(64);
  births.params.excluded_count = 1;
  births.params.excluded[0] = {{-10, -10, -10}, {0, 10, 10}};  // half of the map
  births(*store);
  std::uint32_t inside = 0;
  for (const Edge& e : births.edges) inside += (map_pose().inverse() * e.p)[0] <= 0;
  EXPECT_GT(inside, 3U);
  EXPECT_EQ(births.report.birth_refused_excluded, inside);
  EXPECT_EQ(births.report.born, 40 - inside);
  for (std::uint32_t i = 0; i < store->size(); ++i) EXPECT_GT(store.view().at(i).geometry.position[0], 0);
}

TEST(Birth, degenerate_pairs_are_refused_and_counted) {
  Births births(8);
  // Two elements along the epipolar line: every disparity would do. And one pair that converges behind the cameras.
  for (auto* list : {&births.left, &births.right}) {
    (*list)[0].aligned.c = 1;
    (*list)[0].aligned.s = 0;
  }
  births.right[1].aligned = births.left[1].aligned;
  births.right[1].aligned.x_px += 30;
  births.matches[1].right_reversed = false;
  OwnedStore store(16);
  births(*store);
  EXPECT_EQ(births.report.birth_refused_degenerate + births.report.birth_refused_behind, 2U);
  EXPECT_EQ(births.report.born, 6U);
}

// UTM coordinates: float has steps of half a metre there.
TEST(Birth, maps_whose_origin_is_too_far_for_float_are_refused_and_counted) {
  Births births(8);
  OwnedStore store(16);
  StepReport& report = births.report;
  AlignedPose far = aligned_pose(births.rig, map_pose());
  for (const float distance : {5e6F, 1e18F, 1e30F, 3e38F}) {
    far.t[0] = distance;
    give_birth({births.left, births.right, births.matches, births.left_owner, births.right_owner, births.explained, far,
                births.rig.optics, 5},
               births.params, *store, report);
  }
  EXPECT_EQ(report.birth_refused_range, 32U);
  EXPECT_EQ(report.born, 0U);
}

TEST(Birth, a_full_store_makes_room_among_the_undecided_and_counts_the_rest) {
  Births births(60);
  OwnedStore store(32);
  for (int k = 0; k < 20; ++k) store.add(5, 0, State::kConfirmed);
  for (int k = 0; k < 12; ++k) store.add(-1);
  births(*store);
  EXPECT_EQ(store->size(), 32U);
  EXPECT_GT(births.report.evicted, 0U);
  EXPECT_LE(births.report.evicted, 12U);
  EXPECT_EQ(births.report.born, births.report.evicted);
  EXPECT_EQ(births.report.born + births.report.birth_refused_capacity, 60U);
  EXPECT_EQ(store.view().size(), 20U);  // the confirmed ones are all there
}

// Two primitives on one edge, `along` pixels apart, merged as in a frame that sees both.
struct Duplicates {
  Births births{1};
  OwnedStore store{16};
  StepReport report;

  Duplicates(double along, const Appearance& second_look, bool reverse_second = false) {
    Edge e;
    e.p = {0.02, 0.01, 0.8};
    e.t = unit({0.1, 1, 0.2});
    e.look.left = {0.2F, 0.3F, 0.4F};
    e.look.right = {0.7F, 0.6F, 0.5F};
    e.look.phase = 1.5F;
    births.left.clear();
    births.right.clear();
    births.matches.clear();
    for (std::uint16_t i = 0; i < 2; ++i) {
      if (i == 1) {
        e.p = e.p + (along * 0.8 / births.rig.aligned.focal_px) * e.t;
        e.look = second_look;
      }
      Primitive2d l, r;
      EXPECT_TRUE(births.rig.see(e, 0, 0, l) && births.rig.see(e, 1, 0, r));
      if (i == 1 && reverse_second) {
        l.aligned = reversed(l.aligned), r.aligned = reversed(r.aligned);
        l.appearance = reversed(l.appearance), r.appearance = reversed(r.appearance);
      }
      births.left.push_back(l);
      births.right.push_back(r);
      births.matches.push_back({i, i, false, false, 0, 1, 0.5F});
    }
    births.left_owner.assign(2, associate::kNone);
    births.right_owner.assign(2, associate::kNone);
    births.explained.resize(2);
    births(*store, 3);
    EXPECT_EQ(births.report.born, 2U);
    store->tracks[1].first_frame = 7;
    store->tracks[1].last_frame = 20;
    store->tracks[1].log_odds = 5;
    store->tracks[1].novel_matches = 6;
    store->tracks[1].motion_log_odds = 5;
    store->tracks[1].state = State::kConfirmed;
    store->tracks[0].observations = 9;
  }
  void merge() {
    const std::vector<std::uint32_t> slots = {0, 1};
    std::vector<PredictedObservation> predicted(2);
    predict_observations(store->geometry, slots, aligned_pose(births.rig, map_pose()), births.rig.optics, predicted);
    std::vector<associate::Expected> expected(2);
    for (std::size_t i = 0; i < 2; ++i) expected[i].predicted = predicted[i];
    std::vector<std::uint32_t> begin(kMergeCells + 1), order(2);
    merge_duplicates(slots, expected, begin, order, 0.15F, births.rig.optics.focal_px, *store, report);
  }
};
Appearance first_look() {
  Appearance a;
  a.left = {0.2F, 0.3F, 0.4F};
  a.right = {0.7F, 0.6F, 0.5F};
  a.phase = 1.5F;
  return a;
}

TEST(Merge, duplicates_become_one_whichever_way_they_are_described) {
  for (const bool turned : {false, true}) {
    Duplicates d(3, first_look(), turned);
    const Primitive3d before = d.store.view().at(0);
    const PrimitiveId gone = d.store.id(1);
    d.merge();
    EXPECT_EQ(d.report.merged, 1U);
    EXPECT_EQ(d.store->size(), 1U);
    Primitive3d p;
    EXPECT_EQ(d.store.view().find(gone, p), Status::kNotFound);
    // The older one stays, takes over the better existence, and does not add up correlated evidence.
    ASSERT_EQ(d.store.view().find(before.id, p), Status::kOk);
    EXPECT_EQ(p.state, State::kConfirmed);
    EXPECT_EQ(d.store->tracks[0].log_odds, 5);
    EXPECT_EQ(d.store->tracks[0].novel_matches, 6U);
    EXPECT_EQ(p.observations, 9U);
    EXPECT_EQ(p.first_frame, 3U);
    EXPECT_EQ(p.last_frame, 20U);
    // The same edge, no more certain than two correlated views allow.
    EXPECT_NEAR(dot(Vec3{p.tangent[0], p.tangent[1], p.tangent[2]},
                    Vec3{before.tangent[0], before.tangent[1], before.tangent[2]}),
                1, 1e-3);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(p.appearance.mean.left[c], before.appearance.mean.left[c], 1e-3);
  }
}

TEST(Merge, an_accepted_primitive_is_not_lost_to_an_undecided_one) {
  // Both at the bound of the log-odds, and only the younger one with enough novel views.
  Duplicates d(3, first_look());
  d.store->tracks[0].log_odds = d.store->tracks[1].log_odds = 6;
  d.merge();
  EXPECT_EQ(d.report.merged, 1U);
  EXPECT_EQ(d.store.view().state(0), State::kConfirmed);
  EXPECT_EQ(d.store->tracks[0].novel_matches, 6U);
}

TEST(Merge, other_places_and_other_looks_stay_apart) {
  Appearance other = first_look();
  other.right = {0.1F, 0.9F, 0.1F};
  other.left = {0.9F, 0.1F, 0.9F};
  Duplicates looks(2, other), far(8, first_look());
  looks.merge();
  far.merge();
  EXPECT_EQ(looks.report.merged, 0U);
  EXPECT_EQ(far.report.merged, 0U);
  EXPECT_EQ(looks.store->size(), 2U);
  EXPECT_EQ(far.store->size(), 2U);
}

TEST(Merge, a_primitive_that_was_just_released_is_left_alone) {
  Duplicates d(3, first_look());
  d.store->release(1);
  d.merge();
  EXPECT_EQ(d.report.merged, 0U);
  EXPECT_EQ(d.store->size(), 1U);
}

}  // namespace
}  // namespace accrete
