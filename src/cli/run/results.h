// The files of a result, from what a run left behind.
#pragma once

#include <nlohmann/json.hpp>
#include <span>

#include "cli/run/summary.h"
#include "cli/write/result_folder.h"

namespace accrete::cli {

// edges.csv with every primitive; the PLY files with the accepted ones; config.yaml; summary.json last: where it is,
// everything is. Throws Failure(kOutput).
void write_results(const ResultFolder& folder, const RunOptions& options, MotionMode mode,
                   std::span<const Primitive3d> primitives, std::span<const Primitive3d> exported,
                   const nlohmann::ordered_json& summary);

// The engine's parameters: the options', and a synthetic scene's own gripper where no boxes were given.
[[nodiscard]] Params effective_params(const RunOptions& options, const Input& input);

}  // namespace accrete::cli
