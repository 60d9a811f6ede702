// Numbers as text, the same on every machine and in every locale: the shortest form that reads back to the same value.
#pragma once

#include <charconv>
#include <string>
#include <string_view>
#include <type_traits>

namespace accrete::cli {

template <class Number>
void append_number(std::string& out, Number value) {
  static_assert(std::is_arithmetic_v<Number>);
  char digits[40];  // the longest shortest form of a double has 24 characters
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  out.append(digits, end);
}

template <class Number>
[[nodiscard]] std::string number_text(Number value) {
  std::string out;
  append_number(out, value);
  return out;
}

// The whole of `text` as a number, blanks at both ends and a leading plus allowed; false when it is not one.
[[nodiscard]] bool parse_number(std::string_view text, double& value);
[[nodiscard]] bool parse_number(std::string_view text, long long& value);

// Without blanks, tabs and carriage returns at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

}  // namespace accrete::cli
