#include "cli/text/json_text.h"

#include <algorithm>

namespace accrete::cli {
namespace {

using nlohmann::ordered_json;

bool is_plain(const ordered_json& array) {
  return std::none_of(array.begin(), array.end(), [](const ordered_json& v) { return v.is_structured(); });
}

void append_line(std::string& out, std::size_t level) { out.append(1, '\n').append(level, ' '); }

// Depth is that of our own trees, a handful.
void append(std::string& out, const ordered_json& value, std::size_t level) {  // NOLINT(misc-no-recursion)
  if (!value.is_structured() || value.empty()) {
    out += json_line(value);
    return;
  }
  const bool object = value.is_object(), one_line = value.is_array() && is_plain(value);
  out += object ? '{' : '[';
  bool first = true;
  for (const auto& item : value.items()) {
    if (!first) out += one_line ? ", " : ",";
    first = false;
    if (!one_line) append_line(out, level + 1);
    if (object) out.append(json_line(item.key())).append(": ");
    append(out, item.value(), level + 1);
  }
  if (!one_line) append_line(out, level);
  out += object ? '}' : ']';
}

}  // namespace

std::string json_line(const ordered_json& value) {
  return value.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

std::string json_text(const ordered_json& tree) {
  std::string out;
  append(out, tree, 0);
  out += '\n';
  return out;
}

}  // namespace accrete::cli
