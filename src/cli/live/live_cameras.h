// What a command says about cameras that deliver now: at the start, and at the end.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "accrete/hal/live_source.h"

namespace accrete::cli {

// A live source beside the frames that it delivers; the functions are valid as long as it is.
struct LiveCameras {
  std::vector<std::pair<std::string, std::string>> lines;  // label and text, for describe()
  std::function<bool()> reconnecting;                      // a camera is gone, and looked for
  std::function<hal::LiveStatistics()> statistics;
};

[[nodiscard]] LiveCameras watch(const hal::LiveSource& source);

// At the end, for a person: losses, skew, clocks, what was locked, what was lost.
[[nodiscard]] std::vector<std::string> sentences(const hal::LiveStatistics& statistics);

// The same for a program: "cameras" of summary.json.
[[nodiscard]] nlohmann::ordered_json statistics_json(const hal::LiveStatistics& statistics);

}  // namespace accrete::cli
