// Primitives gathered out of the blocks into lanes, and scattered back.
#pragma once

#include <cstdint>
#include <type_traits>

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
ACCRETE_INLINE void turn_tilts(Symmetric<S, 6>& P, const HalfTurn<S>& roll) {
  const S twice = roll.sine + roll.sine;
  const S c = S(1) - twice * roll.sine, s = twice * roll.cosine;
  ACCRETE_UNROLL
  for (int i = 0; i < 4; ++i) {
    const S b = P(i, 4), a = P(i, 5);
    P(i, 4) = c * b + s * a;
    P(i, 5) = c * a - s * b;
  }
  const S bb = P(4, 4), ba = P(4, 5), aa = P(5, 5);
  const S cc = c * c, ss = s * s, cs = c * s;
  const S mixed = (cs + cs) * ba;
  P(4, 4) = cc * bb + ss * aa + mixed;
  P(4, 5) = cs * (aa - bb) + (cc - ss) * ba;
  P(5, 5) = ss * bb + cc * aa - mixed;
}
template <class S>
ACCRETE_INLINE void turn_tilts(Symmetric<S, 6>& P, S roll) {
  turn_tilts(P, half_turn(roll));
}

// Up to N slots. Lanes beyond `count` repeat the last one and are never stored.
template <int N>
struct LaneSlots {
  std::uint32_t slot[N];
  int count = 0;
  // Whole rows can be moved at once: all lanes in use, neighbours in one block, at a multiple of N.
  bool is_contiguous = false;

  ACCRETE_INLINE LaneSlots(const std::uint32_t* slots, std::size_t left) {
    count = left < N ? static_cast<int>(left) : N;
    for (int l = 0; l < N; ++l) slot[l] = slots[l < count ? l : count - 1];
    std::uint32_t differs = slot[0] % N;
    for (int l = 1; l < N; ++l) differs |= slot[l] ^ (slot[0] + static_cast<std::uint32_t>(l));
    is_contiguous = count == N && differs == 0;
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

// The rows of a batch, `stride` floats apart.
template <class T>
struct LaneRows {
  T* first;
  std::size_t stride;

  [[nodiscard]] ACCRETE_INLINE T* operator[](int r) const { return first + static_cast<std::size_t>(r) * stride; }
};

// The rows of a batch where they are, or, if the slots are scattered, gathered here.
template <int Rows, int N>
struct RowBuffer {
  alignas(64) float x[Rows][N];

  template <class Block>
  ACCRETE_INLINE auto rows(const LaneSlots<N>& slots, Block* blocks) {
    const auto at = [&](int l) { return &blocks[slots.slot[l] / kBlockLanes].row[0][slots.slot[l] % kBlockLanes]; };
    using T = std::remove_pointer_t<decltype(at(0))>;
    if (slots.is_contiguous) return LaneRows<T>{at(0), kBlockLanes};
    for (int l = 0; l < N; ++l) {
      const float* from = at(l);
      for (int r = 0; r < Rows; ++r) x[r][l] = from[static_cast<std::size_t>(r) * kBlockLanes];
    }
    return LaneRows<T>{x[0], N};
  }
  // After the rows were changed: back to where they came from.
  template <class Block>
  ACCRETE_INLINE void scatter(const LaneSlots<N>& slots, Block* blocks) const {
    if (slots.is_contiguous) return;
    for (int l = 0; l < slots.count; ++l) {
      float* to = &blocks[slots.slot[l] / kBlockLanes].row[0][slots.slot[l] % kBlockLanes];
      for (int r = 0; r < Rows; ++r) to[static_cast<std::size_t>(r) * kBlockLanes] = x[r][l];
    }
  }
};

// Stores where the mask is true.
template <class S>
ACCRETE_INLINE void store_lanes_if(Bool<S> mask, S x, float* to) {
  store_lanes(select(mask, x, load_lanes<S>(to)), to);
}

template <class S, class T>
ACCRETE_INLINE void load_state(LaneRows<T> from, LaneState<S>& x) {
  for (int i = 0; i < 3; ++i) x.p[i] = load_lanes<S>(from[i]);
  x.q = {load_lanes<S>(from[3]), load_lanes<S>(from[4]), load_lanes<S>(from[5]), load_lanes<S>(from[6])};
  ACCRETE_UNROLL
  for (int i = 0; i < 21; ++i) x.P.v[i] = load_lanes<S>(from[7 + i]);
}
// Where the mask is true.
template <class S>
ACCRETE_INLINE void store_state(Bool<S> mask, const LaneState<S>& x, LaneRows<float> to) {
  for (int i = 0; i < 3; ++i) store_lanes_if(mask, x.p[i], to[i]);
  store_lanes_if(mask, x.q.x, to[3]);
  store_lanes_if(mask, x.q.y, to[4]);
  store_lanes_if(mask, x.q.z, to[5]);
  store_lanes_if(mask, x.q.w, to[6]);
  ACCRETE_UNROLL
  for (int i = 0; i < 21; ++i) store_lanes_if(mask, x.P.v[i], to[7 + i]);
}

// From lane `first` of a block.
template <class Block>
ACCRETE_INLINE auto rows_of(Block& block, std::size_t first) {
  return LaneRows<std::remove_reference_t<decltype(block.row[0][0])>>{&block.row[0][first], kBlockLanes};
}

}  // namespace accrete::inline ACCRETE_ISA
