#include "cli/evaluate/births.h"

#include <cmath>
#include <numbers>

#include "cli/score/association.h"
#include "cli/score/statistics.h"
#include "cli/write/snapshot.h"

namespace accrete::cli {
namespace {

EdgePoint point(const std::array<float, 3>& position, const std::array<float, 3>& tangent) {
  return {{position[0], position[1], position[2]}, {tangent[0], tangent[1], tangent[2]}};
}

}  // namespace

void BirthLog::record(const ModelView& model, std::uint32_t frame) {
  if (slots_.size() < model.slots()) slots_.resize(model.slots());
  for (std::size_t slot = 0; slot < model.slots(); ++slot) {
    if (model.state(slot) == State::kFree) continue;
    const Primitive3d p = model.at(slot);
    if (p.first_frame == frame && slots_[slot].generation != p.id.generation)
      slots_[slot] = {p.id.generation, p.geometry.position, p.tangent};
  }
}

const BirthLog::Birth* BirthLog::find(PrimitiveId id) const {
  if (id.is_null() || id.index1 > slots_.size()) return nullptr;
  const Birth& birth = slots_[id.index1 - 1];
  return birth.generation == id.generation ? &birth : nullptr;
}

nlohmann::ordered_json birth_against_end(std::span<const Primitive3d> primitives, const BirthLog& births,
                                         const Truth& truth, const ScoreSettings& s) {
  constexpr double kDegree = std::numbers::pi / 180;
  const double tolerance = s.tolerance_mm / 1e3, pitch = s.pitch_mm / 1e3, angle = s.angle_deg * kDegree;
  std::vector<double> at_birth, at_end, tangent_birth, tangent_end;
  for (const Primitive3d& p : accepted(primitives, static_cast<float>(s.min_existence))) {
    const BirthLog::Birth* birth = births.find(p.id);
    const EdgePoint end = point(p.geometry.position, p.tangent);
    const Association nearest = associate(end, *truth.edges, angle, pitch);
    if (birth == nullptr || nearest.segment < 0 || nearest.distance_m > tolerance) continue;
    if (truth.region && !truth.region->contains(end.position)) continue;
    if (truth.extra && associate(end, *truth.extra, angle, pitch).distance_m < nearest.distance_m) continue;
    const Relation then =
        relate(point(birth->position, birth->tangent), truth.edges->list[static_cast<std::size_t>(nearest.segment)]);
    at_birth.push_back(then.distance_m * 1e3);
    at_end.push_back(nearest.distance_m * 1e3);
    tangent_birth.push_back(then.angle / kDegree);
    tangent_end.push_back(nearest.angle / kDegree);
  }
  if (at_end.empty()) return {{"n", 0}};
  const double birth = median(at_birth), end = median(at_end);
  return {{"n", at_end.size()},
          {"median_at_birth_mm", birth},
          {"median_at_end_mm", end},
          {"ratio", end > 0 ? nlohmann::ordered_json(birth / end) : nlohmann::ordered_json(nullptr)},
          {"tangent_at_birth_deg", median(tangent_birth)},
          {"tangent_at_end_deg", median(tangent_end)}};
}

}  // namespace accrete::cli
