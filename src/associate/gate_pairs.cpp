#include "associate/gate_pairs.h"

#include <cstddef>

#include "associate/gate_kernel.h"
#include "math/lane_gather.h"
#include "math/lane_state.h"

namespace accrete::associate::inline ACCRETE_ISA {
namespace {

// Which floats of the records are loaded, eight at a time.
constexpr std::size_t kFloat = sizeof(float);
constexpr std::size_t kViews = offsetof(Expected, predicted.x_l) / kFloat;            // left, right
constexpr std::size_t kDepth = offsetof(Expected, predicted.depth_m) / kFloat;        // covariance 0 .. 6 behind it
constexpr std::size_t kRest = offsetof(Expected, predicted.covariance) / kFloat + 7;  // 7 .. 9, valid, mean 0 .. 3
constexpr std::size_t kMean = offsetof(Expected, mean) / kFloat;
constexpr std::size_t kVisible = offsetof(Expected, visible) / kFloat;
static_assert(offsetof(Expected, predicted.x_r) == (kViews + 4) * kFloat && kRest == kDepth + 8 && kMean == kRest + 4 &&
              offsetof(Expected, variance) == (kMean + 7) * kFloat && kVisible == kMean + 14 &&
              sizeof(Expected) == (kVisible + 4) * kFloat);
constexpr std::size_t kLook = offsetof(Primitive2d, appearance) / kFloat;
constexpr std::size_t kDeviations = offsetof(Primitive2d, sigma_phase) / kFloat;
static_assert(offsetof(Primitive2d, sigma_n_px) == (kLook + 7) * kFloat &&
              offsetof(Primitive2d, aligned) == (kDeviations + 2) * kFloat &&
              sizeof(Primitive2d) == (kDeviations + 8) * kFloat);

constexpr std::size_t kExpectedOcts[] = {kViews, kDepth, kRest, kMean + 4, kVisible - 4};
constexpr std::size_t kSeenOcts[] = {kLook, kDeviations};

// out[k][m], lane l: float offsets[k] + m of record index[l]. Rolled: otherwise all addresses of all lanes are formed
// in registers before the first is used, and there are not that many.
template <std::size_t Octs, class Record, class Index>
ACCRETE_INLINE void load_record_octs(const Record* records, const Index* index, const std::size_t (&offsets)[Octs],
                                     Lanes (&out)[Octs][8]) {
  const float* at[kLaneWidth];
  ACCRETE_ROLLED
  for (int l = 0; l < kLaneWidth; ++l) at[l] = reinterpret_cast<const float*>(records + index[l]);
  ACCRETE_ROLLED
  for (std::size_t k = 0; k < Octs; ++k) {
    const float* from[kLaneWidth];
    for (int l = 0; l < kLaneWidth; ++l) from[l] = at[l] + offsets[k];
    load_octs<Lanes>(from, out[k]);
  }
}

// Where the pairs' expected elements are, how sure that is, and how they look. `eye`: 0 or 1 if Eyes is 1.
template <int Eyes>
ACCRETE_INLINE void load_expected(const Expected* expected, const std::uint32_t* index, int eye,
                                  LanePair<Eyes, Lanes>& p) {
  Lanes o[5][8];
  load_record_octs(expected, index, kExpectedOcts, o);
  const Lanes* view = o[0];
  const Lanes *P = &o[1][1], *rest = o[2];  // covariance 0 .. 6 and 7 .. 9
  if constexpr (Eyes == 2) {
    p.expected[0] = {view[0], view[1], view[2], view[3]};
    p.expected[1] = {view[4], view[5], view[6], view[7]};
    ACCRETE_UNROLL
    for (int k = 0; k < 10; ++k) p.P.v[k] = k < 7 ? P[k] : rest[k - 7];
  } else if (eye == 0) {
    p.expected[0] = {view[0], view[1], view[2], view[3]};
    p.P.v[0] = P[0], p.P.v[1] = P[1], p.P.v[2] = P[4];
  } else {
    p.expected[0] = {view[4], view[5], view[6], view[7]};
    p.P.v[0] = rest[0], p.P.v[1] = rest[1], p.P.v[2] = rest[2];
  }
  ACCRETE_UNROLL
  for (int k = 0; k < 7; ++k) {
    p.mean[k] = k < 4 ? rest[4 + k] : o[3][k - 4];
    p.variance[k] = k < 5 ? o[3][3 + k] : o[4][k - 3];
  }
  p.visible = o[4][4];
  p.detection = o[4][5];
  ACCRETE_UNROLL
  for (int e = 0; e < Eyes; ++e) {
    p.noise[2 * e] = o[4][6];
    p.noise[2 * e + 1] = o[4][7];
  }
}

// What an eye saw.
template <int Eyes>
ACCRETE_INLINE void load_seen(const EyeView& view, const std::uint16_t* index, int e, LanePair<Eyes, Lanes>& p) {
  const float* chance = view.clutter->density.data();
  LaneBuffer<kLaneWidth> density;
  ACCRETE_ROLLED
  for (int l = 0; l < kLaneWidth; ++l) density.x[l] = chance[index[l]];
  Lanes o[2][8];
  load_record_octs(view.primitives.data(), index, kSeenOcts, o);
  ACCRETE_UNROLL
  for (int k = 0; k < 7; ++k) p.look[e].a[k] = o[0][k];
  const Lanes* q = o[1];
  p.look[e].sigma_phase = q[0];
  p.look[e].sigma_colour = q[1];
  p.seen[e] = {q[2], q[3], q[4], q[5]};
  p.noise[2 * e] += q[6] * q[6];
  p.noise[2 * e + 1] += q[7] * q[7];
  p.density[e] = density.load<Lanes>();
}

// Lanes beyond the last pair repeat it.
void fill_lanes(PairBatch& pairs) {
  if (pairs.count == 0) return;
  for (std::size_t k = pairs.count; k % kLaneWidth != 0; ++k) {
    pairs.expected[k] = pairs.expected[pairs.count - 1];
    pairs.left[k] = pairs.left[pairs.count - 1];
    pairs.right[k] = pairs.right[pairs.count - 1];
  }
}

}  // namespace

void gate_both_eyes(std::span<const Expected> expected, const EyeView& left, const EyeView& right, PairBatch& pairs) {
  fill_lanes(pairs);
  for (std::size_t i = 0; i < pairs.count; i += kLaneWidth) {
    LanePair<2, Lanes> p;
    load_expected(expected.data(), &pairs.expected[i], 0, p);
    load_seen(left, &pairs.left[i], 0, p);
    load_seen(right, &pairs.right[i], 1, p);
    const LaneVerdict<2, Lanes> v = gate_pair(p, *left.clutter);
    store_lanes(v.d2, &pairs.d2[i]);
    store_lanes(v.log_likelihood, &pairs.log_likelihood[i]);
    store_mask(v.reversed[0], &pairs.left_reversed[i]);
    store_mask(v.reversed[1], &pairs.right_reversed[i]);
  }
}

void gate_one_eye(std::span<const Expected> expected, const EyeView& view, int eye, PairBatch& pairs) {
  fill_lanes(pairs);
  const auto& seen = eye == 0 ? pairs.left : pairs.right;
  auto& reversed = eye == 0 ? pairs.left_reversed : pairs.right_reversed;
  for (std::size_t i = 0; i < pairs.count; i += kLaneWidth) {
    LanePair<1, Lanes> p;
    load_expected(expected.data(), &pairs.expected[i], eye, p);
    load_seen(view, &seen[i], 0, p);
    const LaneVerdict<1, Lanes> v = gate_pair(p, *view.clutter);
    store_lanes(v.d2, &pairs.d2[i]);
    store_lanes(v.log_likelihood, &pairs.log_likelihood[i]);
    store_mask(v.reversed[0], &reversed[i]);
  }
}

}  // namespace accrete::associate::inline ACCRETE_ISA
