#include "filter/update.h"

#include <limits>

#include "accrete/contract.h"
#include "filter/roll_kernel.h"
#include "filter/update_kernel.h"

namespace accrete::inline ACCRETE_ISA {
namespace {

using Slots = LaneSlots<kLaneWidth>;
using Buffer = LaneBuffer<kLaneWidth>;
using StateBuffer = RowBuffer<GeometryBlock::kRows, kLaneWidth>;

constexpr float kNoCap = std::numeric_limits<float>::infinity();

// What the update needs of line elements.
struct ElementBuffer {
  Buffer x, y, c, s, sigma_n, sigma_theta;

  ACCRETE_INLINE void fill(const LineElement* e, const Slots& slots) {
    x.fill(slots, [&](int i) { return e[i].x_px; });
    y.fill(slots, [&](int i) { return e[i].y_px; });
    c.fill(slots, [&](int i) { return e[i].c; });
    s.fill(slots, [&](int i) { return e[i].s; });
    sigma_n.fill(slots, [&](int i) { return e[i].sigma_n_px; });
    sigma_theta.fill(slots, [&](int i) { return e[i].sigma_theta; });
  }
  ACCRETE_INLINE void load(View<Lanes>& view, Lanes* variance) const {
    view.x = x.load<Lanes>();
    view.y = y.load<Lanes>();
    view.c = c.load<Lanes>();
    view.s = s.load<Lanes>();
    const Lanes n = sigma_n.load<Lanes>(), theta = sigma_theta.load<Lanes>();
    variance[0] = n * n;
    variance[1] = theta * theta;
  }
};

void fill_cap(std::span<const float> cap, std::size_t first, const Slots& slots, Buffer& out) {
  out.fill(slots, [&](int i) { return cap.empty() ? kNoCap : cap[first + static_cast<std::size_t>(i)]; });
}

void report(const Slots& slots, Flags in_front, Flags good, UpdateOutcome* out) {
  for (int l = 0; l < slots.count; ++l)
    out[l] = !lane(in_front, l) ? UpdateOutcome::kBehind
             : lane(good, l)    ? UpdateOutcome::kUpdated
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
  ElementBuffer elements[2];
  Buffer cap;
  for (std::size_t i = 0; i < slots.size(); i += kLaneWidth) {
    const Slots batch(&slots[i], slots.size() - i);
    elements[0].fill(&left[i], batch);
    elements[1].fill(&right[i], batch);
    fill_cap(slide_variance_cap, i, batch, cap);
    states.fill(batch, blocks.data());

    View<Lanes> views[2];
    Lanes variance[4];
    LaneState<Lanes> x;
    elements[0].load(views[0], variance);
    elements[1].load(views[1], variance + 2);
    views[0].offset = 0.0F;
    views[1].offset = optics.baseline_m;
    load_state(states, x);
    const auto done = update_geometry<2>(x, views, variance, pose, optics, cap.load<Lanes>());
    store_state(x, states);
    states.scatter(done.in_front & done.good, batch, blocks.data());
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
  ElementBuffer elements;
  Buffer cap, offset;
  for (std::size_t i = 0; i < slots.size(); i += kLaneWidth) {
    const Slots batch(&slots[i], slots.size() - i);
    const Eye* eye = &eyes[i];
    elements.fill(&observed[i], batch);
    offset.fill(batch, [&](int k) { return eye[k] == Eye::kRight ? optics.baseline_m : 0.0F; });
    fill_cap(slide_variance_cap, i, batch, cap);
    states.fill(batch, blocks.data());

    View<Lanes> view;
    Lanes variance[2];
    LaneState<Lanes> x;
    elements.load(view, variance);
    view.offset = offset.load<Lanes>();
    load_state(states, x);
    const auto done = update_geometry<1>(x, &view, variance, pose, optics, cap.load<Lanes>());
    store_state(x, states);
    states.scatter(done.in_front & done.good, batch, blocks.data());
    report(batch, done.in_front, done.good, &outcomes[i]);
  }
}

void update_roll(std::span<GeometryBlock> blocks, std::span<const std::uint32_t> slots, const AlignedPose& pose,
                 const AlignedOptics& optics, float sigma_roll, std::span<UpdateOutcome> outcomes) {
  ACCRETE_EXPECTS(outcomes.size() == slots.size());
  StateBuffer states;
  for (std::size_t i = 0; i < slots.size(); i += kLaneWidth) {
    const Slots batch(&slots[i], slots.size() - i);
    states.fill(batch, blocks.data());
    LaneState<Lanes> x;
    load_state(states, x);
    Flags in_front;
    const Flags good = update_roll(x, pose, optics, Lanes(sigma_roll * sigma_roll), in_front);
    store_state(x, states);
    states.scatter(in_front & good, batch, blocks.data());
    report(batch, in_front, good, &outcomes[i]);
  }
}

}  // namespace accrete::inline ACCRETE_ISA
