// The work that is timed, a function a row: each goes `frames` frames over a whole pool.
#pragma once

#include <span>

#include "cli/bench/pool.h"
#include "kernels/kernels.h"

namespace accrete::cli {

struct BenchRow {
  const char* key;   // for JSON
  const char* name;  // for people
  void (*run)(const Kernels& kernels, BenchPool& pool, std::size_t frames);
};

[[nodiscard]] std::span<const BenchRow> bench_rows();

// Frames that are about 8,192 primitives' work, a whole number of cycles.
[[nodiscard]] std::size_t bench_frames(std::size_t primitives);

}  // namespace accrete::cli
