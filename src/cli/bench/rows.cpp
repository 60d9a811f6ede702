#include "cli/bench/rows.h"

#include <algorithm>
#include <array>

namespace accrete::cli {
namespace {

using Frame = BenchPool::Frame;

void predict_state(const Kernels& k, BenchPool& p, const Frame& f) { k.predict_states(p.geometry, f.step); }

void add_noise(const Kernels& k, BenchPool& p, const Frame&) {
  PoseCovariance increment{};
  for (std::size_t i = 0; i < 6; ++i) increment[7 * i] = 1e-10;
  k.add_incremental_motion_noise(p.geometry, {}, increment);
}

void predict_observation(const Kernels& k, BenchPool& p, const Frame& f) {
  k.predict_observations(p.geometry, p.slots, f.pose, p.optics, p.predicted);
}

void update_stereo(const Kernels& k, BenchPool& p, const Frame& f) {
  k.update_stereo(p.geometry, p.slots, f.left, f.right, f.pose, p.optics, p.outcomes, {});
}

void update_stereo_scattered(const Kernels& k, BenchPool& p, const Frame& f) {
  k.update_stereo(p.geometry, p.scattered, f.left, f.right, f.pose, p.optics, p.outcomes, {});
}

void update_mono(const Kernels& k, BenchPool& p, const Frame& f) {
  k.update_mono(p.geometry, p.slots, f.left, p.eyes, f.pose, p.optics, p.outcomes, {});
}

void update_reconstructed(const Kernels& k, BenchPool& p, const Frame&) {
  k.update_reconstructed(p.geometry, p.slots, p.reconstructed, p.outcomes);
}

void update_roll(const Kernels& k, BenchPool& p, const Frame& f) {
  k.update_roll(p.geometry, p.slots, f.pose, p.optics, 0.87F, p.outcomes);
}

void update_appearance(const Kernels& k, BenchPool& p, const Frame& f) {
  k.update_appearance(p.appearance, p.slots, f.looks, p.sigma_phase, p.sigma_colour, p.sigma_colour, p.q_phase,
                      p.q_colour, p.outcomes);
}

using associate::PairBatch;

// Every primitive with its own observations, as many pairs at a time as association gates.
template <class Gate>
void gate_all(BenchPool& p, Gate gate) {
  PairBatch& b = p.pairs;
  for (std::size_t i = 0; i < p.size; i += PairBatch::kCapacity) {
    b.count = std::min(PairBatch::kCapacity, p.size - i);
    for (std::size_t k = 0; k < b.count; ++k) {
      b.expected[k] = static_cast<std::uint32_t>(i + k);
      b.left[k] = b.right[k] = static_cast<std::uint16_t>(i + k);
    }
    gate(b);
  }
}

void gate_stereo(const Kernels& k, BenchPool& p, const Frame& f) {
  gate_all(p, [&](PairBatch& b) { k.gate.both_eyes(p.expected, p.view(f, 0), p.view(f, 1), b); });
}

void gate_mono(const Kernels& k, BenchPool& p, const Frame& f) {
  gate_all(p, [&](PairBatch& b) { k.gate.one_eye(p.expected, p.view(f, 0), 0, b); });
}

// As the library does it: states stay where they are, and what the cameras should see is gated before it corrects.
void step(const Kernels& k, BenchPool& p, const Frame& f) {
  predict_observation(k, p, f);
  for (std::size_t i = 0; i < p.size; ++i) {
    associate::Expected& e = p.expected[i];
    e.predicted = p.predicted[i];
    const auto row = [&](std::size_t r) { return p.appearance[i / kBlockLanes].row[r][i % kBlockLanes]; };
    e.mean = {row(0), {row(1), row(2), row(3)}, {row(4), row(5), row(6)}};
    for (std::size_t c = 0; c < 7; ++c) e.variance[c] = row(AppearanceBlock::kCovariance + packed_index(7, c, c));
  }
  gate_stereo(k, p, f);
  update_stereo(k, p, f);
  update_appearance(k, p, f);
}

// In the frame of the cameras, as the peers do it: the state moves, and is corrected by both images. No gate: they have
// none.
void everything(const Kernels& k, BenchPool& p, const Frame& f) {
  k.predict_states(p.geometry, f.step);
  k.update_stereo(p.geometry, p.slots, f.left, f.right, p.here, p.optics, p.outcomes, {});
  update_appearance(k, p, f);
}

template <void (*Work)(const Kernels&, BenchPool&, const Frame&)>
void cycle(const Kernels& kernels, BenchPool& pool, std::size_t frames) {
  for (std::size_t f = 0; f < frames; ++f) Work(kernels, pool, pool.frames[f % BenchPool::kFrames]);
}

constexpr std::array kRows{
    BenchRow{"predict_state", "predict: the state, by an exact motion", cycle<predict_state>},
    BenchRow{"motion_noise", "predict: noise of an uncertain motion", cycle<add_noise>},
    BenchRow{"predict_observation", "predict: what both cameras see", cycle<predict_observation>},
    BenchRow{"gate", "gate: what both eyes saw", cycle<gate_stereo>},
    BenchRow{"gate_one_eye", "gate: what one eye saw", cycle<gate_mono>},
    BenchRow{"update_stereo", "update: geometry, stereo", cycle<update_stereo>},
    BenchRow{"update_stereo_scattered", "the same, slots in random order", cycle<update_stereo_scattered>},
    BenchRow{"update_mono", "update: geometry, one eye", cycle<update_mono>},
    BenchRow{"update_reconstructed", "update: geometry, by a reconstructed primitive", cycle<update_reconstructed>},
    BenchRow{"update_roll", "update: roll", cycle<update_roll>},
    BenchRow{"update_appearance", "update: appearance 7 x 7", cycle<update_appearance>},
    BenchRow{"step", "predict views + gate + stereo + appearance", cycle<step>},
    BenchRow{"all", "predict state + stereo + appearance", cycle<everything>},
};

}  // namespace

std::span<const BenchRow> bench_rows() { return kRows; }

std::size_t bench_frames(std::size_t primitives) {
  const std::size_t cycles = 1024 / std::max<std::size_t>(primitives, 1);
  return BenchPool::kFrames * std::clamp<std::size_t>(cycles, 1, 64);
}

}  // namespace accrete::cli
