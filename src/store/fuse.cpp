#include "store/fuse.h"

#include <limits>

#include "math/record_state.h"
#include "store/fuse_kernel.h"

namespace accrete {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

LaneAppearance<float> lane_of(const AppearanceState& a) {
  LaneAppearance<float> x = {
      {a.mean.phase, a.mean.left[0], a.mean.left[1], a.mean.left[2], a.mean.right[0], a.mean.right[1], a.mean.right[2]},
      {}};
  for (std::size_t i = 0; i < 28; ++i) x.P.v[i] = a.covariance[i];
  return x;
}

AppearanceState record_of(const LaneAppearance<float>& x) {
  AppearanceState a;
  a.mean = {x.mean[0], {x.mean[1], x.mean[2], x.mean[3]}, {x.mean[4], x.mean[5], x.mean[6]}};
  for (std::size_t i = 0; i < 28; ++i) a.covariance[i] = x.P.v[i];
  return a;
}

float tangent_agreement(const Geometry& a, const Geometry& b) {
  const LaneState<float> x = state_of<float>(a), y = state_of<float>(b);
  return dot<float>(rotation_matrix(x.q).col(0), rotation_matrix(y.q).col(0));
}

}  // namespace

bool opposite(const Geometry& a, const Geometry& b) { return tangent_agreement(a, b) < 0; }

float merge_distance2(const Geometry& a, const Geometry& b, float bias_variance) {
  const float d2 = line_distance2(state_of<float>(a), state_of<float>(b), bias_variance);
  return d2 >= 0 ? d2 : kInfinity;
}

float appearance_distance2(const AppearanceState& a, const AppearanceState& b, bool is_opposite) {
  const float d2 = appearance_distance2(lane_of(a), lane_of(is_opposite ? reversed(b) : b));
  return d2 >= 0 ? d2 : kInfinity;
}

bool fuse_by_covariance_intersection(Geometry& into, AppearanceState& into_appearance, const Geometry& other,
                                     const AppearanceState& other_appearance) {
  const float agreement = tangent_agreement(into, other);
  if (!(abs_of(agreement) >= kMinAgreement)) return false;
  LaneState<float> x = state_of<float>(into);
  if (!fuse_lines(x, state_of<float>(agreement < 0 ? reversed(other) : other))) return false;

  LaneAppearance<float> look = lane_of(into_appearance);
  if (!fuse_appearance(look, lane_of(agreement < 0 ? reversed(other_appearance) : other_appearance))) return false;

  into = record_of(x);
  into_appearance = record_of(look);
  return true;
}

}  // namespace accrete
