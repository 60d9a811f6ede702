// Records of floats, one for each lane, turned into lanes, and back: structure of arrays out of an array of structures.
#pragma once

#include <utility>

#include "math/lane_state.h"

namespace accrete::inline ACCRETE_ISA {

#if defined(__AVX512F__)
// Where member m of record l lies: float (Members * l + m), in vector that / 16. A permutation looks at the lowest bits
// of its index only, so that one index serves for all vectors.
template <int Members>
struct RecordPermutation {
  alignas(64) std::int32_t index[Members][16];
  std::uint16_t mask[Members][Members];  // [member][vector]: lanes that come from it

  constexpr RecordPermutation() : index{}, mask{} {
    for (int m = 0; m < Members; ++m)
      for (int l = 0; l < 16; ++l) {
        const int at = Members * l + m;
        index[m][l] = at;
        mask[m][at / 16] = static_cast<std::uint16_t>(mask[m][at / 16] | (1U << static_cast<unsigned>(l)));
      }
  }
};
// Not a static of the function that uses it: as a part of a template that would be one for the whole program, whatever
// the instruction set (STB_GNU_UNIQUE, which cannot be made local).
template <int Members>
static constexpr RecordPermutation<Members> kRecordPermutation{};
#endif

// out[m], lane l: float m of record l; lanes beyond the last record repeat it.
template <class Record, int N>
ACCRETE_INLINE void load_records(const LaneSlots<N>& slots, const Record* records,
                                 typename LanesOf<N>::Type (&out)[sizeof(Record) / sizeof(float)]) {
  static_assert(std::is_trivially_copyable_v<Record> && alignof(Record) == alignof(float));
  constexpr int kMembers = sizeof(Record) / sizeof(float);
#if defined(__AVX512F__)
  if constexpr (N == 16) {
    if (slots.count == N) {
      constexpr const RecordPermutation<kMembers>& kAt = kRecordPermutation<kMembers>;
      __m512 v[kMembers];
      ACCRETE_UNROLL
      for (int m = 0; m < kMembers; ++m) std::memcpy(&v[m], reinterpret_cast<const char*>(records) + 64 * m, 64);
      ACCRETE_UNROLL
      for (int m = 0; m < kMembers; ++m) {
        __m512i index;
        std::memcpy(&index, kAt.index[m], 64);
        __m512 x = _mm512_permutex2var_ps(v[0], index, v[1]);
        ACCRETE_UNROLL
        for (int k = 2; k < kMembers; ++k) x = _mm512_mask_permutexvar_ps(x, kAt.mask[m][k], index, v[k]);
        out[m] = typename NativeLanes<16>::Float(x);
      }
      return;
    }
  }
#endif
  // All are stored before the first is loaded: a wide load right behind the narrow stores that it reads would wait.
  alignas(64) float x[kMembers][N];
  if (slots.count == N) {
    for (int l = 0; l < N; ++l)
      for (int m = 0; m < kMembers; ++m)
        std::memcpy(&x[m][l], reinterpret_cast<const char*>(records + l) + sizeof(float) * static_cast<std::size_t>(m),
                    sizeof(float));
  } else {
    for (int l = 0; l < N; ++l)
      for (int m = 0; m < kMembers; ++m)
        std::memcpy(
            &x[m][l],
            reinterpret_cast<const char*>(records + slots.element(l)) + sizeof(float) * static_cast<std::size_t>(m),
            sizeof(float));
  }
  for (int m = 0; m < kMembers; ++m) out[m] = load_lanes<typename LanesOf<N>::Type>(x[m]);
}

// Vectors of `a` and `b`: of every four neighbours the first (Half = 0) or the last two (2), Step at a time in turns.
template <int Half, int Step, class Native, int... I>
ACCRETE_INLINE Native interleave(Native a, Native b, std::integer_sequence<int, I...>) {
  constexpr int kLanes = sizeof...(I);
  return __builtin_shufflevector(a, b,
                                 (I / 4 * 4 + Half + I % 4 / (2 * Step) * Step + I % Step + I / Step % 2 * kLanes)...);
}
template <int First, class Native>
ACCRETE_INLINE auto quarter(Native x) {
  return __builtin_shufflevector(x, x, First, First + 1, First + 2, First + 3);
}

// to[l][m] = x[m], lane l, m < 4. All to[l] are written, in that order: if lanes repeat a record, the last one counts.
template <class S, int... L>
ACCRETE_INLINE void store_quads(const S* x, float* const* to, std::integer_sequence<int, L...>) {
  if constexpr (sizeof...(L) == 1) {
    for (int m = 0; m < 4; ++m) to[0][m] = static_cast<float>(x[m]);
  } else {
    constexpr std::integer_sequence<int, L...> kAll;
    const auto a = interleave<0, 1>(x[0].v, x[1].v, kAll), b = interleave<2, 1>(x[0].v, x[1].v, kAll);
    const auto c = interleave<0, 1>(x[2].v, x[3].v, kAll), d = interleave<2, 1>(x[2].v, x[3].v, kAll);
    // record[r], four lanes from 4 k: of lane 4 k + r
    const typename S::Native record[4] = {interleave<0, 2>(a, c, kAll), interleave<2, 2>(a, c, kAll),
                                          interleave<0, 2>(b, d, kAll), interleave<2, 2>(b, d, kAll)};
    ((*reinterpret_cast<NativeLanes<4>::InMemory*>(to[L]) = quarter<L / 4 * 4>(record[L % 4])), ...);
  }
}
template <class S>
ACCRETE_INLINE void store_quads(const S* x, float* const* to) {
  store_quads(x, to, std::make_integer_sequence<int, LaneTraits<S>::kLanes>{});
}

// A parallel array, as lanes.
template <int N>
ACCRETE_INLINE auto load_values(const LaneSlots<N>& slots, const float* values) {
  using S = typename LanesOf<N>::Type;
  if (slots.count == N) return load_lanes<S>(values);
  LaneBuffer<N> some;
  some.fill(slots, [&](int k) { return values[k]; });
  return some.template load<S>();
}

}  // namespace accrete::inline ACCRETE_ISA
