// accrete bench: a table with a column for every instruction set that runs here, and the same as JSON.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "accrete/instruction_set.h"
#include "cli/bench/rows.h"
#include "cli/bench/timing.h"
#include "cli/child.h"
#include "support/temp_folder.h"

namespace accrete::cli {
namespace {

using nlohmann::json;

std::vector<std::string> available_sets() {
  std::vector<std::string> out;
  for (const InstructionSet set : {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512})
    if (is_available(set)) out.emplace_back(name(set));
  return out;
}

TEST(Bench, prints_a_row_for_every_kernel_and_a_column_for_every_instruction_set) {
  const test::TempFolder folder;
  const Ended e = run_program(folder.path(), {"bench", "--primitives", "37", "--repetitions", "1"});
  EXPECT_EQ(e.status, 0) << e.err;
  for (const std::string& set : available_sets()) EXPECT_NE(e.out.find(set + " x"), std::string::npos) << e.out;
  for (const BenchRow& row : bench_rows()) EXPECT_NE(e.out.find(row.name), std::string::npos) << e.out;
}

TEST(Bench, json_has_every_row_of_every_set) {
  const test::TempFolder folder;
  const Ended e = run_program(folder.path(), {"bench", "--primitives", "16", "--repetitions", "1", "--json"});
  EXPECT_EQ(e.status, 0) << e.err;
  const json result = json::parse(e.out);
  EXPECT_EQ(result["primitives"], 16);
  EXPECT_EQ(result["taken"], name(InstructionSet::kBest));
  std::set<std::pair<std::string, std::string>> found;
  for (const json& row : result["rows"]) {
    EXPECT_GT(row["median_ns"].get<double>(), 0);
    EXPECT_LE(row["least_ns"].get<double>(), row["median_ns"].get<double>());
    found.emplace(row["row"], row["instruction_set"]);
  }
  EXPECT_EQ(found.size(), bench_rows().size() * available_sets().size());
}

// What is timed is the filter at work: every primitive is updated in every frame, and comes to know its place better.
TEST(Bench, the_pool_is_work_like_any_other) {
  BenchPool pool(100);
  const auto variance = [&](std::size_t i) { return load(pool.geometry[i / 16], i % 16).covariance[0]; };
  const float born = variance(99);
  const Kernels& k = kernels(InstructionSet::kBest);
  for (const BenchRow& row : bench_rows()) {
    pool.restore();
    ASSERT_EQ(variance(99), born);
    std::fill(pool.outcomes.begin(), pool.outcomes.end(), UpdateOutcome::kBehind);
    row.run(k, pool, BenchPool::kFrames);
    if (std::string(row.key).starts_with("predict") || std::string(row.key) == "motion_noise") continue;
    if (std::string(row.key).starts_with("gate")) {
      // A pair whose gate is closed says so, and most observations lie inside their own.
      const auto open = std::count_if(pool.pairs.log_likelihood.begin(), pool.pairs.log_likelihood.begin() + 36,
                                      [](float l) { return std::isfinite(l); });
      EXPECT_EQ(pool.pairs.count, 36U);  // the rest of 100
      EXPECT_GT(open, 30) << row.key;
      continue;
    }
    for (const UpdateOutcome o : pool.outcomes) EXPECT_EQ(o, UpdateOutcome::kUpdated) << row.key;
    if (std::string(row.key).starts_with("update_stereo")) {
      EXPECT_LT(variance(99), born);
    }
  }
}

TEST(Timing, takes_the_least_median_per_item) {
  int prepared = 0, ran = 0;
  std::vector<Contender> c{{"spin", [&] { ++prepared; },
                            [&] {
                              ++ran;
                              const double end = thread_seconds() + 1e-3;
                              while (thread_seconds() < end) {
                              }
                            },
                            1000}};
  time_all(c, 2);
  EXPECT_EQ(ran, 20);  // five rounds of two, each with a run before that is not timed
  EXPECT_EQ(prepared, ran);
  EXPECT_GE(c[0].least_ns, 1000);
  EXPECT_LE(c[0].least_ns, c[0].median_ns);
}

}  // namespace
}  // namespace accrete::cli
