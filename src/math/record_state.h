// Between the records of primitive.h and the state of one scalar lane.
#pragma once

#include "math/lane_state.h"

namespace accrete::inline ACCRETE_ISA {

template <class S>
LaneState<S> state_of(const Geometry& g) {
  LaneState<S> x;
  for (int i = 0; i < 3; ++i) x.p[i] = S(g.position[static_cast<std::size_t>(i)]);
  x.q = {S(g.quaternion[0]), S(g.quaternion[1]), S(g.quaternion[2]), S(g.quaternion[3])};
  for (std::size_t i = 0; i < 21; ++i) x.P.v[i] = S(g.covariance[i]);
  return x;
}

template <class S>
Geometry record_of(const LaneState<S>& x) {
  Geometry g;
  for (int i = 0; i < 3; ++i) g.position[static_cast<std::size_t>(i)] = static_cast<float>(x.p[i]);
  g.quaternion = {static_cast<float>(x.q.x), static_cast<float>(x.q.y), static_cast<float>(x.q.z),
                  static_cast<float>(x.q.w)};
  for (std::size_t i = 0; i < 21; ++i) g.covariance[i] = static_cast<float>(x.P.v[i]);
  return g;
}

}  // namespace accrete::inline ACCRETE_ISA
