#include "cli/info.h"

#include <fmt/format.h>

#include "cli/run/input.h"

namespace accrete::cli {
namespace {

std::string size_of(const std::optional<Segments>& segments) {
  return segments ? fmt::format("{} segments", segments->list.size()) : "none";
}

}  // namespace

ExitStatus info_command(const RunOptions& given) {
  RunOptions options = given;
  options.input.require_poses = false;
  const Input input = open_input(options);
  for (const std::string& line : describe(input)) fmt::print("{}\n", line);
  const Truth truth = truth_of(input, options);
  if (truth.edges || truth.bbox)
    fmt::print("{:13}edges {}, extra {}, background {}, region {}, bounding box {}, faces {}\n", "truth",
               size_of(truth.edges), size_of(truth.extra), size_of(truth.background), truth.region ? "yes" : "no",
               truth.bbox ? "yes" : "no", truth.faces.size());
  std::fflush(stdout);
  for (const std::string& warning : input.warnings) fmt::print(stderr, "warning: {}\n", warning);
  return ExitStatus::kOk;
}

}  // namespace accrete::cli
