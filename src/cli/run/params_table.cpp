#include "cli/run/params_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <type_traits>
#include <vector>

#include "cli/failure.h"
#include "cli/text/number.h"

namespace accrete::cli {

void set_param(Params& params, const std::string& assignment) {
  const auto equals = assignment.find('=');
  const std::string key(trimmed(assignment.substr(0, equals)));
  const std::string text = equals == std::string::npos ? "" : assignment.substr(equals + 1);
  std::vector<std::string> known;
  bool found = false, number = false;
  for_each_param(params, [&](const char* stage, const char* name, auto& member) {
    known.push_back(fmt::format("{}.{}", stage, name));
    if (known.back() != key) return;
    found = true;
    using Member = std::remove_reference_t<decltype(member)>;
    if constexpr (std::is_integral_v<Member>) {
      long long value = 0;
      number = parse_number(text, value) && value >= -1'000'000 && value <= 1'000'000;
      if (number) member = static_cast<Member>(value);
    } else {
      double value = 0;
      number = parse_number(text, value);
      if (number) member = static_cast<Member>(value);
    }
  });
  if (!found)
    throw Failure(ExitStatus::kUsage,
                  fmt::format("--set {}: there is no such tunable; there are {}", assignment, fmt::join(known, ", ")));
  if (!number) throw Failure(ExitStatus::kUsage, fmt::format("--set {}: needs STAGE.NAME=NUMBER", assignment));
}

}  // namespace accrete::cli
