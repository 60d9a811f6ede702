#include "predict/predict.h"

#include <cstddef>

#include "accrete/contract.h"
#include "math/cholesky.h"
#include "math/lane_records.h"
#include "predict/residual_kernel.h"
#include "predict/rigid_kernel.h"

namespace accrete::inline ACCRETE_ISA {
namespace {

using Slots = LaneSlots<kLaneWidth>;

// The floats of a PredictedObservation in their order, zeros where it is not valid. Four at a time through registers;
// the last four floats end where the last member of the covariance does.
void store(const Slots& batch, const Lanes* row, Flags valid, PredictedObservation* out) {
  constexpr int kFloats = 19;
  static_assert(offsetof(PredictedObservation, valid) == kFloats * sizeof(float));
  Lanes value[kFloats];
  for (int k = 0; k < kFloats; ++k) value[k] = select(valid, row[k], Lanes(0));
  float* record[kLaneWidth];  // lanes that are not used repeat the last one
  for (int l = 0; l < kLaneWidth; ++l) {
    PredictedObservation& o = out[batch.element(l)];
    record[l] = reinterpret_cast<float*>(&o);
    o.valid = lane(valid, l);
  }
  for (const int first : {0, 4, 8, 12, kFloats - 4}) {
    float* to[kLaneWidth];
    for (int l = 0; l < kLaneWidth; ++l) to[l] = record[l] + first;
    store_quads(value + first, to);
  }
}

}  // namespace

void predict_observations(std::span<const GeometryBlock> blocks, std::span<const std::uint32_t> slots,
                          const AlignedPose& pose, const AlignedOptics& optics, std::span<PredictedObservation> out) {
  ACCRETE_EXPECTS(out.size() == slots.size());
  const Lanes focal = optics.focal_px;
  RowBuffer<GeometryBlock::kRows, kLaneWidth> states;
  for (std::size_t i = 0; i < slots.size(); i += kLaneWidth) {
    const Slots batch(&slots[i], slots.size() - i);
    LaneState<Lanes> x;
    load_state(states.rows(batch, blocks.data()), x);
    const Sight<Lanes> sight = look_at(x.p, x.q, pose);
    View<Lanes> views[2];
    const Flags in_front = expected_views(sight, focal, Lanes(optics.baseline_m), views);

    const Root<Lanes> root = root_of(x.P);
    const Flags good = root.good & in_front;
    Symmetric<Lanes, 4> c = state_covariance(residual_moments<2>(sight, root, views, focal));
    Lanes sum = views[0].x + views[1].x + views[0].y;
    for (int k = 0; k < 4; ++k) c(k, k) = c(k, k) * Lanes(1 + 4 * kDefiniteMargin) + Lanes(kResidualFloor);
    for (int k = 0; k < 10; ++k) sum += c.v[k];
    // Unit directions: the square of a line's moment overflows farther away than 1e19 m, and vanishes in the camera.
    Flags directed = in_front;
    for (const View<Lanes>& v : views) directed = directed & (v.c * v.c + v.s * v.s > Lanes(0.5F));
    const Flags valid = good & directed & is_finite(sum);

    const Lanes row[19] = {views[0].x, views[0].y, views[0].c, views[0].s, views[1].x, views[1].y, views[1].c,
                           views[1].s, sight.q[2], c.v[0],     c.v[1],     c.v[2],     c.v[3],     c.v[4],
                           c.v[5],     c.v[6],     c.v[7],     c.v[8],     c.v[9]};
    store(batch, row, valid, &out[i]);
  }
}

void predict_states(std::span<GeometryBlock> blocks, const Transform<Map, Map>& T_new_old) {
  const Mat3 rotation = to_matrix(T_new_old.rotation);
  float R[9], t[3];
  for (std::size_t i = 0; i < 9; ++i) R[i] = static_cast<float>(rotation[i]);
  for (std::size_t i = 0; i < 3; ++i) t[i] = static_cast<float>(T_new_old.translation[i]);
  const Quaternion& r = T_new_old.rotation;
  const Quat<Lanes> q = {Lanes(static_cast<float>(r.x)), Lanes(static_cast<float>(r.y)), Lanes(static_cast<float>(r.z)),
                         Lanes(static_cast<float>(r.w))};
  for (GeometryBlock& block : blocks) {
    for (std::size_t first = 0; first < kBlockLanes; first += kLaneWidth) {
      LaneState<Lanes> x;
      load_state(rows_of(block, first), x);
      predict_rigid(x, R, q, t);
      store_state(Lanes(0) == Lanes(0), x, rows_of(block, first));
    }
  }
}

void add_incremental_motion_noise(std::span<GeometryBlock> blocks, const Transform<Map, Left>& T_m_l,
                                  const PoseCovariance& increment) {
  const MotionNoise noise = motion_noise_in_map(T_m_l, increment);
  for (GeometryBlock& block : blocks) {
    for (std::size_t first = 0; first < kBlockLanes; first += kLaneWidth) {
      LaneState<Lanes> x;
      load_state(rows_of(block, first), x);
      add_motion_noise(x, noise);
      Lanes sum = x.P.v[0];
      for (int k = 1; k < 21; ++k) sum += x.P.v[k];
      store_state(is_finite(sum), x, rows_of(block, first));
    }
  }
}

}  // namespace accrete::inline ACCRETE_ISA
