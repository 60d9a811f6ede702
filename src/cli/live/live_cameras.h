// What a command says about cameras that deliver now: at the start, and at the end.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "accrete/hal/live_source.h"

namespace accrete::cli {

// A live source beside the frames that it delivers; the functions are valid as long as it is.
struct LiveCameras {
  std::vector<std::pair<std::string, std::string>> lines;  // label and text, for describe()
  std::function<bool()> reconnecting;                      // a camera is gone, and looked for
  std::function<std::vector<std::string>()> report;        // sentences at the end, each a thing to know
};

[[nodiscard]] LiveCameras watch(const hal::LiveSource& source);

// Losses, skew, clocks, what was locked, what was lost.
[[nodiscard]] std::vector<std::string> sentences(const hal::LiveStatistics& statistics);

}  // namespace accrete::cli
