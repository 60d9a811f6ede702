// A store with memory of its own.
#pragma once

#include <vector>

#include "accrete/model.h"
#include "store/store.h"

namespace accrete::test {

class OwnedStore {
 public:
  explicit OwnedStore(std::size_t slots)
      : geometry_(slots / kBlockLanes),
        appearance_(slots / kBlockLanes),
        tracks_(slots),
        free_(slots),
        scratch_(slots),
        store_{geometry_, appearance_, tracks_, free_, scratch_} {
    store_.clear();
  }
  OwnedStore(const OwnedStore&) = delete;
  OwnedStore& operator=(const OwnedStore&) = delete;

  Store& operator*() { return store_; }
  Store* operator->() { return &store_; }
  [[nodiscard]] ModelView view(float bias_per_pitch = 0, float typical_misfit = 1) const {
    return {geometry_, appearance_, tracks_, bias_per_pitch, typical_misfit};
  }
  [[nodiscard]] PrimitiveId id(std::uint32_t slot) const { return {slot + 1, tracks_[slot].generation}; }

  // A tentative primitive with this existence.
  std::uint32_t add(float log_odds, std::uint32_t first_frame = 0, State state = State::kTentative) {
    const std::uint32_t slot = store_.take();
    tracks_[slot].state = state;
    tracks_[slot].log_odds = log_odds;
    tracks_[slot].first_frame = tracks_[slot].last_frame = first_frame;
    return slot;
  }

 private:
  std::vector<GeometryBlock> geometry_;
  std::vector<AppearanceBlock> appearance_;
  std::vector<Track> tracks_;
  std::vector<std::uint32_t> free_, scratch_;
  Store store_;
};

}  // namespace accrete::test
