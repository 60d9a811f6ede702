#include "cli/score/csv_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "cli/failure.h"
#include "cli/text/number.h"

namespace accrete::cli {
namespace {

[[noreturn]] void fail(const std::string& name, const std::string& what) {
  throw Failure(ExitStatus::kInput, name + ": " + what);
}

// Takes the next field off the front of `rest`; a field in double quotes may hold commas, "" stands for one quote.
std::string take_field(std::string_view& rest, bool& last) {
  std::string field;
  const auto start = std::min(rest.find_first_not_of(" \t"), rest.size());
  rest.remove_prefix(start);
  std::size_t i = 0;
  if (!rest.empty() && rest.front() == '"') {
    for (i = 1; i < rest.size(); ++i) {
      if (rest[i] != '"') {
        field += rest[i];
      } else if (i + 1 < rest.size() && rest[i + 1] == '"') {
        field += '"';
        ++i;
      } else {
        ++i;
        break;
      }
    }
  }
  const auto comma = std::min(rest.find(',', i), rest.size());
  field += rest.substr(i, comma - i);
  last = comma == rest.size();
  rest.remove_prefix(last ? comma : comma + 1);
  return std::string(trimmed(field));
}

std::vector<std::string> split(std::string_view line) {
  std::vector<std::string> fields;
  for (bool last = false; !last;) fields.push_back(take_field(line, last));
  return fields;
}

}  // namespace

CsvTable::CsvTable(std::string_view text, std::string name, std::initializer_list<std::string_view> required)
    : name_(std::move(name)) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  while (!text.empty()) {
    const auto end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.empty() || line.front() == '#') continue;
    std::vector<std::string> fields = split(line);
    if (header_.empty()) {
      header_ = std::move(fields);
      continue;
    }
    ++rows_;
    if (fields.size() != header_.size())
      fail(name_, fmt::format("data line {} has {} fields, the header {}", rows_ + 1, fields.size(), header_.size()));
    std::move(fields.begin(), fields.end(), std::back_inserter(fields_));
  }
  if (header_.empty()) fail(name_, "empty; a header line is needed");
  for (const std::string_view column : required)
    if (!has(column))
      fail(name_, fmt::format("header lacks the column {} (found: {})", column, fmt::join(header_, ", ")));
  for (std::size_t i = 0; i < header_.size(); ++i)
    if (find(header_[i]) != i) fail(name_, fmt::format("column {} appears twice", header_[i]));
}

std::size_t CsvTable::find(std::string_view column) const {
  return static_cast<std::size_t>(std::find(header_.begin(), header_.end(), column) - header_.begin());
}

bool CsvTable::is_numeric(std::string_view column) const {
  const std::size_t c = find(column);
  double ignored = 0;
  for (std::size_t row = 0; row < rows_; ++row)
    if (!field(row, c).empty() && !parse_number(field(row, c), ignored)) return false;
  return true;
}

std::vector<double> CsvTable::numbers(std::string_view column) const {
  const std::size_t c = find(column);
  std::vector<double> values(rows_, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t row = 0; row < rows_; ++row)
    if (!field(row, c).empty() && !parse_number(field(row, c), values[row]))
      fail(name_, fmt::format("column {}: '{}' is not a number", column, field(row, c)));
  return values;
}

std::vector<std::string> CsvTable::texts(std::string_view column) const {
  const std::size_t c = find(column);
  std::vector<std::string> values(rows_);
  for (std::size_t row = 0; row < rows_; ++row) values[row] = field(row, c);
  return values;
}

}  // namespace accrete::cli
