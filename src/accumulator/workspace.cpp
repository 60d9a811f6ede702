#include "accumulator/workspace.h"

#include <memory>
#include <new>

namespace accrete {
namespace {

class Cutter {
 public:
  explicit Cutter(std::byte* memory) : memory_(memory) {}

  template <class T>
  void operator()(std::span<T>& out, std::size_t count) {
    constexpr std::size_t kAlign = 64;  // of blocks, and of cache lines for everything else
    static_assert(alignof(T) <= kAlign);
    offset_ = (offset_ + kAlign - 1) / kAlign * kAlign;
    if (memory_ != nullptr) {
      T* first = std::launder(reinterpret_cast<T*>(memory_ + offset_));
      std::uninitialized_value_construct_n(first, count);
      out = {first, count};
    }
    offset_ += count * sizeof(T);
  }
  [[nodiscard]] std::size_t bytes() const { return offset_; }

 private:
  std::byte* memory_;
  std::size_t offset_ = 0;
};

}  // namespace

std::size_t cut(std::byte* memory, const Capacities& c, Workspace& w) {
  Cutter take(memory);
  for (EyeMemory& e : w.eye) {
    take(e.primitives, c.primitives2d);
    take(e.rows, extract::kChannels * extract::quadrature_floats(c.image_width));
    take(e.cells, extract::cells_per_band(c.image_width));
    take(e.previous, c.image_width * c.image_height);
    take(e.grid_begin, associate::Grid::kCells + 1);
    take(e.grid_order, c.primitives2d);
    take(e.density, c.primitives2d);
    take(e.row_order, c.primitives2d);
    take(e.row_begin, std::size_t{stereo::kRows} + 1);
    take(e.owner, c.primitives2d);
  }
  take(w.candidates, c.primitives2d);
  take(w.best_of_right, c.primitives2d);
  take(w.matches, c.stereo_matches);
  take(w.geometry, c.primitives3d / kBlockLanes);
  take(w.appearance, c.primitives3d / kBlockLanes);
  take(w.tracks, c.primitives3d);
  take(w.free_slots, c.primitives3d);
  take(w.slot_scratch, c.primitives3d);
  take(w.live, c.primitives3d);
  take(w.predicted, c.primitives3d);
  take(w.expected_slots, c.primitives3d);
  take(w.expected, c.primitives3d);
  take(w.associations, c.primitives3d);
  take(w.hypotheses, c.primitives3d * associate::kPerExpected);
  take(w.explained, c.primitives2d);
  take(w.gating, 1);
  // An observation corrects one primitive: no more matches than 2D-primitives of both eyes.
  const std::size_t m = 2 * c.primitives2d;
  take(w.batch.slots, m);
  take(w.batch.left, m);
  take(w.batch.right, m);
  take(w.batch.eyes, m);
  take(w.batch.slide_cap, m);
  take(w.batch.appearance, m);
  take(w.batch.sigma_phase, m);
  take(w.batch.sigma_left, m);
  take(w.batch.sigma_right, m);
  take(w.batch.q_phase, m);
  take(w.batch.q_colour, m);
  take(w.batch.outcomes, m);
  return take.bytes();
}

}  // namespace accrete
