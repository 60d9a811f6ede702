#include "store/fuse.h"

#include <limits>

#include "math/record_state.h"
#include "store/covariance_intersection.h"
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

// Fuses the five coordinates of the line and puts them back; the slide and its variance stay as they were.
bool fuse_lines(LaneState<float>& x, const LaneState<float>& other) {
  LocalLine<float> line = local_line(x, x.q, x.p);
  const LocalLine<float> second = local_line(other, x.q, x.p);
  float shift[5];
  const auto volume = [](const Symmetric<float, 5>& P) { return root_determinant(observable(P)); };
  if (!intersect_estimates(line.P, second.P, second.value, volume, shift)) return false;

  const Matrix3<float> own = rotation_matrix(x.q);
  const Vector3<float> t = own.col(0);
  float slide = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) slide += t[i] * x.P(i, j) * t[j];
  for (int i = 0; i < 3; ++i) x.p[i] += own(i, 1) * shift[0] + own(i, 2) * shift[1];
  x.q = retract(x.q, shift[2], shift[3], shift[4]);

  // Local position covariance: the slide, uncorrelated, and the fused block; then back to the map.
  constexpr int kRow[5] = {1, 2, 3, 4, 5};
  for (float& v : x.P.v) v = 0;
  x.P(0, 0) = slide;
  for (int i = 0; i < 5; ++i)
    for (int j = i; j < 5; ++j) x.P(kRow[i], kRow[j]) = line.P(i, j);
  rotate_position_covariance(x.P, own);
  turn_tilts(x.P, shift[2]);
  return slide > 0 && is_finite(x.q.w) && is_positive_definite(x.P);
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
  const LaneAppearance<float> second = lane_of(agreement < 0 ? reversed(other_appearance) : other_appearance);
  float difference[7], shift[7];
  for (int i = 0; i < 7; ++i) difference[i] = second.mean[i] - look.mean[i];
  difference[0] = wrap_phase(difference[0]);
  const auto volume = [](const Symmetric<float, 7>& P) { return root_determinant(P); };
  if (!intersect_estimates(look.P, second.P, difference, volume, shift)) return false;
  for (int i = 0; i < 7; ++i) look.mean[i] += shift[i];
  look.mean[0] = wrap_phase(look.mean[0]);

  into = record_of(x);
  into_appearance = record_of(look);
  return true;
}

}  // namespace accrete
