#include "cli/evaluate/markdown_page.h"

#include <fmt/format.h>

namespace accrete::cli {
namespace {

constexpr std::string_view kHead =
    "# Evaluation\n\nWritten by `accrete evaluate RECORDING --markdown FILE`, a section a recording; not by hand.\n"
    "[What the figures mean](reference/program.md#what-the-figures-mean).\n";

// Where the line that begins with `text` starts, from `from` on; npos when there is none.
std::size_t find_line(std::string_view page, std::string_view text, std::size_t from) {
  for (std::size_t at = from; at <= page.size(); ++at) {
    if (page.substr(at).starts_with(text)) return at;
    at = page.find('\n', at);
    if (at == std::string_view::npos) break;
  }
  return std::string_view::npos;
}

}  // namespace

std::string with_section(std::string_view page, std::string_view title, std::string_view body) {
  const std::string section = fmt::format("## {}\n\n{}", title, body);
  std::string out(page.empty() ? kHead : page);
  if (!out.ends_with('\n')) out += '\n';
  const std::size_t begin = find_line(out, fmt::format("## {}\n", title), 0);
  if (begin == std::string::npos) return fmt::format("{}\n{}", out, section);
  const std::size_t next = find_line(out, "## ", out.find('\n', begin) + 1);
  const std::string before = out.substr(0, begin);
  if (next == std::string::npos) return before + section;
  return fmt::format("{}{}\n{}", before, section, out.substr(next));
}

}  // namespace accrete::cli
