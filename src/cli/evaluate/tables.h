// What an evaluation found, as tables for a terminal and for a Markdown file.
#pragma once

#include <string>
#include <vector>

namespace accrete::cli {

struct Table {
  std::string title;
  std::vector<std::string> header;  // may be empty: label and value
  std::vector<std::vector<std::string>> rows;
  std::string note;  // printed below
};

[[nodiscard]] std::string to_text(const std::vector<Table>& tables);
// With headings of the third level.
[[nodiscard]] std::string to_markdown(const std::vector<Table>& tables);

}  // namespace accrete::cli
