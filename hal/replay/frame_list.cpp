#include "replay/frame_list.h"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace accrete::hal {
namespace {

bool digit(char c) { return c >= '0' && c <= '9'; }

// The run of digits at `i`, without leading zeros; moves `i` behind it.
std::string_view run_of_digits(std::string_view text, std::size_t& i) {
  while (i + 1 < text.size() && text[i] == '0' && digit(text[i + 1])) ++i;
  const std::size_t begin = i;
  while (i < text.size() && digit(text[i])) ++i;
  return text.substr(begin, i - begin);
}

}  // namespace

bool natural_less(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (digit(a[i]) && digit(b[j])) {
      const std::string_view x = run_of_digits(a, i), y = run_of_digits(b, j);
      if (x.size() != y.size()) return x.size() < y.size();
      if (x != y) return x < y;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
    }
  }
  if (i < a.size() || j < b.size()) return i == a.size();
  return a < b;
}

std::optional<std::vector<std::size_t>> FrameList::lines_of_frames(std::size_t lines) const {
  std::vector<std::size_t> line(frames.size());
  const auto fill = [&](auto&& index) {
    for (std::size_t i = 0; i < frames.size(); ++i) line[i] = static_cast<std::size_t>(index(i));
    return line;
  };
  if (lines == union_count) return fill([&](std::size_t i) { return frames[i].union_index; });
  if (lines == left_count) return fill([&](std::size_t i) { return frames[i].left_index; });
  if (lines == frames.size()) return fill([](std::size_t i) { return i; });
  const bool numbered = std::all_of(frames.begin(), frames.end(), [&](const FrameFiles& f) {
    return f.number >= 0 && f.number < static_cast<std::int64_t>(lines);
  });
  if (numbered) return fill([&](std::size_t i) { return frames[i].number; });
  return std::nullopt;
}

}  // namespace accrete::hal
