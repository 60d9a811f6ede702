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
  // Whole rows can be moved at once: all lanes in use, neighbours in one block, at a multiple of N.
  [[nodiscard]] bool is_contiguous() const {
    if (count != N || slot[0] % N != 0) return false;
    for (int l = 1; l < N; ++l)
      if (slot[l] != slot[0] + static_cast<std::uint32_t>(l)) return false;
    return true;
  }
  // The element of a parallel array that lane `l` uses.
  [[nodiscard]] int element(int l) const { return l < count ? l : count - 1; }
};

// N values of a parallel array, still in memory: fill all that are needed, then load them. A wide load right behind the
// narrow stores that it reads would wait for them to reach the cache.
template <int N>
struct LaneBuffer {
  alignas(64) float x[N];

  template <class F>
  ACCRETE_INLINE void fill(const LaneSlots<N>& slots, F f) {  // f(element) -> float
    for (int l = 0; l < N; ++l) x[l] = f(slots.element(l));
  }
  template <class S>
  [[nodiscard]] ACCRETE_INLINE S load() const {
    static_assert(N == LaneTraits<S>::kLanes);
    return load_lanes<S>(x);
  }
};

template <int Rows, int N>
struct RowBuffer {
  alignas(64) float x[Rows][N];

  template <class Block>
  ACCRETE_INLINE void fill(const LaneSlots<N>& slots, const Block* blocks, int first = 0) {
    if (slots.is_contiguous()) {
      const float* from = &blocks[slots.slot[0] / kBlockLanes].row[first][slots.slot[0] % kBlockLanes];
      for (int r = 0; r < Rows; ++r) std::memcpy(x[r], from + static_cast<std::size_t>(r) * kBlockLanes, sizeof(x[r]));
      return;
    }
    for (int l = 0; l < N; ++l) {
      const float* from = &blocks[slots.slot[l] / kBlockLanes].row[first][slots.slot[l] % kBlockLanes];
      for (int r = 0; r < Rows; ++r) x[r][l] = from[static_cast<std::size_t>(r) * kBlockLanes];
    }
  }
  // Stores the lanes for which the mask is true.
  template <class Block>
  ACCRETE_INLINE void scatter(Bool<typename LanesOf<N>::Type> mask, const LaneSlots<N>& slots, Block* blocks,
                              int first = 0) const {
    for (int l = 0; l < slots.count; ++l) {
      if (!lane(mask, l)) continue;
      float* to = &blocks[slots.slot[l] / kBlockLanes].row[first][slots.slot[l] % kBlockLanes];
      for (int r = 0; r < Rows; ++r) to[static_cast<std::size_t>(r) * kBlockLanes] = x[r][l];
    }
  }
};

// Whole rows of a block, from lane `first`.
template <class S>
ACCRETE_INLINE void load_state(const GeometryBlock& from, std::size_t first, LaneState<S>& x) {
  for (int i = 0; i < 3; ++i) x.p[i] = load_lanes<S>(&from.row[i][first]);
  x.q = {load_lanes<S>(&from.row[3][first]), load_lanes<S>(&from.row[4][first]), load_lanes<S>(&from.row[5][first]),
         load_lanes<S>(&from.row[6][first])};
  for (int i = 0; i < 21; ++i) x.P.v[i] = load_lanes<S>(&from.row[7 + i][first]);
}
template <class S>
ACCRETE_INLINE void store_state(const LaneState<S>& x, GeometryBlock& to, std::size_t first) {
  for (int i = 0; i < 3; ++i) store_lanes(x.p[i], &to.row[i][first]);
  store_lanes(x.q.x, &to.row[3][first]);
  store_lanes(x.q.y, &to.row[4][first]);
  store_lanes(x.q.z, &to.row[5][first]);
  store_lanes(x.q.w, &to.row[6][first]);
  for (int i = 0; i < 21; ++i) store_lanes(x.P.v[i], &to.row[7 + i][first]);
}

template <class S, int N>
ACCRETE_INLINE void load_state(const RowBuffer<GeometryBlock::kRows, N>& from, LaneState<S>& x) {
  for (int i = 0; i < 3; ++i) x.p[i] = load_lanes<S>(from.x[i]);
  x.q = {load_lanes<S>(from.x[3]), load_lanes<S>(from.x[4]), load_lanes<S>(from.x[5]), load_lanes<S>(from.x[6])};
  for (int i = 0; i < 21; ++i) x.P.v[i] = load_lanes<S>(from.x[7 + i]);
}
template <class S, int N>
ACCRETE_INLINE void store_state(const LaneState<S>& x, RowBuffer<GeometryBlock::kRows, N>& to) {
  for (int i = 0; i < 3; ++i) store_lanes(x.p[i], to.x[i]);
  store_lanes(x.q.x, to.x[3]);
  store_lanes(x.q.y, to.x[4]);
  store_lanes(x.q.z, to.x[5]);
  store_lanes(x.q.w, to.x[6]);
  for (int i = 0; i < 21; ++i) store_lanes(x.P.v[i], to.x[7 + i]);
}

}  // namespace accrete::inline ACCRETE_ISA
