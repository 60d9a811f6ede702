// accrete info: what would be read, and with which conventions.
#pragma once

#include "cli/failure.h"
#include "cli/run/options.h"

namespace accrete::cli {

// Prints without processing an image beyond its header. Throws Failure when the recording cannot be opened; missing
// poses are a warning here.
[[nodiscard]] ExitStatus info_command(const RunOptions& options);

}  // namespace accrete::cli
