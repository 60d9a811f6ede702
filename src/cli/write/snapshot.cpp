#include "cli/write/snapshot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace accrete::cli {

std::vector<Primitive3d> snapshot(const ModelView& model, std::span<const std::uint64_t> frame_numbers) {
  const auto number = [frame_numbers](std::uint32_t used) {
    return used < frame_numbers.size() ? static_cast<std::uint32_t>(frame_numbers[used]) : used;
  };
  std::vector<Primitive3d> out;
  for (std::size_t slot = 0; slot < model.slots(); ++slot) {
    if (model.state(slot) == State::kFree) continue;
    out.push_back(model.at(slot));
    out.back().first_frame = number(out.back().first_frame);
    out.back().last_frame = number(out.back().last_frame);
  }
  return out;
}

std::vector<Primitive3d> accepted(std::span<const Primitive3d> primitives, float min_existence) {
  std::vector<Primitive3d> out;
  for (const Primitive3d& p : primitives)
    if ((p.state == State::kConfirmed || p.state == State::kPreserved) && p.existence >= min_existence)
      out.push_back(p);
  return out;
}

std::string id_text(PrimitiveId id) { return fmt::format("{}-{}", id.index1, id.generation); }

const char* state_text(State state) {
  switch (state) {
    case State::kFree:
      return "free";
    case State::kTentative:
      return "tentative";
    case State::kConfirmed:
      return "confirmed";
    case State::kPreserved:
      return "preserved";
  }
  return "unknown";
}

std::vector<float> half_lengths_m(std::span<const Primitive3d> primitives) {
  std::vector<float> half;
  for (const Primitive3d& p : primitives) {
    const auto& c = p.geometry.covariance;
    const auto& t = p.tangent;
    float variance = 0;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) variance += t[i] * t[j] * c[packed_index(6, std::min(i, j), std::max(i, j))];
    half.push_back(variance > 0 && std::isfinite(variance) ? std::sqrt(3 * variance) : 0);
  }
  if (half.empty()) return half;
  // A primitive whose slide is unusually well or badly known must not draw a dot or a line across the object.
  std::vector<float> sorted = half;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
  const float middle = std::max(sorted[sorted.size() / 2], 1e-5F);
  for (float& h : half) h = std::clamp(h, middle / 3, middle * 3);
  return half;
}

}  // namespace accrete::cli
