#include "associate/candidates.h"

#include <algorithm>
#include <cmath>

#include "associate/gate_kernel.h"

namespace accrete::associate {
namespace {

constexpr float kMaxAcross = 16.0F;  // px: wider gates are not searched; their likelihood is below any clutter's
constexpr float kMaxSine = 0.7F;     // 45 degrees: beyond, the sine no longer measures the angle
constexpr float kClosed = -1e30F;    // log likelihoods below this mean that a gate is closed

// The elements of one eye's image near an expected one: appended to the batch, and `full` is called when that is full.
template <class Full>
void gather(std::uint32_t index, const Expected& e, const EyeView& view, int eye, PairBatch& pairs, Full full) {
  const PredictedObservation& p = e.predicted;
  const bool is_left = eye == 0;
  const LaneElement<float> at =
      is_left ? LaneElement<float>{p.x_l, p.y_l, p.c_l, p.s_l} : LaneElement<float>{p.x_r, p.y_r, p.c_r, p.s_r};
  const std::size_t n = is_left ? 0 : 2;
  const float variance = p.covariance[packed_index(4, n, n)] + e.noise.variance_n_px2;
  const float across = std::min(kMaxAcross, 3.7F * std::sqrt(variance + 0.25F));  // sqrt(kGate4), and 0.5 px of noise
  auto& seen = is_left ? pairs.left : pairs.right;
  view.grid->near(at.x, at.y, std::max(across, kSlideGate), [&](std::uint16_t i) {
    const LineElement& o = view.primitives[i].aligned;
    const LaneResidual<float> r = residual(at, LaneElement<float>{o.x_px, o.y_px, o.c, o.s});
    // Written before it is known whether it counts: most do not, and which is hard to foresee.
    pairs.expected[pairs.count] = index;
    seen[pairs.count] = i;
    const bool is_near =
        (std::fabs(r.slide) <= kSlideGate) & (std::fabs(r.n) <= across) & (std::fabs(r.sine) <= kMaxSine);
    pairs.count += is_near ? 1 : 0;
    if (pairs.count == PairBatch::kCapacity) full();
  });
}

std::uint8_t sense_of(bool is_reversed) { return is_reversed ? 1 : 0; }

void mark_explained(Explained& e, std::uint16_t right) {
  for (std::size_t k = 0; k < e.count; ++k)
    if (e.right[k] == right) return;
  if (e.count < Explained::kMax) e.right[e.count++] = right;
}

}  // namespace

float log_miss(const Expected& e) { return log_of(miss_likelihood(e.visible, e.detection)); }

void find_hypotheses(std::span<const Expected> expected, std::size_t first, std::size_t count, const EyeView& left,
                     const EyeView& right, const GateKernels& gate, std::span<Explained> explained, GatingRoom& room) {
  PairBatch& pairs = room.pairs;
  pairs.count = 0;
  for (int eye = 0; eye < 2; ++eye) {
    const EyeView& view = eye == 0 ? left : right;
    CandidateList* lists = room.candidates[eye];
    for (std::size_t k = 0; k < count; ++k) lists[k].count = 0;
    const auto keep = [&] {
      gate.one_eye(expected, view, eye, pairs);
      for (std::size_t k = 0; k < pairs.count; ++k)
        if (pairs.d2[k] <= kGate4)
          lists[pairs.expected[k] - first].offer({pairs.d2[k], pairs.log_likelihood[k],
                                                  eye == 0 ? pairs.left[k] : pairs.right[k],
                                                  (eye == 0 ? pairs.left_reversed : pairs.right_reversed)[k] != 0});
      pairs.count = 0;
    };
    for (std::size_t k = 0; k < count; ++k)
      gather(static_cast<std::uint32_t>(first + k), expected[first + k], view, eye, pairs, keep);
    keep();
  }

  float miss[GatingRoom::kGroup];
  for (std::size_t k = 0; k < count; ++k) {
    const auto index = static_cast<std::uint32_t>(first + k);
    miss[k] = log_miss(expected[index]);
    HypothesisList& list = room.hypotheses[k];
    list.clear();
    for (int eye = 0; eye < 2; ++eye) {
      const CandidateList& candidates = room.candidates[eye][k];
      for (std::size_t i = 0; i < candidates.count; ++i) {
        const Candidate& c = candidates.item[i];
        if (c.log_likelihood < kClosed) continue;
        const bool is_left = eye == 0;
        list.offer({c.log_likelihood - miss[k], c.log_likelihood, index, is_left ? c.index : kNone,
                    is_left ? kNone : c.index, sense_of(is_left && c.reversed), sense_of(!is_left && c.reversed),
                    c.d2});
      }
    }
  }

  const auto conclude = [&] {
    gate.both_eyes(expected, left, right, pairs);
    for (std::size_t k = 0; k < pairs.count; ++k) {
      const float log_l = pairs.log_likelihood[k];
      if (log_l < kClosed) continue;
      mark_explained(explained[pairs.left[k]], pairs.right[k]);
      const std::size_t own = pairs.expected[k] - first;
      room.hypotheses[own].offer({log_l - miss[own], log_l, pairs.expected[k], pairs.left[k], pairs.right[k],
                                  sense_of(pairs.left_reversed[k] != 0), sense_of(pairs.right_reversed[k] != 0),
                                  pairs.d2[k]});
    }
    pairs.count = 0;
  };
  for (std::size_t k = 0; k < count; ++k) {
    const CandidateList &l = room.candidates[0][k], &r = room.candidates[1][k];
    for (std::size_t i = 0; i < l.count; ++i)
      for (std::size_t j = 0; j < r.count; ++j) {
        pairs.expected[pairs.count] = static_cast<std::uint32_t>(first + k);
        pairs.left[pairs.count] = l.item[i].index;
        pairs.right[pairs.count] = r.item[j].index;
        if (++pairs.count == PairBatch::kCapacity) conclude();
      }
  }
  conclude();
}

}  // namespace accrete::associate
