#include "filter/update.h"

#include <limits>

#include "accrete/contract.h"
#include "filter/roll_kernel.h"
#include "filter/update_kernel.h"

namespace accrete {
namespace {

using Lanes = Pack<kLaneWidth>;
using Slots = LaneSlots<kLaneWidth>;

constexpr float kNoCap = std::numeric_limits<float>::infinity();

View<Lanes> gather_view(const LineElement* e, const Slots& slots, Lanes offset) {
  return {gather<Lanes>(slots, [&](int i) { return e[i].x_px; }),
          gather<Lanes>(slots, [&](int i) { return e[i].y_px; }), gather<Lanes>(slots, [&](int i) { return e[i].c; }),
          gather<Lanes>(slots, [&](int i) { return e[i].s; }), offset};
}

void gather_variance(const LineElement* e, const Slots& slots, Lanes* variance) {
  const Lanes n = gather<Lanes>(slots, [&](int i) { return e[i].sigma_n_px; });
  const Lanes theta = gather<Lanes>(slots, [&](int i) { return e[i].sigma_theta; });
  variance[0] = n * n;
  variance[1] = theta * theta;
}

Lanes gather_cap(std::span<const float> cap, std::size_t first, const Slots& slots) {
  if (cap.empty()) return kNoCap;
  return gather<Lanes>(slots, [&](int i) { return cap[first + static_cast<std::size_t>(i)]; });
}

void report(const Slots& slots, Mask<kLaneWidth> in_front, Mask<kLaneWidth> good, UpdateOutcome* out) {
  for (int l = 0; l < slots.count; ++l)
    out[l] = !in_front[l] ? UpdateOutcome::kBehind
             : good[l]    ? UpdateOutcome::kUpdated
                          : UpdateOutcome::kNotPositiveDefinite;
}

}  // namespace

void update_stereo(std::span<GeometryBlock> blocks, std::span<const std::uint32_t> slots,
                   std::span<const LineElement> left, std::span<const LineElement> right, const AlignedPose& pose,
                   const AlignedOptics& optics, std::span<UpdateOutcome> outcomes,
                   std::span<const float> slide_variance_cap) {
  ACCRETE_EXPECTS(left.size() == slots.size() && right.size() == slots.size() && outcomes.size() == slots.size());
  ACCRETE_EXPECTS(slide_variance_cap.empty() || slide_variance_cap.size() == slots.size());
  for (std::size_t i = 0; i < slots.size(); i += kLaneWidth) {
    const Slots batch(&slots[i], slots.size() - i);
    LaneState<Lanes> x = gather_state<Lanes>(blocks.data(), batch);
    const View<Lanes> views[2] = {gather_view(&left[i], batch, 0.0F), gather_view(&right[i], batch, optics.baseline_m)};
    Lanes variance[4];
    gather_variance(&left[i], batch, variance);
    gather_variance(&right[i], batch, variance + 2);
    const auto done = update_geometry<2>(x, views, variance, pose, optics, gather_cap(slide_variance_cap, i, batch));
    scatter_state(x, done.in_front & done.good, batch, blocks.data());
    report(batch, done.in_front, done.good, &outcomes[i]);
  }
}

void update_mono(std::span<GeometryBlock> blocks, std::span<const std::uint32_t> slots,
                 std::span<const LineElement> observed, std::span<const Eye> eyes, const AlignedPose& pose,
                 const AlignedOptics& optics, std::span<UpdateOutcome> outcomes,
                 std::span<const float> slide_variance_cap) {
  ACCRETE_EXPECTS(observed.size() == slots.size() && eyes.size() == slots.size() && outcomes.size() == slots.size());
  ACCRETE_EXPECTS(slide_variance_cap.empty() || slide_variance_cap.size() == slots.size());
  for (std::size_t i = 0; i < slots.size(); i += kLaneWidth) {
    const Slots batch(&slots[i], slots.size() - i);
    LaneState<Lanes> x = gather_state<Lanes>(blocks.data(), batch);
    const Eye* eye = &eyes[i];
    const Lanes offset = gather<Lanes>(batch, [&](int k) { return eye[k] == Eye::kRight ? optics.baseline_m : 0.0F; });
    const View<Lanes> view = gather_view(&observed[i], batch, offset);
    Lanes variance[2];
    gather_variance(&observed[i], batch, variance);
    const auto done = update_geometry<1>(x, &view, variance, pose, optics, gather_cap(slide_variance_cap, i, batch));
    scatter_state(x, done.in_front & done.good, batch, blocks.data());
    report(batch, done.in_front, done.good, &outcomes[i]);
  }
}

void update_roll(std::span<GeometryBlock> blocks, std::span<const std::uint32_t> slots, const AlignedPose& pose,
                 const AlignedOptics& optics, float sigma_roll, std::span<UpdateOutcome> outcomes) {
  ACCRETE_EXPECTS(outcomes.size() == slots.size());
  for (std::size_t i = 0; i < slots.size(); i += kLaneWidth) {
    const Slots batch(&slots[i], slots.size() - i);
    LaneState<Lanes> x = gather_state<Lanes>(blocks.data(), batch);
    Mask<kLaneWidth> in_front;
    const Mask<kLaneWidth> good = update_roll(x, pose, optics, Lanes(sigma_roll * sigma_roll), in_front);
    scatter_state(x, in_front & good, batch, blocks.data());
    report(batch, in_front, good, &outcomes[i]);
  }
}

}  // namespace accrete
