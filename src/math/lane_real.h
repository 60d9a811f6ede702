// The elementary functions (base/elementary.h) on lanes: what they need to know of a pack.
#pragma once

#include "base/real.h"
#include "math/lanes.h"

template <int N>
struct accrete::Real<accrete::Pack<N>> {
  using Format = Binary32;
  // A vector of integers that also takes part in the scalar form's expressions.
  struct Int {
    typename Mask<N>::Native v;
    Int(typename Mask<N>::Native native) : v(native) {}         // NOLINT(google-explicit-constructor): as Pack
    Int(std::int32_t x) : v(typename Mask<N>::Native{} + x) {}  // NOLINT(google-explicit-constructor): broadcast
    ACCRETE_INLINE friend Int operator+(Int a, Int b) { return a.v + b.v; }
    ACCRETE_INLINE friend Int operator-(Int a, Int b) { return a.v - b.v; }
    ACCRETE_INLINE friend Int operator&(Int a, Int b) { return a.v & b.v; }
    ACCRETE_INLINE friend Int operator>>(Int a, int n) { return a.v >> n; }
    ACCRETE_INLINE friend Int operator<<(Int a, int n) { return a.v << n; }
  };
  static ACCRETE_INLINE Int bits(Pack<N> x) { return typename Mask<N>::Native(x.v); }
  static ACCRETE_INLINE Pack<N> from_bits(Int i) { return typename Pack<N>::Native(i.v); }
  static ACCRETE_INLINE Mask<N> is_set(Int i) { return {i.v != 0}; }
  static ACCRETE_INLINE Pack<N> choose(Mask<N> m, Pack<N> a, Pack<N> b) { return select(m, a, b); }
  static ACCRETE_INLINE Pack<N> root(Pack<N> x) { return sqrt_of(x); }
};
