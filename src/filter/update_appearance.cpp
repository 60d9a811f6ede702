#include "accrete/contract.h"
#include "filter/appearance_kernel.h"
#include "filter/update.h"
#include "math/lane_state.h"

namespace accrete::inline ACCRETE_ISA {
namespace {

using Slots = LaneSlots<kLaneWidth>;
using Buffer = LaneBuffer<kLaneWidth>;

}  // namespace

void update_appearance(std::span<AppearanceBlock> blocks, std::span<const std::uint32_t> slots,
                       std::span<const Appearance> observed, std::span<const float> sigma_phase,
                       std::span<const float> sigma_left, std::span<const float> sigma_right,
                       std::span<const float> q_phase, std::span<const float> q_colour,
                       std::span<UpdateOutcome> outcomes) {
  ACCRETE_EXPECTS(observed.size() == slots.size() && sigma_phase.size() == slots.size() &&
                  sigma_left.size() == slots.size() && sigma_right.size() == slots.size() &&
                  q_phase.size() == slots.size() && q_colour.size() == slots.size() && outcomes.size() == slots.size());
  RowBuffer<AppearanceBlock::kRows, kLaneWidth> states;
  Buffer value[7], sigma[3], drift[2];
  for (std::size_t i = 0; i < slots.size(); i += kLaneWidth) {
    const Slots batch(&slots[i], slots.size() - i);
    const Appearance* o = &observed[i];
    value[0].fill(batch, [&](int l) { return o[l].phase; });
    for (std::size_t k = 0; k < 3; ++k) {
      value[1 + k].fill(batch, [&](int l) { return o[l].left[k]; });
      value[4 + k].fill(batch, [&](int l) { return o[l].right[k]; });
    }
    sigma[0].fill(batch, [&](int l) { return sigma_phase[i + static_cast<std::size_t>(l)]; });
    sigma[1].fill(batch, [&](int l) { return sigma_left[i + static_cast<std::size_t>(l)]; });
    sigma[2].fill(batch, [&](int l) { return sigma_right[i + static_cast<std::size_t>(l)]; });
    drift[0].fill(batch, [&](int l) { return q_phase[i + static_cast<std::size_t>(l)]; });
    drift[1].fill(batch, [&](int l) { return q_colour[i + static_cast<std::size_t>(l)]; });
    states.fill(batch, blocks.data());

    LaneAppearance<Lanes> x;
    Lanes z[7], noise[7], process[7];
    for (int k = 0; k < 7; ++k) {
      const Lanes s = sigma[k == 0 ? 0 : (k < 4 ? 1 : 2)].load<Lanes>();
      z[k] = value[k].load<Lanes>();
      noise[k] = s * s;
      process[k] = drift[k > 0].load<Lanes>();
      x.mean[k] = load_lanes<Lanes>(states.x[k]);
    }
    for (int k = 0; k < 28; ++k) x.P.v[k] = load_lanes<Lanes>(states.x[7 + k]);

    const Flags good = update_appearance(x, z, noise, process);
    for (int k = 0; k < 7; ++k) store_lanes(x.mean[k], states.x[k]);
    for (int k = 0; k < 28; ++k) store_lanes(x.P.v[k], states.x[7 + k]);
    states.scatter(good, batch, blocks.data());
    for (int l = 0; l < batch.count; ++l)
      outcomes[i + static_cast<std::size_t>(l)] =
          lane(good, l) ? UpdateOutcome::kUpdated : UpdateOutcome::kNotPositiveDefinite;
  }
}

}  // namespace accrete::inline ACCRETE_ISA
