// summary.json: what was run on what, what happened, how long it took. Schema: docs/reference/summary.schema.json.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "accrete/model.h"
#include "cli/failure.h"
#include "cli/run/engine.h"
#include "cli/run/input.h"
#include "cli/run/record.h"

namespace accrete::cli {

struct SummaryInput {
  const std::vector<std::string>& command_line;
  const RunOptions& options;
  const Input& input;
  const Engine& engine;
  const RunRecord& run;
  std::span<const Primitive3d> primitives;
  std::size_t exported = 0;  // in the PLY files
  ExitStatus status = ExitStatus::kOk;
  double wall_seconds = 0;
};

[[nodiscard]] nlohmann::ordered_json summary(const SummaryInput& s);

// {"accrete", "compiler", "cplusplus", "processor", "instruction_set"}: what makes times comparable.
[[nodiscard]] nlohmann::ordered_json versions();

// {"n", "mean", "p50", "p90", "p95", "p99", "max"} in milliseconds for each stage, the whole step and the reading, over
// the frames that were used.
[[nodiscard]] nlohmann::ordered_json timing(const RunRecord& run);

// How the program ends after this run.
[[nodiscard]] ExitStatus exit_status_of(const RunRecord& run, std::size_t accepted);

}  // namespace accrete::cli
