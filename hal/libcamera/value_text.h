// Values of controls as text: "8000", "1.8,1.5".
#pragma once

#include <charconv>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace accrete::hal::libcam {

// Empty: the text is no such list of numbers.
template <class T>
[[nodiscard]] std::vector<T> parse_values(std::string_view text) {
  std::vector<T> values;
  const char *at = text.data(), *end = at + text.size();
  while (true) {
    const auto [stop, error] = std::from_chars(at, end, values.emplace_back());
    if (error != std::errc{} || (stop != end && *stop != ',')) return {};
    if (stop == end) return values;
    at = stop + 1;
  }
}

// Comes back as it was.
template <class T>
[[nodiscard]] std::string values_text(std::span<const T> values) {
  std::string text;
  for (const T value : values) {
    char buffer[32];
    const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
    text += (text.empty() ? "" : ",") + std::string(buffer, end);
  }
  return text;
}

}  // namespace accrete::hal::libcam
