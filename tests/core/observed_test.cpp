// Frames of 2D-primitives instead of images: the same model as from the images that they were found in, and what is
// refused.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <memory>

#include "core/poster.h"

namespace accrete {
namespace {

using namespace test;

struct NoImages : PosterLimits {
  static constexpr std::size_t kMaxImageWidth = 0, kMaxImageHeight = 0;
};

ObservedFrame seen_by(const Accumulator<PosterLimits>& a, Timestamp t) {
  return {a.left_primitives(), a.right_primitives(), t};
}

TEST(Observed, gives_the_model_of_the_images) {
  Poster poster;
  const auto a = std::make_unique<Accumulator<PosterLimits>>();
  const auto b = std::make_unique<Accumulator<NoImages>>();
  EXPECT_LT(sizeof(*b), sizeof(*a));
  ASSERT_EQ(a->configure(poster.rig.rig), Status::kOk);
  ASSERT_EQ(b->configure(poster.rig.rig), Status::kOk);
  for (int k = 0; k < 8; ++k) {
    const StereoFrame frame = poster.render(k);
    const StepReport x = a->step(frame, Poster::motion(k));
    ASSERT_EQ(x.status, Status::kOk);
    const StepReport y = b->step(seen_by(*a, frame.t_left), Poster::motion(k));
    ASSERT_EQ(y.status, Status::kOk);
    EXPECT_EQ(y.left.primitives, x.left.primitives);
    EXPECT_EQ(y.matched_stereo, x.matched_stereo);
    EXPECT_EQ(y.born, x.born);
  }
  ASSERT_GT(a->model().size(), 20U);
  for (std::size_t i = 0; i < a->model().slots(); ++i) {
    ASSERT_EQ(a->model().state(i), b->model().state(i));
    if (a->model().state(i) == State::kFree) continue;
    const Primitive3d p = a->model().at(i), q = b->model().at(i);
    EXPECT_EQ(p.id, q.id);
    EXPECT_EQ(p.geometry.covariance, q.geometry.covariance);
    EXPECT_EQ(p.geometry.position, q.geometry.position);
    EXPECT_EQ(p.appearance.covariance, q.appearance.covariance);
    EXPECT_EQ(p.existence, q.existence);
  }
}

TEST(Observed, bad_frames_are_refused_and_change_nothing) {
  Poster poster;
  const auto a = std::make_unique<Accumulator<PosterLimits>>();
  const auto b = std::make_unique<Accumulator<NoImages>>();
  EXPECT_EQ(b->step(ObservedFrame{}, Poster::motion(0)).status, Status::kUnavailable);
  ASSERT_EQ(a->configure(poster.rig.rig), Status::kOk);
  ASSERT_EQ(b->configure(poster.rig.rig), Status::kOk);
  const StereoFrame frame = poster.render(0);
  ASSERT_EQ(a->step(frame, Poster::motion(0)).status, Status::kOk);
  EXPECT_EQ(b->step(frame, Poster::motion(0)).status, Status::kCapacityExceeded) << "it has no room for images";
  ASSERT_GT(a->left_primitives().size(), 10U);
  ASSERT_EQ(b->step(seen_by(*a, frame.t_left), Poster::motion(0)).status, Status::kOk);
  EXPECT_EQ(b->step(seen_by(*a, frame.t_left), Poster::motion(1)).status, Status::kInvalidArgument) << "time stands";

  const std::size_t born = [&] {
    std::size_t n = 0;
    for (std::size_t i = 0; i < b->model().slots(); ++i) n += b->model().state(i) != State::kFree;
    return n;
  }();
  const Timestamp later = poster.render(1).t_left;
  const auto refuses = [&](const char* what, auto change) {
    std::vector<Primitive2d> left(a->left_primitives().begin(), a->left_primitives().end());
    change(left.back());
    EXPECT_EQ(b->step({left, a->right_primitives(), later}, Poster::motion(1)).status, Status::kInvalidArgument)
        << what;
    EXPECT_EQ(b->step({a->right_primitives(), left, later}, Poster::motion(1)).status, Status::kInvalidArgument)
        << what;
  };
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
  for (const float bad : {kNaN, kInf, -kInf}) {
    refuses("position", [&](Primitive2d& p) { p.x_px = bad; });
    refuses("position", [&](Primitive2d& p) { p.y_px = bad; });
    refuses("orientation", [&](Primitive2d& p) { p.theta = bad; });
    refuses("flow", [&](Primitive2d& p) { p.flow_px = bad; });
    refuses("phase", [&](Primitive2d& p) { p.appearance.phase = bad; });
    refuses("colour", [&](Primitive2d& p) { p.appearance.right[1] = bad; });
  }
  refuses("outside the image", [](Primitive2d& p) { p.x_px = -1; });
  refuses("outside the image", [](Primitive2d& p) { p.y_px = 1e6F; });
  for (const float bad : {0.0F, -1.0F, 1e-30F, 1e30F, kNaN, kInf}) {
    refuses("deviation", [&](Primitive2d& p) { p.sigma_n_px = bad; });
    refuses("deviation", [&](Primitive2d& p) { p.sigma_theta = bad; });
    refuses("deviation", [&](Primitive2d& p) { p.sigma_phase = bad; });
    refuses("deviation", [&](Primitive2d& p) { p.sigma_colour = bad; });
  }
  const std::vector<Primitive2d> many(PosterLimits::kMaxPrimitives2d + 1, a->left_primitives().front());
  EXPECT_EQ(b->step({many, {}, later}, Poster::motion(1)).status, Status::kCapacityExceeded);

  std::size_t n = 0;
  for (std::size_t i = 0; i < b->model().slots(); ++i) n += b->model().state(i) != State::kFree;
  EXPECT_EQ(n, born);
  EXPECT_EQ(b->step(ObservedFrame{{}, {}, later}, Poster::motion(1)).status, Status::kOk)
      << "an empty frame is a frame";
}

}  // namespace
}  // namespace accrete
