// For programs that use Eigen: their types on ours. Views share memory and are valid as long as what they were made of;
// the rest are copies. Nothing of the library includes this file, and no type of Eigen crosses the border to it: a
// program may be compiled for other instruction sets, or with another Eigen, than the library.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>

#include "accrete/geometry.h"
#include "accrete/motion.h"
#include "accrete/primitive.h"
#include "accrete/status.h"

namespace accrete::interop {

// A view of a vector: Vec3, or the position or tangent of a primitive. Of N numbers that lie one after the other.
template <class Scalar, std::size_t N>
[[nodiscard]] Eigen::Map<const Eigen::Matrix<Scalar, static_cast<int>(N), 1>> view(const std::array<Scalar, N>& v) {
  return Eigen::Map<const Eigen::Matrix<Scalar, static_cast<int>(N), 1>>(v.data());
}
template <class Scalar, std::size_t N>
[[nodiscard]] Eigen::Map<Eigen::Matrix<Scalar, static_cast<int>(N), 1>> view(std::array<Scalar, N>& v) {
  return Eigen::Map<Eigen::Matrix<Scalar, static_cast<int>(N), 1>>(v.data());
}
template <class Scalar, std::size_t N>
void view(const std::array<Scalar, N>&& v) = delete;  // it would outlive what it shows

// A view of N x N numbers, row after row: a Mat3 (N = 3) or a PoseCovariance (N = 6).
template <int N, class Scalar>
[[nodiscard]] Eigen::Map<const Eigen::Matrix<Scalar, N, N, Eigen::RowMajor>> matrix_view(
    const std::array<Scalar, static_cast<std::size_t>(N) * N>& m) {
  return Eigen::Map<const Eigen::Matrix<Scalar, N, N, Eigen::RowMajor>>(m.data());
}
template <int N, class Scalar>
[[nodiscard]] Eigen::Map<Eigen::Matrix<Scalar, N, N, Eigen::RowMajor>> matrix_view(
    std::array<Scalar, static_cast<std::size_t>(N) * N>& m) {
  return Eigen::Map<Eigen::Matrix<Scalar, N, N, Eigen::RowMajor>>(m.data());
}
template <int N, class Scalar>
void matrix_view(const std::array<Scalar, static_cast<std::size_t>(N) * N>&& m) = delete;

// A view of the rotation of a primitive, from its own frame to the map; both keep x y z w.
[[nodiscard]] inline Eigen::Map<const Eigen::Quaternionf> rotation_view(const Geometry& geometry) {
  return Eigen::Map<const Eigen::Quaternionf>(geometry.quaternion.data());
}
void rotation_view(const Geometry&& geometry) = delete;

// A view of 16 primitives, a column each: GeometryBlock::row or AppearanceBlock::row.
template <std::size_t Rows>
[[nodiscard]] Eigen::Map<const Eigen::Array<float, static_cast<int>(Rows), kBlockLanes, Eigen::RowMajor>> block_view(
    const float (&row)[Rows][kBlockLanes]) {
  return Eigen::Map<const Eigen::Array<float, static_cast<int>(Rows), kBlockLanes, Eigen::RowMajor>>(row[0]);
}

// A copy of a packed covariance as a full matrix.
template <int N, std::size_t Packed>
[[nodiscard]] Eigen::Matrix<float, N, N> unpacked(const std::array<float, Packed>& packed) {
  static_assert(Packed == static_cast<std::size_t>(N) * (N + 1) / 2);
  Eigen::Matrix<float, N, N> m;
  for (int i = 0; i < N; ++i)
    for (int j = i; j < N; ++j)
      m(i, j) = m(j, i) = packed[packed_index(N, static_cast<std::size_t>(i), static_cast<std::size_t>(j))];
  return m;
}
// Position before rotation; of a Primitive3d in the map frame and in its own one, respectively.
[[nodiscard]] inline Eigen::Matrix<float, 6, 6> covariance(const Geometry& geometry) {
  return unpacked<6>(geometry.covariance);
}
// Phase, left RGB, right RGB.
[[nodiscard]] inline Eigen::Matrix<float, 7, 7> covariance(const AppearanceState& appearance) {
  return unpacked<7>(appearance.covariance);
}

// Copies of a rotation.
[[nodiscard]] inline Eigen::Quaterniond to_eigen(const Quaternion& q) { return {q.w, q.x, q.y, q.z}; }
[[nodiscard]] inline Quaternion from_eigen(const Eigen::Quaterniond& q) { return {q.x(), q.y(), q.z(), q.w()}; }

// A copy of a transform; the frames are in the type of ours only.
template <class To, class From>
[[nodiscard]] Eigen::Isometry3d to_eigen(const Transform<To, From>& T) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() = to_eigen(T.rotation).toRotationMatrix();
  out.translation() = view(T.translation);
  return out;
}
// from_eigen<Left, Object>(T_l_o). kInvalidArgument: not finite, or its linear part differs from a rotation by more
// than 1e-3.
template <class To, class From>
[[nodiscard]] Result<Transform<To, From>> from_eigen(const Eigen::Isometry3d& T) {
  Transform<To, From> out;
  Mat3 m;
  matrix_view<3>(m) = T.linear();
  view(out.translation) = T.translation();
  const Result<Quaternion> rotation = to_quaternion(m);
  if (!rotation.ok()) return rotation.status();
  if (!view(out.translation).allFinite()) return Status::kInvalidArgument;
  out.rotation = rotation.value();
  return out;
}

}  // namespace accrete::interop
