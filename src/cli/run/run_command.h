// accrete run: the main job.
#pragma once

#include <string>
#include <vector>

#include "cli/failure.h"
#include "cli/run/options.h"

namespace accrete::cli {

// `command_line` goes into the summary. Throws Failure before anything has been processed; afterwards it reports.
[[nodiscard]] ExitStatus run_command(const RunOptions& options, const std::vector<std::string>& command_line);

}  // namespace accrete::cli
