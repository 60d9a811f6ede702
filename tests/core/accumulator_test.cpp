// All stages joined: what comes out of a small world, and that it is the same every time.
#include "accrete/accumulator.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/poster.h"

namespace accrete {
namespace {

using namespace test;

using Small = Accumulator<PosterLimits>;

std::unique_ptr<Small> configured(const Poster& poster, const Params& params = {}) {
  auto a = std::make_unique<Small>();
  EXPECT_EQ(a->configure(poster.rig.rig, params), Status::kOk);
  return a;
}
std::vector<Primitive3d> accepted(const ModelView& model) {
  std::vector<Primitive3d> out;
  for (std::size_t i = 0; i < model.slots(); ++i)
    if (model.state(i) == State::kConfirmed || model.state(i) == State::kPreserved) out.push_back(model.at(i));
  return out;
}
std::uint32_t alive(const StepReport& r) { return r.tentative + r.confirmed + r.preserved; }
std::uint32_t removed(const StepReport& r) {
  return r.deleted_existence + r.deleted_undecided + r.deleted_background + r.merged + r.evicted;
}

TEST(Accumulator, a_turned_poster_becomes_a_model_of_its_edges) {
  Poster poster;
  const auto a = configured(poster);
  std::uint32_t before = 0, updated = 0, failed = 0;
  StepReport r;
  for (int k = 0; k < 24; ++k) {
    r = a->step(poster.render(k), Poster::motion(k));
    ASSERT_EQ(r.status, Status::kOk);
    EXPECT_EQ(r.frame, static_cast<std::uint32_t>(k));
    // Nobody comes or goes uncounted.
    EXPECT_EQ(alive(r), before + r.born - removed(r)) << k;
    before = alive(r);
    EXPECT_EQ(r.left.primitives, a->left_primitives().size());
    EXPECT_EQ(r.right.primitives, a->right_primitives().size());
    EXPECT_EQ(r.stereo_matches, a->stereo_matches().size());
    EXPECT_EQ(r.predicted_visible, r.matched_stereo + r.matched_mono + r.missed + r.ambiguous + r.starved);
    updated += r.updated;
    failed += r.not_positive_definite;
    EXPECT_FALSE(r.motion_covariance_is_default);
  }
  EXPECT_GT(updated, 2000U);
  EXPECT_LE(failed * 1000, updated);  // rounding: such a primitive keeps its state
  const auto model = accepted(a->model());
  EXPECT_EQ(model.size(), a->model().size());
  EXPECT_EQ(model.size(), r.confirmed + r.preserved);
  EXPECT_GT(model.size(), 150U);
  std::size_t on_plane = 0, inside = 0;
  std::vector<double> height;
  for (const Primitive3d& p : model) {
    const double h = std::fabs(double{p.geometry.position[2]});
    height.push_back(h);
    on_plane += h < 2e-3;
    inside += std::fabs(double{p.geometry.position[0]}) < Poster::kWidth / 2 + 3e-3 &&
              std::fabs(double{p.geometry.position[1]}) < Poster::kHeight / 2 + 3e-3 && h < 0.02;
    EXPECT_GT(p.existence, 0.5F);
    EXPECT_GE(p.observations, 3U);
  }
  std::nth_element(height.begin(), height.begin() + static_cast<std::ptrdiff_t>(height.size() / 2), height.end());
  EXPECT_LT(height[height.size() / 2], 6e-4);
  EXPECT_GT(static_cast<double>(on_plane), 0.9 * static_cast<double>(model.size()));
  // The bars of the wall do not move along.
  EXPECT_GT(static_cast<double>(inside), 0.97 * static_cast<double>(model.size()));
  RecordProperty("model", std::to_string(model.size()) + " median " + std::to_string(height[height.size() / 2] * 1e3) +
                              " mm, on plane " + std::to_string(on_plane) + ", inside " + std::to_string(inside));
}

TEST(Accumulator, two_of_them_build_identical_models_whatever_happens_between) {
  Poster poster;
  const auto a = configured(poster), b = configured(poster);
  // The second has lived before: another rig's images, emptied by configure.
  Poster other(7);
  for (int k = 0; k < 4; ++k) (void)b->step(other.render(k), Poster::motion(k));
  ASSERT_EQ(b->configure(poster.rig.rig), Status::kOk);
  for (int k = 0; k < 8; ++k) {
    const StereoFrame f = poster.render(k);
    (void)a->step(f, Poster::motion(k));
    (void)b->step(f, Poster::motion(k));
    EXPECT_TRUE(same(all_slots(a->model()), all_slots(b->model()), false)) << k;  // but for the generations
  }
  EXPECT_GT(a->model().size(), 0U);
}

TEST(Accumulator, reset_empties_and_begins_anew) {
  Poster poster;
  const auto a = configured(poster), fresh = configured(poster);
  for (int k = 0; k < 6; ++k) (void)a->step(poster.render(k), Poster::motion(k));
  PrimitiveId id{};
  for (std::size_t i = 0; i < a->model().slots() && id.is_null(); ++i)
    if (a->model().state(i) != State::kFree) id = a->model().at(i).id;
  ASSERT_FALSE(id.is_null());
  a->reset();
  EXPECT_EQ(a->model().size(), 0U);
  EXPECT_TRUE(a->left_primitives().empty());
  EXPECT_TRUE(a->stereo_matches().empty());
  Primitive3d p;
  EXPECT_EQ(a->model().find(id, p), Status::kNotFound);
  // Time may begin anew as well, and the result is that of a new one.
  for (int k = 0; k < 6; ++k) {
    const StereoFrame f = poster.render(k);
    EXPECT_EQ(a->step(f, Poster::motion(k)).frame, static_cast<std::uint32_t>(k));
    (void)fresh->step(f, Poster::motion(k));
  }
  EXPECT_TRUE(same(all_slots(a->model()), all_slots(fresh->model()), false));
  EXPECT_EQ(a->model().find(id, p), Status::kNotFound);
}

TEST(Accumulator, moving_the_cameras_is_the_same_as_moving_the_poster) {
  Poster poster;
  const auto a = configured(poster), b = configured(poster);
  for (int k = 0; k < 10; ++k) {
    const StereoFrame f = poster.render(k);
    Motion m = Motion::camera(Poster::time_of(k), retag<World, Left>(Poster::pose(k).inverse()));
    EXPECT_EQ(m.mode, MotionMode::kCameraMoves);
    m.error = PoseError::kAbsolute;
    m.covariance = Poster::motion(k).covariance;
    (void)a->step(f, Poster::motion(k));
    (void)b->step(f, m);
  }
  const auto x = all_slots(a->model()), y = all_slots(b->model());
  std::size_t alike = 0, used = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i].state == State::kFree) continue;
    ++used;
    alike += y[i].state != State::kFree && norm(Vec3{x[i].geometry.position[0] - y[i].geometry.position[0],
                                                     x[i].geometry.position[1] - y[i].geometry.position[1],
                                                     x[i].geometry.position[2] - y[i].geometry.position[2]}) < 1e-4;
  }
  EXPECT_GT(used, 200U);
  EXPECT_GE(alike * 100, used * 98);  // inverting a pose twice rounds
}

TEST(Accumulator, what_a_bar_hides_is_preserved_and_comes_back) {
  Poster poster;
  const auto a = configured(poster);
  int k = 0;
  StepReport r;
  for (; k < 24; ++k) r = a->step(poster.render(k), Poster::motion(k));
  const auto before = accepted(a->model());
  ASSERT_GT(before.size(), 100U);
  poster.occluded = true;
  for (; k < 54; ++k) r = a->step(poster.render(k), Poster::motion(k));
  std::size_t kept = 0;
  Primitive3d p;
  for (const Primitive3d& q : before) kept += a->model().find(q.id, p) == Status::kOk;
  const std::uint32_t preserved = r.preserved;
  EXPECT_GT(preserved, 30U);
  EXPECT_GT(kept * 100, before.size() * 80);
  poster.occluded = false;
  for (; k < 70; ++k) r = a->step(poster.render(k), Poster::motion(k));
  std::size_t again = 0;
  for (const Primitive3d& q : before)
    again += a->model().find(q.id, p) == Status::kOk && p.last_frame >= 56 && p.state != State::kTentative;
  EXPECT_GT(again * 100, before.size() * 60);
  RecordProperty("kept", std::to_string(kept) + " of " + std::to_string(before.size()) + ", preserved then " +
                             std::to_string(preserved) + ", seen again " + std::to_string(again));
}

TEST(Accumulator, tells_an_observer_of_every_stage_once_and_properly_nested) {
  Poster poster;
  const auto a = configured(poster);
  std::vector<std::pair<Stage, bool>> told;
  a->set_observer({[](void* context, Stage stage, bool begins) {
                     static_cast<std::vector<std::pair<Stage, bool>>*>(context)->emplace_back(stage, begins);
                   },
                   &told});
  (void)a->step(poster.render(0), Poster::motion(0));
  ASSERT_EQ(told.size(), std::size_t{2 * kStageCount});
  std::array<int, kStageCount> times{};
  for (std::size_t i = 0; i < told.size(); i += 2) {
    EXPECT_EQ(told[i].first, told[i + 1].first);
    EXPECT_TRUE(told[i].second);
    EXPECT_FALSE(told[i + 1].second);
    ++times[static_cast<std::size_t>(told[i].first)];
  }
  for (const int n : times) EXPECT_EQ(n, 1);
  a->set_observer({});
  told.clear();
  (void)a->step(poster.render(1), Poster::motion(1));
  EXPECT_TRUE(told.empty());
}

}  // namespace
}  // namespace accrete
