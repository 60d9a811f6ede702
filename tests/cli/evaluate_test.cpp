// accrete evaluate from outside: its figures are those of the file that it writes, whoever computes them.
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/child.h"
#include "cli/evaluate/markdown_page.h"
#include "cli/evaluate/model_hash.h"
#include "cli/evaluate/selftest.h"
#include "cli/evaluate/tables.h"
#include "cli/text/file.h"
#include "support/data_folder.h"
#include "support/temp_folder.h"

namespace accrete::cli {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

TEST(evaluate, scores_a_run_and_the_file_that_it_wrote_alike) {
  const test::TempFolder folder;
  const std::vector<std::string> scene{"synthetic:box-plain", "--frames", "0:11"};
  const Ended e = run_program(
      folder.path(), {"evaluate", scene[0], scene[1], scene[2], "--json", "--out", "out", "--markdown", "t.md"});
  ASSERT_EQ(e.status, 0) << e.err;
  const json r = json::parse(e.out);
  EXPECT_GT(r["score"]["counts"]["judged"], 50);
  EXPECT_GT(r["score"]["precision"], 0.9);
  EXPECT_GT(r["birth"]["n"], 50);
  EXPECT_GT(r["birth"]["median_at_birth_mm"], r["birth"]["median_at_end_mm"]);
  EXPECT_LT(r["background_at_birth"]["background_rate"], 0.02);
  ASSERT_GE(r["curve"].size(), 5U);
  EXPECT_LE(r["curve"].front()["frames"], 3);
  EXPECT_EQ(r["curve"].back()["frames"], 12);
  EXPECT_EQ(r["curve"].back()["median_mm"], r["score"]["distance_mm"]["median"]);
  EXPECT_GT(r["timing_ms"]["step"]["p50"], 0);

  const Ended again =
      run_program(folder.path(), {"evaluate", scene[0], scene[1], scene[2], "--json", "--edges", "out/edges.csv"});
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(json::parse(again.out)["score"], r["score"]);

  const std::string markdown = read_text_file(folder / "t.md");
  EXPECT_EQ(markdown.rfind("# Evaluation\n", 0), 0U);
  EXPECT_NE(markdown.find("\n## box-plain\n"), std::string::npos);
  EXPECT_NE(markdown.find("\n### Against the truth\n"), std::string::npos);
  EXPECT_NE(markdown.find("| extract |"), std::string::npos);
}

TEST(evaluate, compares_the_model_with_frames_that_it_has_not_seen) {
  const test::TempFolder folder;
  const Ended e =
      run_program(folder.path(), {"evaluate", "synthetic:box-plain", "--frames", "0:19", "--hold-out", "5", "--json"});
  ASSERT_EQ(e.status, 0) << e.err;
  const json r = json::parse(e.out);
  EXPECT_EQ(r["frames"]["held_out"], 4);
  EXPECT_EQ(r["frames"]["used"], 16);
  const json& h = r["hold_out"];
  EXPECT_EQ(h["frames"], 4);
  EXPECT_EQ(h["per_frame"][0]["frame"], 4);
  EXPECT_GT(h["predicted_visible"], 100);
  EXPECT_GT(h["found_rate"], 0.6);
  EXPECT_GT(h["explained_rate"], 0.1);
}

TEST(evaluate, real_recording_agrees_with_the_reference_scorer) {
  ACCRETE_RECORDING_OR_SKIP(recording, "chessboard");
  const char* shared = std::getenv("ACCRETE_SHARED");
  const std::filesystem::path scorer =
      std::filesystem::path(shared != nullptr ? shared : ACCRETE_DEFAULT_SHARED) / "score_edges.py";
  if (!std::filesystem::exists(scorer) || std::system("/usr/bin/python3 -c 'import numpy' 2>/dev/null") != 0)
    GTEST_SKIP() << scorer << " or numpy is not there: set ACCRETE_SHARED";
  const test::TempFolder folder;
  const Ended e = run_program(folder.path(), {"evaluate", recording.string(), "--json", "--out", "out"});
  ASSERT_EQ(e.status, 0) << e.err;
  const std::string truth = (recording / "truth/").string();
  const std::string command = "/usr/bin/python3 " + scorer.string() + " --edges " +
                              (folder / "out/edges.csv").string() + " --truth " + truth + "edges.csv --extra " + truth +
                              "extra.csv --region " + truth + "region.txt --bbox " + truth + "bbox.txt --faces " +
                              truth + "faces.csv --json " + (folder / "theirs.json").string() + " > /dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const json ours = json::parse(e.out)["score"], theirs = json::parse(read_text_file(folder / "theirs.json"));
  for (const char* path :
       {"/counts/judged", "/precision", "/distance_mm/median", "/distance_mm/p95", "/tangent_deg/median",
        "/completeness", "/leakage/outside_bbox", "/surface/within_tol_rate", "/colour/side_assignment_correct",
        "/phase/median_deviation_rad", "/nees/within_tol/mean", "/existence/ece"}) {
    const json::json_pointer at(path);
    ASSERT_TRUE(ours.contains(at) && theirs.contains(at)) << path;
    EXPECT_NEAR(ours.at(at).get<double>(), theirs.at(at).get<double>(), 1e-6) << path;
  }
}

TEST(selftest, a_figure_that_is_absent_or_out_of_its_limits_is_missed) {
  const std::vector<Check> none = selftest_checks(ordered_json::object());
  for (const Check& check : none) EXPECT_FALSE(check.passed()) << check.figure;
  ordered_json good;
  good["primitives"]["used"] = 400;
  EXPECT_TRUE(selftest_checks(good)[0].passed());
  good["primitives"]["used"] = 4;
  EXPECT_FALSE(selftest_checks(good)[0].passed());
}

TEST(selftest, the_bits_of_a_model_change_with_each_of_its_fields) {
  const auto hash = [](const std::function<void(Primitive3d&)>& change) {
    Primitive3d p;
    change(p);
    return model_hash({&p, 1});
  };
  const std::vector<std::function<void(Primitive3d&)>> changes{[](auto&) {},
                                                               [](auto& p) { p.id.index1 = 1; },
                                                               [](auto& p) { p.id.generation = 1; },
                                                               [](auto& p) { p.state = State::kConfirmed; },
                                                               [](auto& p) { p.existence = 0x1p-149F; },
                                                               [](auto& p) { p.geometry.position[2] = -0.0F; },
                                                               [](auto& p) { p.geometry.quaternion[0] = 1; },
                                                               [](auto& p) { p.geometry.covariance[20] = 1; },
                                                               [](auto& p) { p.tangent[1] = 1; },
                                                               [](auto& p) { p.appearance.mean.phase = 1; },
                                                               [](auto& p) { p.appearance.mean.left[0] = 1; },
                                                               [](auto& p) { p.appearance.mean.right[0] = 1; },
                                                               [](auto& p) { p.appearance.covariance[27] = 1; },
                                                               [](auto& p) { p.observations = 1; },
                                                               [](auto& p) { p.misfit = 1; },
                                                               [](auto& p) { p.first_frame = 1; },
                                                               [](auto& p) { p.last_frame = 1; },
                                                               [](auto& p) { p.seen.hits[41] = 1; },
                                                               [](auto& p) { p.seen.visits[0] = 1; }};
  std::set<std::uint64_t> different;
  for (const auto& change : changes) different.insert(hash(change));
  EXPECT_EQ(different.size(), changes.size());
}

TEST(markdown_page, replaces_a_section_and_keeps_the_others) {
  const std::string first = with_section("", "a", "one\n");
  EXPECT_EQ(first.rfind("# Evaluation\n\n", 0), 0U);
  const std::string head = first.substr(0, first.find("## a"));
  EXPECT_EQ(with_section(with_section(first, "b", "two\n"), "a", "three\n"), head + "## a\n\nthree\n\n## b\n\ntwo\n");
  EXPECT_EQ(with_section(with_section(first, "b", "two\n"), "b", "four\n"), head + "## a\n\none\n\n## b\n\nfour\n");
  EXPECT_EQ(with_section("by hand", "a", "one\n"), "by hand\n\n## a\n\none\n");
}

TEST(tables, align_figures_and_escape_bars) {
  const std::vector<Table> tables{{"T", {"name", "n"}, {{"a|b", "7"}, {"c", "123"}}, "note"}};
  EXPECT_EQ(to_text(tables), "\nT\n  name    n\n  a|b     7\n  c     123\n  note\n");
  EXPECT_EQ(to_markdown(tables), "\n### T\n\n| name | n |\n|---|---:|\n| a\\|b | 7 |\n| c | 123 |\n\nnote\n");
}

}  // namespace
}  // namespace accrete::cli
