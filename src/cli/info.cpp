#include "cli/info.h"

#include <fmt/format.h>

#include "cli/run/input.h"
#include "cli/text/print.h"

namespace accrete::cli {
namespace {

std::string size_of(const std::optional<Segments>& segments) {
  return segments ? fmt::format("{} segments", segments->list.size()) : "none";
}

}  // namespace

ExitStatus info_command(const RunOptions& given) {
  RunOptions options = given;
  options.input.require_poses = !options.input.poses.empty();
  const Input input = open_input(options);
  for (const std::string& line : describe(input)) print("{}\n", line);
  const Truth truth = truth_of(input, options);
  if (truth.edges || truth.bbox)
    print("{:13}edges {}, extra {}, background {}, region {}, bounding box {}, faces {}\n", "truth",
          size_of(truth.edges), size_of(truth.extra), size_of(truth.background), truth.region ? "yes" : "no",
          truth.bbox ? "yes" : "no", truth.faces.size());
  flush_output();
  for (const std::string& warning : input.warnings) print_error("warning: {}\n", warning);
  return ExitStatus::kOk;
}

}  // namespace accrete::cli
