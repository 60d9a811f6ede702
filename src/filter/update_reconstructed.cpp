#include "accrete/contract.h"
#include "filter/reconstructed_kernel.h"
#include "filter/update.h"

namespace accrete::inline ACCRETE_ISA {

void update_reconstructed(std::span<GeometryBlock> blocks, std::span<const std::uint32_t> slots,
                          std::span<const GeometryBlock> observed, std::span<UpdateOutcome> outcomes) {
  ACCRETE_EXPECTS(outcomes.size() == slots.size() && observed.size() * kBlockLanes >= slots.size());
  RowBuffer<GeometryBlock::kRows, kLaneWidth> states;
  for (std::size_t i = 0; i < slots.size(); i += kLaneWidth) {
    const LaneSlots<kLaneWidth> batch(&slots[i], slots.size() - i);
    const auto rows = states.rows(batch, blocks.data());
    LaneState<Lanes> x, z;
    load_state(rows, x);
    load_state(rows_of(observed[i / kBlockLanes], i % kBlockLanes), z);
    const Flags good = update_reconstructed(x, z);
    store_state(good, x, rows);
    states.scatter(batch, blocks.data());
    std::int32_t fine[kLaneWidth];
    store_mask(good, fine);
    for (int l = 0; l < batch.count; ++l)
      outcomes[i + static_cast<std::size_t>(l)] =
          fine[l] != 0 ? UpdateOutcome::kUpdated : UpdateOutcome::kNotPositiveDefinite;
  }
}

}  // namespace accrete::inline ACCRETE_ISA
