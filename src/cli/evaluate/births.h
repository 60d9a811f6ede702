// Where each primitive was when it was born: accuracy then against accuracy at the end shows what accumulation brings.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "accrete/model.h"
#include "cli/score/score.h"
#include "cli/score/truth.h"

namespace accrete::cli {

class BirthLog {
 public:
  // After every step; `frame` as in its report.
  void record(const ModelView& model, std::uint32_t frame);

  struct Birth {
    std::uint32_t generation = 0;  // 0: the slot has never been used
    std::array<float, 3> position{}, tangent{};
  };
  // The birth of a primitive that is in the model, or null when it was born before the log began.
  [[nodiscard]] const Birth* find(PrimitiveId id) const;

 private:
  std::vector<Birth> slots_;
};

// {"n", "median_at_birth_mm", "median_at_end_mm", "ratio", "tangent_..."}: over the primitives that are confirmed or
// preserved and correct at the end, the perpendicular distance to their segment then and when they were born.
// Precondition: truth.edges is there.
[[nodiscard]] nlohmann::ordered_json birth_against_end(std::span<const Primitive3d> primitives, const BirthLog& births,
                                                       const Truth& truth, const ScoreSettings& settings);

}  // namespace accrete::cli
