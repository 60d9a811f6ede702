// A comma-separated file with a header line, by columns: truth files and edges.csv.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace accrete::cli {

class CsvTable {
 public:
  // Blank lines and lines that begin with # are skipped; CRLF, a byte order mark and blanks round fields are removed.
  // `name` stands for the file in messages. Throws Failure(kInput): no header line, a column of `required` missing, a
  // column twice, a line with another number of fields than the header.
  CsvTable(std::string_view text, std::string name, std::initializer_list<std::string_view> required);

  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] bool has(std::string_view column) const { return find(column) < header_.size(); }
  // Every field of the column is a number or empty.
  [[nodiscard]] bool is_numeric(std::string_view column) const;
  // An empty field is NaN. Throws Failure(kInput) when a field is no number. Precondition: has(column).
  [[nodiscard]] std::vector<double> numbers(std::string_view column) const;
  // Precondition: has(column).
  [[nodiscard]] std::vector<std::string> texts(std::string_view column) const;

 private:
  [[nodiscard]] std::size_t find(std::string_view column) const;
  [[nodiscard]] const std::string& field(std::size_t row, std::size_t column) const {
    return fields_[row * header_.size() + column];
  }

  std::string name_;
  std::vector<std::string> header_;
  std::vector<std::string> fields_;  // row after row
  std::size_t rows_ = 0;
};

}  // namespace accrete::cli
