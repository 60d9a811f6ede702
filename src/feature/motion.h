// What a rigid motion of the map does to an estimate of any kind, exact or uncertain.
#pragma once

#include "feature/feature.h"
#include "predict/motion_noise.h"

namespace accrete::inline ACCRETE_ISA {
namespace feature {

// An exact rigid motion, in closed form: only a position's error in the map is in the frame that moves.
template <Feature F, class S>
void move(Estimate<F, S>& e, const Rigid<S>& motion) {
  constexpr int N = F::kTangent;
  e.x = F::moved(e.x, motion);
  if constexpr (!F::kPositionInMap) return;
  S half[3][3];  // R P_pp
  for (int j = 0; j < N; ++j) {
    const Vector3<S> column = rotate<S>(motion.R, {e.P(0, j), e.P(1, j), e.P(2, j)});
    for (int i = 0; i < 3; ++i) {
      if (j < 3)
        half[i][j] = column[i];
      else
        e.P(i, j) = column[i];
    }
  }
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j)
      e.P(i, j) = half[i][0] * motion.R(j, 0) + half[i][1] * motion.R(j, 1) + half[i][2] * motion.R(j, 2);
}

// An uncertain one: P += sum of the squares of what its six independent errors do to the state (METHOD 4.1), each to
// both sides, so that no kind needs a derivative.
template <Feature F, class S>
Bool<S> add_motion_noise(Estimate<F, S>& e, const MotionNoise& noise) {
  constexpr int N = F::kTangent;
  for (int k = 0; k < 6; ++k) {
    S side[2][N];
    for (int s = 0; s < 2; ++s) {
      const float sign = s == 0 ? 1.0F : -1.0F;
      const float* w = noise.rotation[k];
      Rigid<S> error;
      error.q = exp_rotation(S(sign * w[0]), S(sign * w[1]), S(sign * w[2]));
      error.R = rotation_matrix(error.q);
      const Vector3<S> centre = {S(noise.centre[0]), S(noise.centre[1]), S(noise.centre[2])};
      const Vector3<S> turned = rotate<S>(error.R, centre);
      for (int i = 0; i < 3; ++i) error.t[i] = centre[i] - turned[i] + S(sign * noise.translation[k][i]);
      F::local(e.x, F::moved(e.x, error), side[s]);
    }
    S d[N];
    for (int i = 0; i < N; ++i) d[i] = flush_tiny(S(0.5F) * (side[0][i] - side[1][i]));
    for (int i = 0; i < N; ++i)
      for (int j = i; j < N; ++j) e.P(i, j) += d[i] * d[j];
  }
  return make_definite(e.P);
}

}  // namespace feature
}  // namespace accrete::inline ACCRETE_ISA
