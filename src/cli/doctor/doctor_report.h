// A diagnosis as a table and sentences, and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "cli/doctor/diagnosis.h"

namespace accrete::cli {

[[nodiscard]] std::string to_text(const Diagnosis& diagnosis);
[[nodiscard]] nlohmann::ordered_json to_json(const Diagnosis& diagnosis);

}  // namespace accrete::cli
