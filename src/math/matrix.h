// The one place that includes Eigen: small fixed matrices over any scalar of the kernels. Eigen's own vectorisation is
// off (CMake): lanes already fill the registers, and its fused multiply-adds would change results between machines.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "math/lanes.h"

template <int N>
struct Eigen::NumTraits<accrete::Pack<N>> : Eigen::GenericNumTraits<float> {
  using Real = accrete::Pack<N>;
  using NonInteger = accrete::Pack<N>;
  using Nested = accrete::Pack<N>;
  using Literal = float;
  enum {  // NOLINTBEGIN(readability-identifier-naming): the names are Eigen's
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 0,
    ReadCost = 1,
    AddCost = 1,
    MulCost = 1
  };  // NOLINTEND(readability-identifier-naming)
};

namespace accrete::inline ACCRETE_ISA {

template <class S>
using Vector3 = Eigen::Matrix<S, 3, 1>;
template <class S>
using Matrix3 = Eigen::Matrix<S, 3, 3>;

// Eigen's cross and dot go through conjugation, which packs do not have.
template <class S>
ACCRETE_INLINE Vector3<S> cross(const Vector3<S>& a, const Vector3<S>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <class S>
ACCRETE_INLINE S dot(const Vector3<S>& a, const Vector3<S>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// m v, without Eigen's product machinery: three rows, unrolled.
template <class S>
ACCRETE_INLINE Vector3<S> rotate(const Matrix3<S>& m, const Vector3<S>& v) {
  return {m(0, 0) * v[0] + m(0, 1) * v[1] + m(0, 2) * v[2], m(1, 0) * v[0] + m(1, 1) * v[1] + m(1, 2) * v[2],
          m(2, 0) * v[0] + m(2, 1) * v[1] + m(2, 2) * v[2]};
}
// transpose(m) v.
template <class S>
ACCRETE_INLINE Vector3<S> rotate_back(const Matrix3<S>& m, const Vector3<S>& v) {
  return {m(0, 0) * v[0] + m(1, 0) * v[1] + m(2, 0) * v[2], m(0, 1) * v[0] + m(1, 1) * v[1] + m(2, 1) * v[2],
          m(0, 2) * v[0] + m(1, 2) * v[1] + m(2, 2) * v[2]};
}
// Broadcasts a row-major rotation.
template <class S, class T>
ACCRETE_INLINE Matrix3<S> matrix_from(const T* row_major) {
  Matrix3<S> m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m(i, j) = S(row_major[3 * i + j]);
  return m;
}

// A symmetric N x N matrix as its packed upper triangle, row after row: the order of the store (packed_index).
template <class S, int N>
struct Symmetric {  // NOLINT(readability-identifier-naming): the index of its implicit copy
  static constexpr int kSize = N * (N + 1) / 2;
  S v[kSize];

  [[nodiscard]] static constexpr int index(int i, int j) {
    return i <= j ? i * N - i * (i + 1) / 2 + j : j * N - j * (j + 1) / 2 + i;
  }
  ACCRETE_INLINE S& operator()(int i, int j) { return v[index(i, j)]; }
  ACCRETE_INLINE const S& operator()(int i, int j) const { return v[index(i, j)]; }
};

}  // namespace accrete::inline ACCRETE_ISA
