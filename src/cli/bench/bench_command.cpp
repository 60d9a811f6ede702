#include "cli/bench/bench_command.h"

#include <fmt/format.h>

#include "accrete/version.h"
#include "cli/bench/processor.h"
#include "cli/bench/rows.h"
#include "cli/bench/timing.h"
#include "cli/text/json_text.h"
#include "cli/text/print.h"

namespace accrete::cli {
namespace {

using nlohmann::ordered_json;

std::vector<const Kernels*> available_kernels() {
  std::vector<const Kernels*> out;
  for (const InstructionSet set : {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512})
    if (is_available(set)) out.push_back(&kernels(set));
  return out;
}

}  // namespace

ExitStatus bench_command(const BenchOptions& options) {
  const auto n = static_cast<std::size_t>(options.primitives);
  const std::size_t frames = bench_frames(n);
  const std::vector<const Kernels*> sets = available_kernels();
  BenchPool pool(n);
  std::vector<Contender> contenders;
  for (const BenchRow& row : bench_rows())
    for (const Kernels* k : sets)
      contenders.push_back({row.key, [&pool] { pool.restore(); },
                            [&row, &pool, k, frames] { row.run(*k, pool, frames); }, static_cast<double>(n * frames)});
  time_all(contenders, options.repetitions);

  ordered_json rows = ordered_json::array();
  std::string table = fmt::format("{:44}", "ns per primitive");
  for (const Kernels* k : sets) table += fmt::format("{:>9} x{:<2}", k->name, k->lanes);
  std::size_t at = 0;
  for (const BenchRow& row : bench_rows()) {
    table += fmt::format("\n{:44}", row.name);
    for (const Kernels* k : sets) {
      const Contender& c = contenders[at++];
      table += fmt::format("{:>9.1f}   ", c.median_ns);
      rows.push_back({{"row", row.key},
                      {"instruction_set", k->name},
                      {"lanes", k->lanes},
                      {"median_ns", c.median_ns},
                      {"least_ns", c.least_ns}});
    }
  }
  const char* taken = name(InstructionSet::kBest);
  if (options.json) {
    print("{}", json_text({{"version", kVersion},
                           {"processor", processor_name()},
                           {"primitives", n},
                           {"taken", taken},
                           {"rows", rows}}));
  } else {
    print("{}\n{} primitives, one thread; the least of five medians. accrete run takes {} here.\n\n{}\n",
          processor_name(), n, taken, table);
  }
  return ExitStatus::kOk;
}

}  // namespace accrete::cli
