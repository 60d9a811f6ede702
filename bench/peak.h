// What this machine can do at most, measured: multiply-adds, divisions and square roots of independent vectors.
#pragma once

#include <vector>

#include "cli/bench/timing.h"

namespace accrete::bench {

// Time of one vector instruction of each kind, ns.
struct Peak {
  int lanes = 0;
  bool fused = false;  // otherwise a multiply-add is two instructions
  double multiply_add_ns = 0, divide_ns = 0, root_ns = 0;

  [[nodiscard]] double gflops() const { return 2 * lanes / multiply_add_ns; }
};

// What a set of kernels computes with: vectors of 1, 4, 8 or 16 floats, or one double.
struct Arithmetic {
  int lanes = 1;
  bool is_double = false;
  bool fused = false;  // compiled for a processor with fused multiply-adds
};

// Their loops, appended to what is timed: in the same run, in turns. Only what the processor executes.
[[nodiscard]] bool can_run(int lanes);
void add_peak(const Arithmetic& a, std::vector<cli::Contender>& contenders);
[[nodiscard]] Peak peak_from(const Arithmetic& a, const cli::Contender* first);

}  // namespace accrete::bench
