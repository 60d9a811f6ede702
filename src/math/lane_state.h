// Primitives gathered out of the blocks into lanes, and scattered back.
#pragma once

#include <cstdint>

#include "accrete/primitive.h"
#include "math/so3.h"

namespace accrete::inline ACCRETE_ISA {

template <class S>
struct LaneState {
  Vector3<S> p;
  Quat<S> q;
  Symmetric<S, 6> P;
};

// P <- F P Ft with F = diag(R, I): the position into another frame; the rotation error is local and stays.
template <class S>
ACCRETE_INLINE void rotate_position_covariance(Symmetric<S, 6>& P, const Matrix3<S>& R) {
  Matrix3<S> pp, half;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) pp(i, j) = P(i, j);
  for (int j = 0; j < 3; ++j) {
    const Vector3<S> column = rotate<S>(R, pp.col(j));
    for (int i = 0; i < 3; ++i) half(i, j) = column[i];
  }
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) P(i, j) = half(i, 0) * R(j, 0) + half(i, 1) * R(j, 1) + half(i, 2) * R(j, 2);
  for (int j = 3; j < 6; ++j) {
    const Vector3<S> column = rotate<S>(R, {P(0, j), P(1, j), P(2, j)});
    for (int i = 0; i < 3; ++i) P(i, j) = column[i];
  }
}

// The covariance after the own frame was turned by `roll` about the tangent, R <- R Exp(roll, 0, 0): the tilts are
// components along axes that have turned. Exact for any angle.
template <class S>
ACCRETE_INLINE void turn_tilts(Symmetric<S, 6>& P, S roll) {
  const HalfAngle<S> h = half_angle(roll * roll);
  const S v = roll * h.sine_over_angle;
  const S c = S(1) - S(2) * v * v, s = S(2) * v * h.cosine;
  ACCRETE_UNROLL
  for (int i = 0; i < 4; ++i) {
    const S b = P(i, 4), a = P(i, 5);
    P(i, 4) = c * b + s * a;
    P(i, 5) = c * a - s * b;
  }
  const S bb = P(4, 4), ba = P(4, 5), aa = P(5, 5);
  P(4, 4) = c * c * bb + S(2) * c * s * ba + s * s * aa;
  P(4, 5) = c * s * (aa - bb) + (c * c - s * s) * ba;
  P(5, 5) = s * s * bb - S(2) * c * s * ba + c * c * aa;
}

// Up to kLanes slots. Lanes beyond `count` repeat the last one and are never stored.
template <int N>
struct LaneSlots {
  std::uint32_t slot[N];
  int count = 0;

  LaneSlots(const std::uint32_t* slots, std::size_t left) {
    count = left < N ? static_cast<int>(left) : N;
    for (int l = 0; l < N; ++l) slot[l] = slots[l < count ? l : count - 1];
  }
  // The element of a parallel array that lane `l` uses.
  [[nodiscard]] int element(int l) const { return l < count ? l : count - 1; }
};

// S of f(element) for each lane; f(int) -> float.
template <class S, int N, class F>
ACCRETE_INLINE S gather(const LaneSlots<N>& slots, F f) {
  static_assert(N == LaneTraits<S>::kLanes);
  alignas(64) float x[N];
  for (int l = 0; l < N; ++l) x[l] = f(slots.element(l));
  return load_lanes<S>(x);
}

// Rows first .. first + Rows - 1. All lanes are collected before the first wide load: a wide load right behind the
// narrow stores that it reads would wait for them to reach the cache.
template <int Rows, class S, int N, class Block>
ACCRETE_INLINE void gather_rows(const Block* blocks, const LaneSlots<N>& slots, int first, S* out) {
  alignas(64) float x[Rows][N];
  for (int l = 0; l < N; ++l) {
    const float* from = &blocks[slots.slot[l] / kBlockLanes].row[first][slots.slot[l] % kBlockLanes];
    for (int r = 0; r < Rows; ++r) x[r][l] = from[static_cast<std::size_t>(r) * kBlockLanes];
  }
  for (int r = 0; r < Rows; ++r) out[r] = load_lanes<S>(x[r]);
}
// Stores rows first .. first + Rows - 1 of the lanes for which the mask is true.
template <int Rows, class S, int N, class Block>
ACCRETE_INLINE void scatter_rows(const S* in, Bool<S> mask, int first, const LaneSlots<N>& slots, Block* blocks) {
  alignas(64) float x[Rows][N];
  for (int r = 0; r < Rows; ++r) store_lanes(in[r], x[r]);
  for (int l = 0; l < slots.count; ++l) {
    if (!lane(mask, l)) continue;
    float* to = &blocks[slots.slot[l] / kBlockLanes].row[first][slots.slot[l] % kBlockLanes];
    for (int r = 0; r < Rows; ++r) to[static_cast<std::size_t>(r) * kBlockLanes] = x[r][l];
  }
}

template <class S, int N>
ACCRETE_INLINE LaneState<S> gather_state(const GeometryBlock* blocks, const LaneSlots<N>& slots) {
  S row[GeometryBlock::kRows];
  gather_rows<GeometryBlock::kRows>(blocks, slots, 0, row);
  LaneState<S> x;
  x.p = {row[0], row[1], row[2]};
  x.q = {row[3], row[4], row[5], row[6]};
  for (int i = 0; i < 21; ++i) x.P.v[i] = row[GeometryBlock::kCovariance + i];
  return x;
}
template <class S, int N>
ACCRETE_INLINE void scatter_state(const LaneState<S>& x, Bool<S> mask, const LaneSlots<N>& slots,
                                  GeometryBlock* blocks) {
  S row[GeometryBlock::kRows] = {x.p[0], x.p[1], x.p[2], x.q.x, x.q.y, x.q.z, x.q.w};
  for (int i = 0; i < 21; ++i) row[GeometryBlock::kCovariance + i] = x.P.v[i];
  scatter_rows<GeometryBlock::kRows>(row, mask, 0, slots, blocks);
}

}  // namespace accrete::inline ACCRETE_ISA
