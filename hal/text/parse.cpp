#include "text/parse.h"

#include <charconv>

namespace accrete::hal {
namespace {

constexpr std::string_view kBlank = " \t\r\v\f";

// Of std::from_chars, which knows no '+'; "+-1" is no number.
std::string_view without_plus(std::string_view text) {
  return text.size() > 1 && text[0] == '+' && text[1] != '-' ? text.substr(1) : text;
}

template <class T>
bool from_whole(std::string_view text, T& value) {
  text = without_plus(text);
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  return end.ec == std::errc{} && end.ptr == text.data() + text.size() && !text.empty();
}

void split(std::string_view text, Row& row) {
  row.comma_separated = text.find(',') != std::string_view::npos;
  row.field_count = 0;
  while (true) {
    const std::size_t end = row.comma_separated ? text.find(',') : text.find_first_of(kBlank);
    if (row.field_count == Row::kMaxFields) {
      row.field_count = Row::kMaxFields + 1;
      return;
    }
    row.fields[row.field_count++] = trimmed(text.substr(0, end));
    if (end == std::string_view::npos) return;
    text = row.comma_separated ? text.substr(end + 1) : trimmed(text.substr(end));
  }
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

bool RowReader::next(Row& row) {
  while (!rest_.empty()) {
    const std::size_t end = rest_.find('\n');
    const std::string_view text = trimmed(rest_.substr(0, end));
    rest_ = end == std::string_view::npos ? std::string_view{} : rest_.substr(end + 1);
    ++line_;
    if (text.empty() || text[0] == '#') continue;
    row.line = line_;
    if (text.size() > Row::kMaxLength) {
      row.field_count = Row::kMaxFields + 1;
      row.fields[0] = text.substr(0, Row::kMaxLength);
    } else {
      split(text, row);
    }
    return true;
  }
  return false;
}

bool parse(std::string_view text, double& value) { return from_whole(text, value); }
bool parse(std::string_view text, std::int64_t& value) { return from_whole(text, value); }

bool parse(std::string_view text, Decimal& value) {
  text = without_plus(text);
  const bool negative = !text.empty() && text[0] == '-';
  if (negative) text.remove_prefix(1);
  std::int64_t exponent = 0;
  if (const std::size_t e = text.find_first_of("eE"); e != std::string_view::npos) {
    if (!parse(text.substr(e + 1), exponent) || exponent > 400 || exponent < -400) return false;
    text = text.substr(0, e);
  }
  const std::size_t dot = text.find('.');
  const std::string_view integer = text.substr(0, dot);
  const std::string_view fraction = dot == std::string_view::npos ? std::string_view{} : text.substr(dot + 1);
  if (integer.empty() && fraction.empty()) return false;
  for (const std::string_view part : {integer, fraction})
    if (part.find_first_not_of("0123456789") != std::string_view::npos) return false;

  // Digit number `i` counted from the decimal point after the exponent has moved it: 0 is the first after the point.
  const std::int64_t point = static_cast<std::int64_t>(integer.size()) + exponent;
  const std::int64_t digits = static_cast<std::int64_t>(integer.size() + fraction.size());
  const auto digit = [&](std::int64_t i) -> int {
    const std::int64_t k = point + i;
    if (k < 0 || k >= digits) return 0;
    const auto at = static_cast<std::size_t>(k);
    return (at < integer.size() ? integer[at] : fraction[at - integer.size()]) - '0';
  };
  std::int64_t whole = 0;
  for (std::int64_t i = -point; i < 0; ++i) {
    if (whole > 899'999'999'999'999'999) return false;
    whole = 10 * whole + digit(i);
  }
  std::int32_t billionth = 0;
  for (std::int64_t i = 0; i < 9; ++i) billionth = 10 * billionth + digit(i);
  if (digit(9) >= 5 && ++billionth == 1'000'000'000) {
    billionth = 0;
    ++whole;
  }
  value = negative ? Decimal{-whole, -billionth} : Decimal{whole, billionth};
  return true;
}

}  // namespace accrete::hal
