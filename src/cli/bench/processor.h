#pragma once

#include <string>

namespace accrete::cli {

// As the processor calls itself, "unknown processor" where it does not say.
[[nodiscard]] std::string processor_name();

}  // namespace accrete::cli
