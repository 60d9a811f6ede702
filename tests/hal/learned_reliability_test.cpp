// On a box one of whose faces changes its colours with the viewing angle: the variances of those colours say so
// (docs/math/filter.md, "Reliability"). Prints the figures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "memory/replay.h"

namespace accrete::hal {
namespace {

double median(std::vector<double>& v) {
  const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
  std::nth_element(v.begin(), middle, v.end());
  return *middle;
}

struct Variances {
  std::vector<double> shimmering, constant;  // mean of the six colour components, per primitive
};

Variances accumulate(const char* scene) {
  const auto a = std::make_unique<Accumulator<SmallLimits>>();
  bool first = true;
  test::replay(scene, 60, [&](const StereoRig& rig, const StereoFrame& frame, const Motion& motion) {
    if (first) {
      EXPECT_EQ(a->configure(rig), Status::kOk);
    }
    first = false;
    EXPECT_EQ(a->step(frame, motion).status, Status::kOk);
  });
  Variances out;
  const ModelView model = a->model();
  for (std::size_t i = 0; i < model.slots(); ++i) {
    if (model.state(i) != State::kConfirmed && model.state(i) != State::kPreserved) continue;
    const Primitive3d p = model.at(i);
    if (p.observations < 8) continue;
    // Well inside a face of the box (half sizes 60, 40 and 30 mm), so that both sides are of its paint.
    const auto& x = p.geometry.position;
    const std::array<float, 3> half{0.06F, 0.04F, 0.03F};
    int near = 0, face = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      if (std::fabs(std::fabs(x[k]) - half[k]) < 0.0015F) face = static_cast<int>(2 * k + (x[k] > 0));
      near += std::fabs(x[k]) > half[k] - 0.0015F;
    }
    if (near != 1) continue;
    double sum = 0;
    for (std::size_t c = 1; c < 7; ++c) sum += double{p.appearance.covariance[packed_index(7, c, c)]} / 6;
    (face == 5 ? out.shimmering : out.constant).push_back(sum);
  }
  return out;
}

TEST(LearnedReliability, colours_that_change_with_the_viewing_angle_have_three_times_the_variance) {
  Variances shimmer = accumulate("box-shimmer"), plain = accumulate("box-plain");
  for (const auto& [name, v] : {std::pair{"box-shimmer", &shimmer}, std::pair{"box-plain", &plain}}) {
    ASSERT_GE(v->shimmering.size(), 20U);
    ASSERT_GE(v->constant.size(), 60U);
    std::printf("%-12s median variance of the colours: face +z %.2e (%zu primitives), other faces %.2e (%zu)\n", name,
                median(v->shimmering), v->shimmering.size(), median(v->constant), v->constant.size());
  }
  EXPECT_GT(median(shimmer.shimmering), 3 * median(shimmer.constant));
  EXPECT_LT(median(plain.shimmering), 2 * median(plain.constant));
}

}  // namespace
}  // namespace accrete::hal
