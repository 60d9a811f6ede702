#include "accrete/model.h"

#include <algorithm>
#include <cmath>

#include "existence/evidence.h"
#include "existence/track.h"
#include "math/record_state.h"

namespace accrete {

State ModelView::state(std::size_t i) const { return tracks_[i].state; }

Primitive3d ModelView::at(std::size_t i) const {
  const Track& t = tracks_[i];
  Primitive3d p;
  p.id = {static_cast<std::uint32_t>(i) + 1, t.generation};
  p.state = t.state;
  p.existence = existence::probability(t.log_odds);
  p.geometry = load(geometry_[i / kBlockLanes], i % kBlockLanes);
  p.appearance = load(appearance_[i / kBlockLanes], i % kBlockLanes);
  const auto& q = p.geometry.quaternion;
  const float x = q[0], y = q[1], z = q[2], w = q[3];
  p.tangent = {1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)};
  // What fits worse than the others is less certain than it says (METHOD 1.4: the running innovation ratio).
  const float scale = std::max(1.0F, t.misfit / std::max(typical_misfit_, 0.05F));
  for (float& v : p.geometry.covariance) v *= scale;
  // The consider bias: what filtering does not shrink, across the edge (METHOD 1.4).
  const float bias2 = t.pitch_m * t.pitch_m * bias_per_pitch_ * bias_per_pitch_;
  for (const std::size_t across : {1U, 2U}) p.geometry.covariance[packed_index(6, across, across)] += bias2;
  LaneState<float> in_map = state_of<float>(p.geometry);
  rotate_position_covariance(in_map.P, rotation_matrix(in_map.q));
  p.geometry = record_of(in_map);
  // A component that changes with the view is known less well than a filter of given noise believes.
  for (std::size_t c = 0; c < 7; ++c) p.appearance.covariance[packed_index(7, c, c)] += t.reliability.scatter(c);
  p.seen = t.seen;
  p.observations = t.observations;
  p.misfit = t.misfit;
  p.first_frame = t.first_frame;
  p.last_frame = t.last_frame;
  return p;
}

float face_probability(const Primitive3d& primitive, const std::array<float, 3>& viewer_m) {
  const auto& q = primitive.geometry.quaternion;
  const std::array<float, 3> away = {2 * (q[0] * q[2] + q[3] * q[1]), 2 * (q[1] * q[2] - q[3] * q[0]),
                                     1 - 2 * (q[0] * q[0] + q[1] * q[1])};
  std::array<float, 3> v{};
  float n = 0, along = 0, toward = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    v[k] = viewer_m[k] - primitive.geometry.position[k];
    n += v[k] * v[k];
  }
  for (std::size_t k = 0; k < 3; ++k) {
    v[k] /= std::sqrt(std::max(n, 1e-12F));
    along += v[k] * primitive.tangent[k];
    toward -= v[k] * away[k];
  }
  const float across = std::sqrt(std::max(1 - along * along, 1e-6F));
  return face_probability(primitive.seen, v, toward / across,
                          std::sqrt(primitive.geometry.covariance[packed_index(6, 3, 3)]));
}

Status ModelView::find(PrimitiveId id, Primitive3d& out) const {
  if (id.is_null() || id.index1 > tracks_.size()) return Status::kNotFound;
  const Track& t = tracks_[id.index1 - 1];
  if (t.state == State::kFree || t.generation != id.generation) return Status::kNotFound;
  out = at(id.index1 - 1);
  return Status::kOk;
}

std::size_t ModelView::size() const {
  std::size_t n = 0;
  for (const Track& t : tracks_) n += t.state == State::kConfirmed || t.state == State::kPreserved;
  return n;
}

}  // namespace accrete
