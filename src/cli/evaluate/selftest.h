// accrete selftest: is this build sound on this machine? The synthetic scene, accumulated and compared with its truth.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/failure.h"

namespace accrete::cli {

struct Check {
  std::string figure;
  double value = 0;  // NaN: could not be computed
  double low = 0, high = 0;
  std::string unit;

  [[nodiscard]] bool passed() const { return value >= low && value <= high; }
};

// The figures of an evaluation of the scene `box` with the limits that any sound build meets with room to spare.
[[nodiscard]] std::vector<Check> selftest_checks(const nlohmann::ordered_json& evaluation);

struct SelftestOptions {
  int frames = 60;
  std::string set = "best";  // of instructions, by its name
  bool json = false;
  bool quiet = false;
};
// kOk when every check passes, otherwise kNothing. Throws Failure(kUsage) where this processor lacks the set.
[[nodiscard]] ExitStatus selftest_command(const SelftestOptions& options);

}  // namespace accrete::cli
