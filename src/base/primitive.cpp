#include "accrete/primitive.h"

namespace accrete {
namespace {

// Turns the sign of every element (i, j) whose indices differ in sign[].
template <std::size_t N, std::size_t Size>
void flip(std::array<float, Size>& packed, const std::array<float, N>& sign) {
  static_assert(Size == N * (N + 1) / 2);
  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t j = i; j < N; ++j) packed[packed_index(N, i, j)] *= sign[i] * sign[j];
}

}  // namespace

Geometry reversed(const Geometry& g) {
  Geometry r = g;
  // q * (0, 0, 1, 0): half a turn about local z. What is along or about x and y changes sign.
  r.quaternion = {g.quaternion[1], -g.quaternion[0], g.quaternion[3], -g.quaternion[2]};
  flip<6>(r.covariance, {-1, -1, 1, -1, -1, 1});
  return r;
}

AppearanceState reversed(const AppearanceState& a) {
  constexpr std::array<std::size_t, 7> kFrom = {0, 4, 5, 6, 1, 2, 3};  // left and right change places
  AppearanceState r;
  r.mean = reversed(a.mean);
  for (std::size_t i = 0; i < 7; ++i)
    for (std::size_t j = i; j < 7; ++j) {
      const std::size_t m = kFrom[i], n = kFrom[j];
      r.covariance[packed_index(7, i, j)] = a.covariance[m <= n ? packed_index(7, m, n) : packed_index(7, n, m)];
    }
  flip<7>(r.covariance, {-1, 1, 1, 1, 1, 1, 1});
  return r;
}

Geometry load(const GeometryBlock& block, std::size_t lane) {
  Geometry g;
  for (std::size_t i = 0; i < 3; ++i) g.position[i] = block.row[GeometryBlock::kPosition + i][lane];
  for (std::size_t i = 0; i < 4; ++i) g.quaternion[i] = block.row[GeometryBlock::kQuaternion + i][lane];
  for (std::size_t i = 0; i < 21; ++i) g.covariance[i] = block.row[GeometryBlock::kCovariance + i][lane];
  return g;
}

void store(const Geometry& g, GeometryBlock& block, std::size_t lane) {
  for (std::size_t i = 0; i < 3; ++i) block.row[GeometryBlock::kPosition + i][lane] = g.position[i];
  for (std::size_t i = 0; i < 4; ++i) block.row[GeometryBlock::kQuaternion + i][lane] = g.quaternion[i];
  for (std::size_t i = 0; i < 21; ++i) block.row[GeometryBlock::kCovariance + i][lane] = g.covariance[i];
}

AppearanceState load(const AppearanceBlock& block, std::size_t lane) {
  AppearanceState a;
  a.mean.phase = block.row[AppearanceBlock::kMean][lane];
  for (std::size_t i = 0; i < 3; ++i) {
    a.mean.left[i] = block.row[AppearanceBlock::kMean + 1 + i][lane];
    a.mean.right[i] = block.row[AppearanceBlock::kMean + 4 + i][lane];
  }
  for (std::size_t i = 0; i < 28; ++i) a.covariance[i] = block.row[AppearanceBlock::kCovariance + i][lane];
  return a;
}

void store(const AppearanceState& a, AppearanceBlock& block, std::size_t lane) {
  block.row[AppearanceBlock::kMean][lane] = a.mean.phase;
  for (std::size_t i = 0; i < 3; ++i) {
    block.row[AppearanceBlock::kMean + 1 + i][lane] = a.mean.left[i];
    block.row[AppearanceBlock::kMean + 4 + i][lane] = a.mean.right[i];
  }
  for (std::size_t i = 0; i < 28; ++i) block.row[AppearanceBlock::kCovariance + i][lane] = a.covariance[i];
}

}  // namespace accrete
