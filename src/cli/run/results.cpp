#include "cli/run/results.h"

#include "cli/run/configuration.h"
#include "cli/text/json_text.h"
#include "cli/write/edges_csv.h"
#include "cli/write/ply.h"

namespace accrete::cli {

void write_results(const ResultFolder& folder, const RunOptions& options, MotionMode mode,
                   std::span<const Primitive3d> primitives, std::span<const Primitive3d> exported,
                   const nlohmann::ordered_json& summary) {
  folder.write("edges.csv", edges_csv(primitives, options.full_covariance, encoding_of(options.params)));
  folder.write("edges.ply", edges_ply(exported, mode));
  folder.write("lines.ply", lines_ply(exported, mode));
  folder.write("ribbons.ply", ribbons_ply(exported, mode));
  folder.write("config.yaml", to_yaml(summary["configuration"]));
  folder.write("summary.json", json_text(summary));
}

Params effective_params(const RunOptions& options, const Input& input) {
  Params params = options.params;
  if (options.excluded_given) return params;
  for (const ExcludedBox& box : input.own_gripper)
    if (params.excluded_count < kMaxExcludedBoxes)
      params.excluded[static_cast<std::size_t>(params.excluded_count++)] = box;
  return params;
}

}  // namespace accrete::cli
