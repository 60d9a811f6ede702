#include "cli/evaluate/tables.h"

#include <fmt/format.h>

#include <algorithm>

namespace accrete::cli {
namespace {

std::string markdown_row(const std::vector<std::string>& cells) {
  std::string out = "|";
  for (const std::string& cell : cells) {
    out += ' ';
    for (const char c : cell) {
      if (c == '|') out += '\\';
      out += c;
    }
    out += " |";
  }
  out += '\n';
  return out;
}

}  // namespace

std::string to_text(const std::vector<Table>& tables) {
  std::string out;
  for (const Table& table : tables) {
    out += fmt::format("\n{}\n", table.title);
    std::vector<std::size_t> width;
    std::vector<std::vector<std::string>> rows = table.rows;
    if (!table.header.empty()) rows.insert(rows.begin(), table.header);
    for (const auto& row : rows) {
      width.resize(std::max(width.size(), row.size()), 0);
      for (std::size_t i = 0; i < row.size(); ++i) width[i] = std::max(width[i], row[i].size());
    }
    for (const auto& row : rows) {
      std::string line = " ";
      for (std::size_t i = 0; i < row.size(); ++i) {
        const bool figures = !table.header.empty() && i > 0;  // columns of figures are aligned on the right
        line += figures ? fmt::format(" {:>{}} ", row[i], width[i]) : fmt::format(" {:<{}} ", row[i], width[i]);
      }
      line.erase(line.find_last_not_of(' ') + 1);
      out += line + '\n';
    }
    if (!table.note.empty()) out += fmt::format("  {}\n", table.note);
  }
  return out;
}

std::string to_markdown(const std::vector<Table>& tables) {
  std::string out;
  for (const Table& table : tables) {
    out += fmt::format("\n### {}\n\n", table.title);
    const std::vector<std::string> header = table.header.empty() ? std::vector<std::string>{"", ""} : table.header;
    out += markdown_row(header);
    out += '|';
    for (std::size_t i = 0; i < header.size(); ++i) out += i == 0 || table.header.empty() ? "---|" : "---:|";
    out += '\n';
    for (const auto& row : table.rows) out += markdown_row(row);
    if (!table.note.empty()) out += fmt::format("\n{}\n", table.note);
  }
  return out;
}

}  // namespace accrete::cli
