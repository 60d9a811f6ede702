#include "store/store.h"

#include <algorithm>
#include <numeric>

#include "accrete/contract.h"

namespace accrete {
namespace {

// What a free lane holds: a finite unit Gaussian, so that kernels may run over whole blocks.
constexpr Geometry kEmptyGeometry = [] {
  Geometry g;
  for (std::size_t i = 0; i < 6; ++i) g.covariance[packed_index(6, i, i)] = 1;
  return g;
}();
constexpr AppearanceState kEmptyAppearance = [] {
  AppearanceState a;
  for (std::size_t i = 0; i < 7; ++i) a.covariance[packed_index(7, i, i)] = 1;
  return a;
}();

}  // namespace

void Store::clear() {
  std::iota(free_slots.begin(), free_slots.end(), 0U);
  free_begin = 0;
  free_count = tracks.size();
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const std::uint32_t generation = tracks[i].generation;
    tracks[i] = Track{};
    tracks[i].generation = generation;
    accrete::store(kEmptyGeometry, geometry[i / kBlockLanes], i % kBlockLanes);
    accrete::store(kEmptyAppearance, appearance[i / kBlockLanes], i % kBlockLanes);
  }
}

std::uint32_t Store::take() {
  ACCRETE_EXPECTS(free_count > 0);
  const std::uint32_t slot = free_slots[free_begin];
  free_begin = (free_begin + 1) % free_slots.size();
  --free_count;
  const std::uint32_t generation = tracks[slot].generation + 1;
  tracks[slot] = Track{};
  tracks[slot].generation = generation;
  tracks[slot].state = State::kTentative;
  return slot;
}

void Store::release(std::uint32_t slot) {
  ACCRETE_EXPECTS(tracks[slot].state != State::kFree);
  tracks[slot].state = State::kFree;
  accrete::store(kEmptyGeometry, geometry[slot / kBlockLanes], slot % kBlockLanes);
  accrete::store(kEmptyAppearance, appearance[slot / kBlockLanes], slot % kBlockLanes);
  free_slots[(free_begin + free_count) % free_slots.size()] = slot;
  ++free_count;
}

std::uint32_t Store::make_room(std::size_t wanted, float keep) {
  if (free_count >= wanted) return 0;
  std::size_t n = 0;
  for (std::uint32_t i = 0; i < tracks.size(); ++i)
    if (tracks[i].state != State::kFree && tracks[i].log_odds < keep) scratch[n++] = i;
  const std::size_t evict = std::min(n, wanted - free_count);
  const auto less_valuable = [this](std::uint32_t a, std::uint32_t b) {
    const Track &ta = tracks[a], &tb = tracks[b];
    if (ta.log_odds != tb.log_odds) return ta.log_odds < tb.log_odds;
    return ta.first_frame != tb.first_frame ? ta.first_frame < tb.first_frame : a < b;
  };
  const auto end = scratch.begin() + static_cast<std::ptrdiff_t>(n);
  if (evict < n)
    std::nth_element(scratch.begin(), scratch.begin() + static_cast<std::ptrdiff_t>(evict), end, less_valuable);
  // In the order of slots, so that the free list does not depend on how the library partitions.
  std::sort(scratch.begin(), scratch.begin() + static_cast<std::ptrdiff_t>(evict));
  for (std::size_t i = 0; i < evict; ++i) release(scratch[i]);
  return static_cast<std::uint32_t>(evict);
}

}  // namespace accrete
