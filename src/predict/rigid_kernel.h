// What a rigid motion does to a state, in closed form. Errors are in the primitive's own frame, which moves along: an
// exact motion changes none of them, so that sigma points would give the same (docs/math/prediction.md; a test shows
// it).
#pragma once

#include "math/cholesky.h"
#include "math/lane_state.h"
#include "predict/motion_noise.h"

namespace accrete::inline ACCRETE_ISA {

// P += D G Q Gt Dt (METHOD 4.1): a sum of squares, so P stays positive definite, but for what rounding makes of a noise
// that is much larger than P.
template <class S>
ACCRETE_INLINE void add_motion_noise(LaneState<S>& x, const MotionNoise& noise) {
  const Matrix3<S> own = rotation_matrix(x.q);
  const Vector3<S> arm = {x.p[0] - S(noise.centre[0]), x.p[1] - S(noise.centre[1]), x.p[2] - S(noise.centre[2])};
  ACCRETE_ROLLED
  for (int k = 0; k < 6; ++k) {
    const float* r = noise.rotation[k];
    const Vector3<S> turn = {S(r[0]), S(r[1]), S(r[2])};
    Vector3<S> move = cross(turn, arm);
    for (int i = 0; i < 3; ++i) move[i] += S(noise.translation[k][i]);
    const Vector3<S> local_move = rotate_back(own, move), local_turn = rotate_back(own, turn);
    S d[6];
    ACCRETE_UNROLL
    for (int i = 0; i < 3; ++i) {
      d[i] = flush_tiny(local_move[i]);
      d[3 + i] = flush_tiny(local_turn[i]);
    }
    ACCRETE_UNROLL
    for (int i = 0; i < 6; ++i) {
      ACCRETE_UNROLL
      for (int j = i; j < 6; ++j) x.P(i, j) = x.P(i, j) + d[i] * d[j];
    }
  }
  make_definite(x.P);
}

// x -> (R p + t, R R_x). R row-major.
template <class S, class T>
ACCRETE_INLINE void predict_rigid(LaneState<S>& x, const T* rotation, const Quat<S>& q, const T* translation) {
  const Matrix3<S> R = matrix_from<S>(rotation);
  x.p = rotate(R, x.p);
  for (int i = 0; i < 3; ++i) x.p[i] += S(translation[i]);
  x.q = normalized(q * x.q);
}

}  // namespace accrete::inline ACCRETE_ISA
