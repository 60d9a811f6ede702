// JSON for files that people open too.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace accrete::cli {

// A value without line breaks. What is no UTF-8 (file names may be anything) becomes U+FFFD.
[[nodiscard]] std::string json_line(const nlohmann::ordered_json& value);
// Objects one key a line, arrays of plain values on one line each; ends with a line feed.
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& tree);

}  // namespace accrete::cli
