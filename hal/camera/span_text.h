// A span of time as a person reads it.
#pragma once

#include <cstdint>
#include <string>

#include "text/sentence.h"

namespace accrete::hal::camera {

inline std::string span_text(std::int64_t ns) {
  if (ns >= 1'000'000'000) return number(static_cast<double>(ns) * 1e-9, 3) + " s";
  return number(static_cast<double>(ns) * 1e-6, 3) + " ms";
}

}  // namespace accrete::hal::camera
