// Primitives gathered out of the blocks into lanes, and scattered back.
#pragma once

#include <cstdint>
#include <type_traits>

#include "accrete/primitive.h"
#include "math/so3.h"

namespace accrete::inline ACCRETE_ISA {

// Errors: p [+] R dp, R [+] Exp(0, b, a) Exp(roll, 0, 0), all in the own frame (docs/math/prediction.md).
template <class S>
struct LaneState {
  Vector3<S> p;
  Quat<S> q;
  Symmetric<S, 6> P;  // of along, two across, roll, b, a
};

// What cameras see of a state's errors: the two across the edge and the two tilts. Not what is along it, nor the roll.
inline constexpr int kSeen[4] = {1, 2, 4, 5};
inline constexpr int kAlong = 0, kRoll = 3;

// P <- F P Ft with F = diag(R, I): the position's errors in other axes.
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

// Components I and I + 1 along axes that have turned by the angle of cosine c and sine s.
template <int I, class S>
ACCRETE_INLINE void turn_pair(Symmetric<S, 6>& P, S c, S s) {
  ACCRETE_UNROLL
  for (int k = 0; k < 6; ++k) {
    if (k == I || k == I + 1) continue;
    const S b = P(k, I), a = P(k, I + 1);
    P(k, I) = c * b + s * a;
    P(k, I + 1) = c * a - s * b;
  }
  const S bb = P(I, I), ba = P(I, I + 1), aa = P(I + 1, I + 1);
  const S cc = c * c, ss = s * s, cs = c * s;
  const S mixed = (cs + cs) * ba;
  P(I, I) = cc * bb + ss * aa + mixed;
  P(I, I + 1) = cs * (aa - bb) + (cc - ss) * ba;
  P(I + 1, I + 1) = ss * bb + cc * aa - mixed;
}

// The covariance after the own frame has turned by M, R <- R M, of which `roll` is the part about the tangent: position
// and tilts are components along axes that have turned. Exact for any angle.
template <class S>
ACCRETE_INLINE void turn_axes(Symmetric<S, 6>& P, const Quat<S>& M, const HalfTurn<S>& roll) {
  rotate_position_covariance(P, rotation_matrix(Quat<S>{-M.x, -M.y, -M.z, M.w}));
  turn_pair<4>(P, cosine_of(roll), sine_of(roll));
}
// The same where the frame has turned about the tangent alone.
template <class S>
ACCRETE_INLINE void turn_axes(Symmetric<S, 6>& P, const HalfTurn<S>& roll) {
  const S c = cosine_of(roll), s = sine_of(roll);
  turn_pair<1>(P, c, s);
  turn_pair<4>(P, c, s);
}

// x [+] d, and what the turn of the own frame makes of the covariance, which is already that of the new mean. own:
// rotation_matrix(x.q).
template <class S>
ACCRETE_INLINE void correct(LaneState<S>& x, const Matrix3<S>& own, const S* d) {
  const Vector3<S> move = rotate<S>(own, {d[0], d[1], d[2]});
  for (int i = 0; i < 3; ++i) x.p[i] += move[i];
  const HalfTurn<S> roll = half_turn(d[3]);
  const Quat<S> M = turn_of(roll, d[4], d[5]);
  x.q = normalized(x.q * M);
  turn_axes(x.P, M, roll);
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
// Where the mask is true: mostly everywhere, and then nothing has to be loaded and mixed.
template <class S>
ACCRETE_INLINE void store_state(Bool<S> mask, const LaneState<S>& x, LaneRows<float> to) {
  const auto all = [&](auto store) {
    for (int i = 0; i < 3; ++i) store(x.p[i], to[i]);
    store(x.q.x, to[3]);
    store(x.q.y, to[4]);
    store(x.q.z, to[5]);
    store(x.q.w, to[6]);
    ACCRETE_UNROLL
    for (int i = 0; i < 21; ++i) store(x.P.v[i], to[7 + i]);
  };
  if (__builtin_expect(all_of(mask), 1))
    all([](const S& v, float* row) { store_lanes(v, row); });
  else
    all([&](const S& v, float* row) { store_lanes_if(mask, v, row); });
}

// From lane `first` of a block.
template <class Block>
ACCRETE_INLINE auto rows_of(Block& block, std::size_t first) {
  return LaneRows<std::remove_reference_t<decltype(block.row[0][0])>>{&block.row[0][first], kBlockLanes};
}

}  // namespace accrete::inline ACCRETE_ISA
