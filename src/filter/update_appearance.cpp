#include "accrete/contract.h"
#include "filter/appearance_kernel.h"
#include "filter/update.h"
#include "math/lane_state.h"

namespace accrete {
namespace {

using Lanes = Pack<kLaneWidth>;
using Slots = LaneSlots<kLaneWidth>;

Lanes gather_span(std::span<const float> values, std::size_t first, const Slots& slots) {
  return gather<Lanes>(slots, [&](int i) { return values[first + static_cast<std::size_t>(i)]; });
}

}  // namespace

void update_appearance(std::span<AppearanceBlock> blocks, std::span<const std::uint32_t> slots,
                       std::span<const Appearance> observed, std::span<const float> sigma_phase,
                       std::span<const float> sigma_colour, std::span<const float> q_phase,
                       std::span<const float> q_colour, std::span<UpdateOutcome> outcomes) {
  ACCRETE_EXPECTS(observed.size() == slots.size() && sigma_phase.size() == slots.size() &&
                  sigma_colour.size() == slots.size() && q_phase.size() == slots.size() &&
                  q_colour.size() == slots.size() && outcomes.size() == slots.size());
  for (std::size_t i = 0; i < slots.size(); i += kLaneWidth) {
    const Slots batch(&slots[i], slots.size() - i);
    Lanes row[AppearanceBlock::kRows];
    gather_rows<AppearanceBlock::kRows>(blocks.data(), batch, 0, row);
    LaneAppearance<Lanes> x;
    for (int k = 0; k < 7; ++k) x.mean[k] = row[k];
    for (int k = 0; k < 28; ++k) x.P.v[k] = row[7 + k];

    const Appearance* o = &observed[i];
    Lanes z[7], noise[7], process[7];
    z[0] = gather<Lanes>(batch, [&](int l) { return o[l].phase; });
    for (std::size_t k = 0; k < 3; ++k) {
      z[1 + k] = gather<Lanes>(batch, [&](int l) { return o[l].left[k]; });
      z[4 + k] = gather<Lanes>(batch, [&](int l) { return o[l].right[k]; });
    }
    const Lanes phase = gather_span(sigma_phase, i, batch), colour = gather_span(sigma_colour, i, batch);
    noise[0] = phase * phase;
    process[0] = gather_span(q_phase, i, batch);
    for (int k = 1; k < 7; ++k) {
      noise[k] = colour * colour;
      process[k] = k == 1 ? gather_span(q_colour, i, batch) : process[1];
    }

    const Mask<kLaneWidth> good = update_appearance(x, z, noise, process);
    for (int k = 0; k < 7; ++k) row[k] = x.mean[k];
    for (int k = 0; k < 28; ++k) row[7 + k] = x.P.v[k];
    scatter_rows<AppearanceBlock::kRows>(row, good, 0, batch, blocks.data());
    for (int l = 0; l < batch.count; ++l)
      outcomes[i + static_cast<std::size_t>(l)] =
          good[l] ? UpdateOutcome::kUpdated : UpdateOutcome::kNotPositiveDefinite;
  }
}

}  // namespace accrete
