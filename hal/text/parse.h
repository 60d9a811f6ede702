// Rows and numbers of text files. Independent of the locale; time is never a double.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace accrete::hal {

[[nodiscard]] std::string_view trimmed(std::string_view text);  // blanks, tabs and carriage returns on both sides

// A row that says something: not empty, no comment.
struct Row {
  static constexpr std::size_t kMaxLength = 4096;  // longer: no table of poses or stamps, and not looked at further
  static constexpr std::size_t kMaxFields = 32;

  std::size_t line = 0;  // from 1
  std::array<std::string_view, kMaxFields> fields{};
  std::size_t field_count = 0;  // kMaxFields + 1: more than that, or longer than kMaxLength
  bool comma_separated = false;
};

// Walks over the rows of a text; skips blank ones and those that begin with '#'. Accepts \n and \r\n, and a last line
// without either. Fields are separated by commas where the row has one, by blanks and tabs elsewhere.
class RowReader {
 public:
  explicit RowReader(std::string_view text) : rest_(text) {}
  [[nodiscard]] bool next(Row& row);
  // Nothing comes after the row that next() gave.
  [[nodiscard]] bool at_end() const { return rest_.empty(); }

 private:
  std::string_view rest_;
  std::size_t line_ = 0;
};

// The whole of `text` as a number; a leading '+' is fine. "nan" and "inf" are numbers here: the caller refuses them.
[[nodiscard]] bool parse(std::string_view text, double& value);
[[nodiscard]] bool parse(std::string_view text, std::int64_t& value);

// The year 2096 since 1970; the difference of any two such stamps fits 64 bits.
inline constexpr std::int64_t kMaxStamp_ns = 4'000'000'000'000'000'000;
[[nodiscard]] constexpr bool is_stamp(std::int64_t ns) { return ns <= kMaxStamp_ns && ns >= -kMaxStamp_ns; }

// A decimal number cut exactly into whole and billionths, rounded there: seconds into nanoseconds without a double.
struct Decimal {
  std::int64_t whole = 0;      // towards zero
  std::int32_t billionth = 0;  // of the same sign

  [[nodiscard]] bool fits_ns() const {
    return whole < kMaxStamp_ns / 1'000'000'000 && whole > -kMaxStamp_ns / 1'000'000'000;
  }
  // Precondition: fits_ns().
  [[nodiscard]] std::int64_t ns() const { return whole * 1'000'000'000 + billionth; }
};

// False for what is no finite decimal number, or not below 9e18 in magnitude.
[[nodiscard]] bool parse(std::string_view text, Decimal& value);

}  // namespace accrete::hal
