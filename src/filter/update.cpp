#include "filter/update.h"

#include <limits>

#include "accrete/contract.h"
#include "filter/roll_kernel.h"
#include "filter/update_kernel.h"
#include "math/lane_records.h"

namespace accrete::inline ACCRETE_ISA {
namespace {

using Slots = LaneSlots<kLaneWidth>;
using StateBuffer = RowBuffer<GeometryBlock::kRows, kLaneWidth>;

constexpr float kNoCap = std::numeric_limits<float>::infinity();

// What the update needs of line elements.
void load_elements(const Slots& slots, const LineElement* elements, View<Lanes>& view, Lanes* variance) {
  Lanes e[6];  // in the order of LineElement
  load_records(slots, elements, e);
  view.x = e[0];
  view.y = e[1];
  view.c = e[2];
  view.s = e[3];
  variance[0] = e[4] * e[4];
  variance[1] = e[5] * e[5];
}

Lanes load_cap(std::span<const float> cap, std::size_t first, const Slots& slots) {
  return cap.empty() ? Lanes(kNoCap) : load_values(slots, &cap[first]);
}

void report(const Slots& slots, Flags in_front, Flags good, UpdateOutcome* out) {
  std::int32_t front[kLaneWidth], fine[kLaneWidth];
  store_mask(in_front, front);
  store_mask(good, fine);
  for (int l = 0; l < slots.count; ++l)
    out[l] = front[l] == 0  ? UpdateOutcome::kBehind
             : fine[l] != 0 ? UpdateOutcome::kUpdated
                            : UpdateOutcome::kNotPositiveDefinite;
}

}  // namespace

void update_stereo(std::span<GeometryBlock> blocks, std::span<const std::uint32_t> slots,
                   std::span<const LineElement> left, std::span<const LineElement> right, const AlignedPose& pose,
                   const AlignedOptics& optics, std::span<UpdateOutcome> outcomes,
                   std::span<const float> slide_variance_cap) {
  ACCRETE_EXPECTS(left.size() == slots.size() && right.size() == slots.size() && outcomes.size() == slots.size());
  ACCRETE_EXPECTS(slide_variance_cap.empty() || slide_variance_cap.size() == slots.size());
  StateBuffer states;
  for (std::size_t i = 0; i < slots.size(); i += kLaneWidth) {
    const Slots batch(&slots[i], slots.size() - i);
    const auto rows = states.rows(batch, blocks.data());

    View<Lanes> views[2];
    Lanes variance[4];
    LaneState<Lanes> x;
    load_elements(batch, &left[i], views[0], variance);
    load_elements(batch, &right[i], views[1], variance + 2);
    views[0].offset = 0.0F;
    views[1].offset = optics.baseline_m;
    load_state(rows, x);
    const auto done = update_geometry<2>(x, views, variance, pose, optics, load_cap(slide_variance_cap, i, batch));
    store_state(done.in_front & done.good, x, rows);
    states.scatter(batch, blocks.data());
    report(batch, done.in_front, done.good, &outcomes[i]);
  }
}

void update_mono(std::span<GeometryBlock> blocks, std::span<const std::uint32_t> slots,
                 std::span<const LineElement> observed, std::span<const Eye> eyes, const AlignedPose& pose,
                 const AlignedOptics& optics, std::span<UpdateOutcome> outcomes,
                 std::span<const float> slide_variance_cap) {
  ACCRETE_EXPECTS(observed.size() == slots.size() && eyes.size() == slots.size() && outcomes.size() == slots.size());
  ACCRETE_EXPECTS(slide_variance_cap.empty() || slide_variance_cap.size() == slots.size());
  StateBuffer states;
  LaneBuffer<kLaneWidth> offset;
  for (std::size_t i = 0; i < slots.size(); i += kLaneWidth) {
    const Slots batch(&slots[i], slots.size() - i);
    const Eye* eye = &eyes[i];
    offset.fill(batch, [&](int k) { return eye[k] == Eye::kRight ? optics.baseline_m : 0.0F; });
    const auto rows = states.rows(batch, blocks.data());

    View<Lanes> view;
    Lanes variance[2];
    LaneState<Lanes> x;
    load_elements(batch, &observed[i], view, variance);
    view.offset = offset.load<Lanes>();
    load_state(rows, x);
    const auto done = update_geometry<1>(x, &view, variance, pose, optics, load_cap(slide_variance_cap, i, batch));
    store_state(done.in_front & done.good, x, rows);
    states.scatter(batch, blocks.data());
    report(batch, done.in_front, done.good, &outcomes[i]);
  }
}

void update_roll(std::span<GeometryBlock> blocks, std::span<const std::uint32_t> slots, const AlignedPose& pose,
                 const AlignedOptics& optics, float sigma_roll, std::span<UpdateOutcome> outcomes) {
  ACCRETE_EXPECTS(outcomes.size() == slots.size());
  StateBuffer states;
  for (std::size_t i = 0; i < slots.size(); i += kLaneWidth) {
    const Slots batch(&slots[i], slots.size() - i);
    const auto rows = states.rows(batch, blocks.data());
    LaneState<Lanes> x;
    load_state(rows, x);
    Flags in_front;
    const Flags good = update_roll(x, pose, optics, Lanes(sigma_roll * sigma_roll), in_front);
    store_state(in_front & good, x, rows);
    states.scatter(batch, blocks.data());
    report(batch, in_front, good, &outcomes[i]);
  }
}

}  // namespace accrete::inline ACCRETE_ISA
