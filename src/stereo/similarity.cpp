#include "stereo/similarity.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/elementary.h"

namespace accrete::stereo {
namespace {

struct Differences {
  float angle, phase;   // rad, absolute
  float left2, right2;  // squared distances of the side colours
  float flow;           // 0..1
  bool has_flow;
};

Differences compare(const Primitive2d& l, const Primitive2d& r, bool same_sense) {
  const Appearance& a = l.appearance;
  const Appearance b = same_sense ? r.appearance : reversed(r.appearance);
  Differences d{};
  const float cross = l.aligned.c * r.aligned.s - l.aligned.s * r.aligned.c;
  d.angle = asin_of(std::min(1.0F, std::fabs(cross)));
  d.phase = std::fabs(wrap_two_pi(a.phase - b.phase));
  for (std::size_t c = 0; c < 3; ++c) {
    d.left2 += (a.left[c] - b.left[c]) * (a.left[c] - b.left[c]);
    d.right2 += (a.right[c] - b.right[c]) * (a.right[c] - b.right[c]);
  }
  d.has_flow = l.has_flow && r.has_flow;
  if (d.has_flow) {
    // The normal of the reversed element points the other way: its flow along it changes sign.
    const float fr = same_sense ? r.flow_px : -r.flow_px;
    d.flow = std::fabs(l.flow_px - fr) / (std::fabs(l.flow_px) + std::fabs(fr) + 1.0F);
  }
  return d;
}

}  // namespace

float similarity(const Primitive2d& left, const Primitive2d& right, bool same_sense) {
  const Differences d = compare(left, right, same_sense);
  const float d_angle = d.angle / (kPi / 2), d_phase = d.phase / kPi;
  const float d_colour = 0.5F * (std::sqrt(d.left2) + std::sqrt(d.right2)) / 1.732F;
  if (d.has_flow) return 1 - (0.2F * d_angle + 0.25F * d_phase + 0.4F * d_colour + 0.15F * d.flow);
  return 1 - (0.25F * d_angle + 0.3F * d_phase + 0.45F * d_colour);
}

float mismatch(const Primitive2d& left, const Primitive2d& right, bool same_sense) {
  const Differences d = compare(left, right, same_sense);
  constexpr float kSigmaAngle = 15 * kPi / 180, kSigmaPhase = 0.5F, kSigmaColour = 0.08F;
  const auto square = [](float v) { return v * v; };
  // One side may be background that differs between the views: capped at 9, as in association (METHOD 5.3).
  return square(d.angle / kSigmaAngle) + square(d.phase / kSigmaPhase) +
         std::min(9.0F, d.left2 / (3 * square(kSigmaColour))) + std::min(9.0F, d.right2 / (3 * square(kSigmaColour)));
}

}  // namespace accrete::stereo
