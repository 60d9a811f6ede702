// accrete evaluate: a run, scored.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/failure.h"
#include "cli/run/options.h"

namespace accrete::cli {

struct EvaluateOptions {
  RunOptions run;                  // `out` empty: no result files
  int hold_out = 0;                // every N-th frame is kept aside
  std::filesystem::path markdown;  // the tables as a Markdown file
  std::filesystem::path truth;     // instead of RECORDING/truth
  std::filesystem::path edges;     // score this file, run nothing
  double min_existence = 0.9;
};

// Throws Failure before anything has been processed.
[[nodiscard]] ExitStatus evaluate_command(const EvaluateOptions& options, const std::vector<std::string>& command_line);

}  // namespace accrete::cli
