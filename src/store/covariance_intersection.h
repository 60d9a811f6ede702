// Covariance intersection: P^-1 = w P1^-1 + (1 - w) P2^-1 is consistent whatever the correlation between the two
// (Julier and Uhlmann 1997). An information sum would count common errors of motion and calibration twice.
#pragma once

#include "math/cholesky.h"

namespace accrete::inline ACCRETE_ISA {

// A^-1 of a positive definite A in place; false when it is not.
template <int N, class S>
bool invert(Symmetric<S, N>& a) {
  Symmetric<S, N> root = a;
  S inverse[N];
  if (!cholesky<N>(root, root, inverse)) return false;
  for (int i = 0; i < N; ++i) {
    S column[N] = {};
    column[i] = S(1);
    solve_lower<N>(root, inverse, column);
    solve_lower_transposed<N>(root, inverse, column);
    for (int j = i; j < N; ++j) a(i, j) = column[j];
  }
  return true;
}

// The covariance for weight w of the first, from both inverses.
template <int N, class S>
bool intersect_covariances(const Symmetric<S, N>& inverse1, const Symmetric<S, N>& inverse2, S w, Symmetric<S, N>& P) {
  for (int i = 0; i < Symmetric<S, N>::kSize; ++i) P.v[i] = w * inverse1.v[i] + (S(1) - w) * inverse2.v[i];
  return invert(P);
}

// Fuses P2 and x2 - x1 into P1. `volume` says how large a covariance is: the weight that makes it smallest among
// 0.1 .. 0.9 is taken (METHOD 6.6). On success P1 is the fused covariance and `shift` what is added to x1.
template <int N, class S, class Volume>
bool intersect_estimates(Symmetric<S, N>& P1, const Symmetric<S, N>& P2, const S* difference, Volume volume, S* shift) {
  Symmetric<S, N> inverse1 = P1, inverse2 = P2, best = P1;
  if (!invert(inverse1) || !invert(inverse2)) return false;
  S best_volume = S(0), best_w = S(-1);
  for (int step = 1; step <= 9; ++step) {
    const S w = S(static_cast<float>(step)) * S(0.1F);
    Symmetric<S, N> P;
    if (!intersect_covariances(inverse1, inverse2, w, P)) continue;
    const S size = volume(P);
    if (!is_finite(size) || (best_w > S(0) && !(size < best_volume))) continue;
    best_volume = size;
    best_w = w;
    best = P;
  }
  if (!(best_w > S(0)) || !is_positive_definite(best)) return false;
  S weighted[N] = {};
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) weighted[i] += (S(1) - best_w) * inverse2(i, j) * difference[j];
  for (int i = 0; i < N; ++i) {
    shift[i] = S(0);
    for (int j = 0; j < N; ++j) shift[i] += best(i, j) * weighted[j];
    if (!is_finite(shift[i])) return false;
  }
  P1 = best;
  return true;
}

// Product of the pivots of the root: the square root of the determinant, larger for larger covariances.
template <int N, class S>
S root_determinant(Symmetric<S, N> P) {
  S inverse[N];
  cholesky<N>(P, P, inverse);
  S product = S(1);
  for (int i = 0; i < N; ++i) product = product * P(i, i);
  return product;
}

}  // namespace accrete::inline ACCRETE_ISA
