#include "cli/evaluate/holdout_plan.h"

#include <fmt/format.h>

#include <map>
#include <sstream>

#include "cli/failure.h"

namespace accrete::cli {
namespace {

struct Sources {
  std::string left, right;
};

std::map<std::uint64_t, Sources> parse_sources(const std::string& text, const std::string& name) {
  std::map<std::uint64_t, Sources> out;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream fields(line);
    std::string first;
    if (!(fields >> first) || first.front() == '#') continue;
    std::istringstream as_number(first);
    std::uint64_t frame = 0;
    Sources sources;
    if (!(as_number >> frame) || !as_number.eof() || !(fields >> sources.left >> sources.right))
      throw Failure(
          ExitStatus::kInput,
          fmt::format("{}:{}: needs the number of a frame and the names of its two source images", name, number));
    out[frame] = sources;
  }
  return out;
}

}  // namespace

HoldOutPlan plan_hold_out(int every, std::uint64_t frames, const std::string& sources, const std::string& name) {
  HoldOutPlan plan;
  plan.every = every;
  if (every <= 0) return plan;
  const auto step = static_cast<std::uint64_t>(every);
  for (std::uint64_t frame = step - 1; frame < frames; frame += step) plan.held.insert(frame);
  const std::map<std::uint64_t, Sources> all = parse_sources(sources, name);
  std::set<std::string> photographs;
  for (const std::uint64_t frame : plan.held)
    if (const auto it = all.find(frame); it != all.end()) photographs.insert(it->second.left);
  for (const auto& [frame, s] : all)
    if (!plan.held.contains(frame) && (photographs.contains(s.left) || photographs.contains(s.right)))
      plan.shared.insert(frame);
  return plan;
}

}  // namespace accrete::cli
