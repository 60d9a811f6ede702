// Between the oracle and the kernels.
#pragma once

#include "math/lane_state.h"
#include "numeric/oracle.h"

namespace accrete::oracle {

template <class S>
LaneState<S> to_lane(const Edge& x) {
  const Eigen::Quaterniond q(x.R);
  LaneState<S> y;
  for (int i = 0; i < 3; ++i) y.p[i] = S(x.p[i]);
  y.q = {S(q.x()), S(q.y()), S(q.z()), S(q.w())};
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) y.P(i, j) = S(x.P(i, j));
  return y;
}

template <class S, int N>
MatrixXd to_matrix(const Symmetric<S, N>& P, int l = 0) {
  MatrixXd m(N, N);
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) m(i, j) = double{lane(P(i, j), l)};
  return m;
}

template <class S>
Edge to_state(const LaneState<S>& x, int l = 0) {
  Edge y;
  for (int i = 0; i < 3; ++i) y.p[i] = double{lane(x.p[i], l)};
  y.R =
      Eigen::Quaterniond(double{lane(x.q.w, l)}, double{lane(x.q.x, l)}, double{lane(x.q.y, l)}, double{lane(x.q.z, l)})
          .toRotationMatrix();
  y.P = to_matrix(x.P, l);
  return y;
}

}  // namespace accrete::oracle
