// Duplicates of one stretch of edge become one primitive (METHOD 6.6).
#pragma once

#include "accrete/step_report.h"
#include "associate/associate.h"
#include "store/store.h"

namespace accrete {

// `slots[i]` is expected as `expected[i]` in this frame; only such neighbours in the image are compared, within three
// quarters of a pitch along the edge. The older one stays and takes over the better existence.
void merge_duplicates(std::span<const std::uint32_t> slots, std::span<const associate::Expected> expected,
                      std::span<std::uint32_t> cell_begin, std::span<std::uint32_t> cell_order, float bias_px,
                      float focal_px, Store& store, StepReport& report);

// cell_begin needs this many elements; cell_order as many as slots.
inline constexpr std::size_t kMergeCells = 128 * 128;

}  // namespace accrete
