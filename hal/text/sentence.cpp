#include "text/sentence.h"

#include <algorithm>
#include <charconv>

namespace accrete::hal {

std::string at_line(const std::filesystem::path& path, std::size_t line) {
  return path.string() + ", line " + std::to_string(line);
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kMaxShown = 40;
  std::string shown(text.substr(0, kMaxShown));
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return "'" + shown + (text.size() > kMaxShown ? "...'" : "'");
}

std::string number(double value, int digits) {
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::general, digits);
  return {text, end.ptr};
}

std::string count(std::uint64_t n, std::string_view noun) {
  return std::to_string(n) + ' ' + std::string(noun) + (n == 1 ? "" : "s");
}

std::string size_text(int width, int height) { return std::to_string(width) + 'x' + std::to_string(height); }

}  // namespace accrete::hal
