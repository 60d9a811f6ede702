// Eight neighbouring floats of each of N records anywhere in memory, as lanes: what gating needs of a pair lies in
// records that others share, so that nothing contiguous can be loaded (lane_records.h does that).
#pragma once

#include "math/lanes.h"

namespace accrete::inline ACCRETE_ISA {

// out[m], lane l: from[l][m], m < 8. An 8 x 8 transposition in every half of the registers.
template <class S>
ACCRETE_INLINE void load_octs(const float* const* from, S* out) {
  constexpr int N = LaneTraits<S>::kLanes;
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  if constexpr (N == 16) {
    // The forms without a mask warn in g++ 12.
    const auto low = [](__m512 a, __m512 b) { return _mm512_maskz_unpacklo_ps(0xFFFF, a, b); };
    const auto high = [](__m512 a, __m512 b) { return _mm512_maskz_unpackhi_ps(0xFFFF, a, b); };
    const auto low2 = [](__m512 a, __m512 b) {
      return _mm512_castpd_ps(_mm512_maskz_unpacklo_pd(0xFF, _mm512_castps_pd(a), _mm512_castps_pd(b)));
    };
    const auto high2 = [](__m512 a, __m512 b) {
      return _mm512_castpd_ps(_mm512_maskz_unpackhi_pd(0xFF, _mm512_castps_pd(a), _mm512_castps_pd(b)));
    };
    __m512 quad[2][4];  // [g][m]: floats m and m + 4 of records 8 g + 0 .. 3 and of records 8 g + 4 .. 7
    ACCRETE_UNROLL
    for (int g = 0; g < 2; ++g) {
      __m512 row[4];
      ACCRETE_UNROLL
      for (int j = 0; j < 4; ++j)
        row[j] = _mm512_maskz_insertf32x8(0xFFFF, _mm512_castps256_ps512(_mm256_loadu_ps(from[8 * g + j])),
                                          _mm256_loadu_ps(from[8 * g + j + 4]), 1);
      const __m512 a = low(row[0], row[1]), b = high(row[0], row[1]);
      const __m512 c = low(row[2], row[3]), d = high(row[2], row[3]);
      quad[g][0] = low2(a, c), quad[g][1] = high2(a, c), quad[g][2] = low2(b, d), quad[g][3] = high2(b, d);
    }
    ACCRETE_UNROLL
    for (int m = 0; m < 4; ++m) {
      using Native = NativeLanes<16>::Float;
      out[m] = Native(_mm512_maskz_shuffle_f32x4(0xFFFF, quad[0][m], quad[1][m], 0x88));
      out[m + 4] = Native(_mm512_maskz_shuffle_f32x4(0xFFFF, quad[0][m], quad[1][m], 0xDD));
    }
    return;
  }
#endif
#if defined(__AVX__)
  if constexpr (N == 8) {
    const auto low2 = [](__m256 a, __m256 b) {
      return _mm256_castpd_ps(_mm256_unpacklo_pd(_mm256_castps_pd(a), _mm256_castps_pd(b)));
    };
    const auto high2 = [](__m256 a, __m256 b) {
      return _mm256_castpd_ps(_mm256_unpackhi_pd(_mm256_castps_pd(a), _mm256_castps_pd(b)));
    };
    __m256 quad[2][4];  // [g][m]: floats m and m + 4 of records 4 g + 0 .. 3
    ACCRETE_UNROLL
    for (int g = 0; g < 2; ++g) {
      const float* const* at = from + 4 * g;
      const __m256 r0 = _mm256_loadu_ps(at[0]), r1 = _mm256_loadu_ps(at[1]);
      const __m256 r2 = _mm256_loadu_ps(at[2]), r3 = _mm256_loadu_ps(at[3]);
      const __m256 a = _mm256_unpacklo_ps(r0, r1), b = _mm256_unpackhi_ps(r0, r1);
      const __m256 c = _mm256_unpacklo_ps(r2, r3), d = _mm256_unpackhi_ps(r2, r3);
      quad[g][0] = low2(a, c), quad[g][1] = high2(a, c), quad[g][2] = low2(b, d), quad[g][3] = high2(b, d);
    }
    ACCRETE_UNROLL
    for (int m = 0; m < 4; ++m) {
      using Native = NativeLanes<8>::Float;
      out[m] = Native(_mm256_permute2f128_ps(quad[0][m], quad[1][m], 0x20));
      out[m + 4] = Native(_mm256_permute2f128_ps(quad[0][m], quad[1][m], 0x31));
    }
    return;
  }
#endif
#if defined(__SSE2__)
  if constexpr (N == 4) {
    ACCRETE_UNROLL
    for (int h = 0; h < 8; h += 4) {
      __m128 a = _mm_loadu_ps(from[0] + h), b = _mm_loadu_ps(from[1] + h);
      __m128 c = _mm_loadu_ps(from[2] + h), d = _mm_loadu_ps(from[3] + h);
      _MM_TRANSPOSE4_PS(a, b, c, d);
      using Native = NativeLanes<4>::Float;
      out[h] = Native(a), out[h + 1] = Native(b), out[h + 2] = Native(c), out[h + 3] = Native(d);
    }
    return;
  }
#endif
  if constexpr (N == 1) {
    for (int m = 0; m < 8; ++m) out[m] = S(from[0][m]);
  } else {
    alignas(64) float x[8][N];
    for (int l = 0; l < N; ++l)
      for (int m = 0; m < 8; ++m) x[m][l] = from[l][m];
    for (int m = 0; m < 8; ++m) out[m] = load_lanes<S>(x[m]);
  }
}

}  // namespace accrete::inline ACCRETE_ISA
