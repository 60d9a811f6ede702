// accrete bench: what a primitive costs on this machine, for every instruction set that it has.
#pragma once

#include "cli/failure.h"

namespace accrete::cli {

struct BenchOptions {
  int primitives = 1024;
  int repetitions = 7;  // of each of five rounds
  bool json = false;
};
[[nodiscard]] ExitStatus bench_command(const BenchOptions& options);

}  // namespace accrete::cli
