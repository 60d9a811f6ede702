#include "filter/view_change.h"

#include <algorithm>
#include <cmath>

#include "associate/gate.h"
#include "base/angles.h"
#include "base/elementary.h"

namespace accrete {
namespace {

constexpr float kDarkest = 0.05F, kMaxGain = 2.0F;  // a black side says nothing about the light

bool is_set(const Vec3f& v) { return dot3(v, v) > 0; }

// By how much the light has changed on a side.
float gain(const Vec3f& was, const Vec3f& is) {
  const float before = was[0] + was[1] + was[2], now = is[0] + is[1] + is[2];
  return before < 3 * kDarkest ? 1.0F : std::clamp(now / before, 1 / kMaxGain, kMaxGain);
}

// first: index of the side's first component in the state. light: the gain of the other side.
bool has_changed(const AppearanceState& s, std::size_t first, const Vec3f& was, const Vec3f& is, float light,
                 float independent_channels) {
  float same = 0, lit = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const float variance = s.covariance[packed_index(7, first + c, first + c)] + associate::kColourFloor2;
    const float d = is[c] - was[c], e = is[c] - light * was[c];
    same += d * d / variance;
    lit += e * e / variance;
  }
  return std::min(same, lit) * independent_channels / 3 > associate::kSideGate;
}

}  // namespace

float turned_about_tangent(const Geometry& geometry, const Vec3f& v) {
  const auto& q = geometry.quaternion;
  const float x = q[0], y = q[1], z = q[2], w = q[3];
  const Vec3f right{2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)};
  const Vec3f away{2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)};
  return atan2_of(dot3(v, right), -dot3(v, away));
}

Background background_sides(const Geometry& geometry, const Vec3f& toward_viewer, const AppearanceState& state,
                            const Appearance& seen, float independent_channels, HiddenSides& hidden) {
  const Appearance& was = state.mean;
  const float here = turned_about_tangent(geometry, toward_viewer);
  // away: +1 for the left side, -1 for the right one: the sense in which the viewer leaves it.
  const auto is_background = [&](float away, bool changed, Vec3f& from) {
    if (is_set(from) && away * wrap_two_pi(here - turned_about_tangent(geometry, from)) >= 0) return true;
    if (!changed || away * here <= 0) return false;
    from = toward_viewer;
    return true;
  };
  return {
      is_background(1, has_changed(state, 1, was.left, seen.left, gain(was.right, seen.right), independent_channels),
                    hidden.left),
      is_background(-1, has_changed(state, 4, was.right, seen.right, gain(was.left, seen.left), independent_channels),
                    hidden.right)};
}

}  // namespace accrete
