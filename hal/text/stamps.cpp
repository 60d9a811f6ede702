#include "text/stamps.h"

#include <algorithm>

#include "text/sentence.h"

namespace accrete::hal {

Outcome StampColumn::add(const std::filesystem::path& path, const Row& row, std::size_t field) {
  Decimal value;
  if (!parse(row.fields[field], value))
    return {Status::kInvalidArgument, at_line(path, row.line) + ": the time " + in_quotes(row.fields[field]) +
                                          " is no finite number: write seconds"};
  values.push_back(value);
  lines.push_back(row.line);
  return {};
}

Outcome StampColumn::convert(const std::filesystem::path& path, std::vector<Timestamp>& stamps,
                             std::vector<std::string>& notices) const {
  constexpr std::int64_t kSurelyNanoseconds = 1'000'000'000'000;
  const bool nanoseconds =
      std::any_of(values.begin(), values.end(), [](const Decimal& d) { return d.whole > kSurelyNanoseconds; });
  if (nanoseconds) notices.push_back(path.string() + ": times above 1e12 are taken for nanoseconds, not seconds");
  stamps.clear();
  stamps.reserve(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (nanoseconds ? !is_stamp(values[i].whole) : !values[i].fits_ns())
      return {Status::kInvalidArgument,
              at_line(path, lines[i]) + ": the time is beyond 126 years: write seconds, or nanoseconds"};
    stamps.push_back({nanoseconds ? values[i].whole : values[i].ns()});
  }
  return {};
}

}  // namespace accrete::hal
