#include "accrete/contract.h"
#include "filter/appearance_kernel.h"
#include "filter/update.h"
#include "math/lane_records.h"

namespace accrete::inline ACCRETE_ISA {
namespace {

using Slots = LaneSlots<kLaneWidth>;

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
  for (std::size_t i = 0; i < slots.size(); i += kLaneWidth) {
    const Slots batch(&slots[i], slots.size() - i);
    const auto rows = states.rows(batch, blocks.data());

    LaneAppearance<Lanes> x;
    Lanes z[7], noise[7], process[7];
    load_records(batch, &observed[i], z);
    const Lanes phase = load_values(batch, &sigma_phase[i]), left = load_values(batch, &sigma_left[i]),
                right = load_values(batch, &sigma_right[i]);
    noise[0] = phase * phase;
    process[0] = load_values(batch, &q_phase[i]);
    for (int k = 1; k < 7; ++k) {
      noise[k] = k < 4 ? left * left : right * right;
      process[k] = k < 2 ? load_values(batch, &q_colour[i]) : process[1];
    }
    for (int k = 0; k < 7; ++k) x.mean[k] = load_lanes<Lanes>(rows[k]);
    ACCRETE_UNROLL
    for (int k = 0; k < 28; ++k) x.P.v[k] = load_lanes<Lanes>(rows[7 + k]);

    const Flags good = update_appearance(x, z, noise, process);
    for (int k = 0; k < 7; ++k) store_lanes_if(good, x.mean[k], rows[k]);
    ACCRETE_UNROLL
    for (int k = 0; k < 28; ++k) store_lanes_if(good, x.P.v[k], rows[7 + k]);
    states.scatter(batch, blocks.data());
    std::int32_t fine[kLaneWidth];
    store_mask(good, fine);
    for (int l = 0; l < batch.count; ++l)
      outcomes[i + static_cast<std::size_t>(l)] =
          fine[l] != 0 ? UpdateOutcome::kUpdated : UpdateOutcome::kNotPositiveDefinite;
  }
}

}  // namespace accrete::inline ACCRETE_ISA
