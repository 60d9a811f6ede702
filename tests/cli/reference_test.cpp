// docs/reference says what the program does: every flag, every tunable, every column, every key.
#include <gtest/gtest.h>

#include <regex>
#include <set>

#include "cli/child.h"
#include "cli/damaged_images.h"
#include "cli/failure.h"
#include "cli/json_schema.h"
#include "cli/run/params_table.h"
#include "cli/text/file.h"
#include "cli/write/edges_csv.h"
#include "support/temp_folder.h"

namespace accrete::cli {
namespace {

using nlohmann::json;

std::string page(const char* name) {
  return read_text_file(std::filesystem::path(ACCRETE_SOURCE_FOLDER) / "docs/reference" / name);
}

std::set<std::string> matches(const std::string& text, const char* pattern) {
  const std::regex regex(pattern);
  std::set<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it) found.insert(it->str(1));
  return found;
}

TEST(program_md, has_every_flag_of_every_command_and_no_other) {
  const test::TempFolder folder;
  std::set<std::string> flags{"--version"};
  for (const char* command : {"run", "record", "info", "doctor", "evaluate", "selftest", "bench", "devices"}) {
    const auto here = matches(run_program(folder.path(), {command, "--help"}).out, "(--[a-z][a-z-]*)");
    flags.insert(here.begin(), here.end());
  }
  EXPECT_GT(flags.size(), 20U);
  EXPECT_EQ(matches(page("program.md"), "(--[a-z][a-z-]*)"), flags);
}

TEST(program_md, has_every_tunable) {
  const std::string text = page("program.md");
  std::size_t count = 0;
  const Params params;
  for_each_param(params, [&](const char* stage, const char* name, auto) {
    const std::string key = std::string(stage) + "." + name;
    EXPECT_NE(text.find("`" + key + "`"), std::string::npos) << key;
    ++count;
  });
  EXPECT_GT(count, 10U);
}

TEST(program_md, has_every_exit_status) {
  for (const ExitStatus status :
       {ExitStatus::kOk, ExitStatus::kNothing, ExitStatus::kUsage, ExitStatus::kPartial, ExitStatus::kInput,
        ExitStatus::kOutput, ExitStatus::kFault, ExitStatus::kInterrupted})
    EXPECT_NE(page("program.md").find("\n| " + std::to_string(static_cast<int>(status)) + " |"), std::string::npos);
}

TEST(results_md, has_every_column_of_edges_csv) {
  const std::string text = page("results.md");
  const std::string head = edges_csv({}, false, Encoding::kLinear);
  for (std::string column : matches(head, "([a-z_]+)")) {
    if (column.starts_with("sleft_") || column.starts_with("sright_")) column = "sleft_r..sright_b";
    EXPECT_TRUE(std::regex_search(text, std::regex("[`,]" + column + "[`,]"))) << column;
  }
}

TEST(summary_schema, describes_what_run_writes) {
  const test::TempFolder folder;
  ASSERT_EQ(run_program(folder.path(), {"run", "--frames", "0:7", "-q", "--out", "out"}).status, 0);
  const JsonSchema schema(json::parse(page("summary.schema.json")));
  const json summary = json::parse(read_text_file(folder / "out/summary.json"));
  for (const std::string& problem : schema.problems(summary)) ADD_FAILURE() << problem;

  const auto broken = [&](auto&& change) {
    json other = summary;
    change(other);
    return schema.problems(other).size();
  };
  EXPECT_EQ(broken([](json& s) { s["frames"]["used"] = -1; }), 1U);
  EXPECT_EQ(broken([](json& s) { s["frames"]["seen"] = "8"; }), 1U);
  EXPECT_EQ(broken([](json& s) { s["frames"].erase("used"); }), 1U);
  EXPECT_EQ(broken([](json& s) { s["new"] = 1; }), 1U);
  EXPECT_EQ(broken([](json& s) { s["per_frame"]["fate"][0] = "eaten"; }), 1U);
  EXPECT_EQ(broken([](json& s) { s["timing_ms"]["step"]["p50"] = nullptr; }), 0U);
}

TEST(summary_schema, describes_what_run_writes_when_no_frame_was_used) {
  const test::TempFolder folder;
  const std::string recording = recording_of_damaged_images(folder.path());
  EXPECT_EQ(run_program(folder.path(), {"run", recording, "-q", "--out", "out"}).status, 1);
  const json summary = json::parse(read_text_file(folder / "out/summary.json"));
  for (const std::string& problem : JsonSchema(json::parse(page("summary.schema.json"))).problems(summary))
    ADD_FAILURE() << problem;
}

}  // namespace
}  // namespace accrete::cli
