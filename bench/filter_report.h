// What bench/filter measured, as the page that it prints and keeps.
#pragma once

#include <string>
#include <vector>

#include "kernels/kernels.h"
#include "operations.h"
#include "peak.h"

namespace accrete::bench {

struct SetCost {
  std::string set;  // instruction set
  int lanes = 1;
  std::vector<double> ns;            // per row and primitive
  std::vector<double> instructions;  // the same; negative: not counted
  double allocations = 0;            // per primitive, over all rows
};

struct PeerCost {
  std::string name;
  double ns = 0, instructions = 0, allocations = 0, bytes = 0;
  double offset_sigma = 0, angle_mrad = 0;  // rms difference from our estimates after eight frames
};

struct KernelOperations {
  std::size_t row;
  Operations operations;
};

struct FilterReport {
  std::string commit, compiler, flags, processor;
  std::vector<std::string> rows;            // names
  std::vector<std::size_t> sizes;           // of pools
  std::vector<std::vector<SetCost>> costs;  // [size][set]; sets: double, one lane, then wider and wider
  std::vector<Peak> peaks;                  // per set
  std::vector<KernelOperations> operations;
  std::vector<PeerCost> peers;  // the first one is Eigen, fixed size, double

  [[nodiscard]] std::string markdown() const;
};

}  // namespace accrete::bench
