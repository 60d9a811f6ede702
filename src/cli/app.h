// The command line of `accrete`.
#pragma once

namespace accrete::cli {

// Parses, runs the command, prints what went wrong; returns the exit status.
int run_app(int argc, const char* const* argv);

}  // namespace accrete::cli
