// Flags with units, tunables by name, the tree of the configuration.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <set>

#include "cli/failure.h"
#include "cli/run/configuration.h"
#include "cli/run/counters.h"
#include "cli/run/params_table.h"
#include "cli/run/units.h"
#include "cli/text/json_text.h"

namespace accrete::cli {
namespace {

TEST(units, depth_ranges_are_metres_unless_they_say_otherwise) {
  EXPECT_DOUBLE_EQ(parse_depth_range("0.4:0.9").min_m, 0.4);
  EXPECT_DOUBLE_EQ(parse_depth_range("0.4:0.9").max_m, 0.9);
  EXPECT_DOUBLE_EQ(parse_depth_range("400mm : 2 m").min_m, 0.4);
  EXPECT_DOUBLE_EQ(parse_depth_range("400mm:2m").max_m, 2);
  EXPECT_DOUBLE_EQ(parse_depth_range("0.4:").max_m, 0);
  EXPECT_DOUBLE_EQ(parse_depth_range(":9").min_m, 0);
  for (const char* bad : {"", ":", "1", "1:2:3", "2:1", "1:1", "-1:2", "1:2ft", "nan:1", "1:inf", "a:b", "1 m 2:3"})
    EXPECT_THROW((void)parse_depth_range(bad), Failure) << bad;
}

TEST(units, pose_sigmas_need_both_units) {
  const PoseSigma s = parse_pose_sigma("--pose-sigma", "0.3mm:0.06deg");
  EXPECT_DOUBLE_EQ(s.sigma_m, 0.3e-3);
  EXPECT_DOUBLE_EQ(s.sigma_rad, 0.06 * std::numbers::pi / 180);
  EXPECT_DOUBLE_EQ(parse_pose_sigma("--pose-sigma", "1e-3m:1mrad").sigma_m, 1e-3);
  for (const char* bad : {"0.3:1", "0.3mm", "0.3mm:1", "0.3mm:1mm", "1mrad:0.3mm", "-1mm:1mrad", "mm:mrad", "infm:1rad",
                          "0mm:1mrad", "1mm:0mrad"})
    EXPECT_THROW((void)parse_pose_sigma("--pose-sigma", bad), Failure) << bad;
}

TEST(units, frame_ranges_include_both_ends) {
  const FrameRange r = parse_frame_range("12:50");
  EXPECT_TRUE(r.contains(12) && r.contains(50) && !r.contains(11) && !r.contains(51));
  EXPECT_TRUE(parse_frame_range("12:").contains(1'000'000));
  EXPECT_TRUE(parse_frame_range(":3").contains(0));
  for (const char* bad : {"", ":", "5", "5:4", "-1:4", "1.5:2", "a:", "99999999999999999999:"})
    EXPECT_THROW((void)parse_frame_range(bad), Failure) << bad;
}

TEST(units, durations_need_a_unit) {
  EXPECT_EQ(parse_duration_ns("--max-pose-gap", "50ms"), 50'000'000);
  EXPECT_EQ(parse_duration_ns("--max-pose-gap", "0.2 s"), 200'000'000);
  for (const char* bad : {"50", "-1ms", "ms", "1e9s", "1h"})
    EXPECT_THROW((void)parse_duration_ns("--max-pose-gap", bad), Failure) << bad;
}

TEST(units, boxes_are_six_numbers_in_order) {
  const ExcludedBox b = parse_excluded_box("-1,-2,-3, 1,2,3");
  EXPECT_EQ(b.min_m, (std::array<float, 3>{-1, -2, -3}));
  EXPECT_EQ(b.max_m, (std::array<float, 3>{1, 2, 3}));
  for (const char* bad : {"", "1,2,3", "0,0,0,1,1,1,1", "0,0,0,1,0,1", "a,0,0,1,1,1", "0,0,0,1,1,inf", "0 0 0 1 1 1"})
    EXPECT_THROW((void)parse_excluded_box(bad), Failure) << bad;
}

TEST(params_table, names_every_tunable_of_params_h) {
  const Params p;
  std::set<std::string> names;
  std::size_t bytes = 0;
  for_each_param(p, [&](const char* stage, const char* name, const auto& member) {
    names.insert(std::string(stage) + "." + name);
    bytes += sizeof member;
  });
  // The four structs consist of nothing else, without padding: a member that is added must be named.
  EXPECT_EQ(bytes, sizeof p.extract + sizeof p.stereo + sizeof p.filter + sizeof p.existence);
  EXPECT_EQ(names.size(), bytes / 4);
}

TEST(params_table, sets_a_tunable_by_its_name) {
  Params p;
  set_param(p, "stereo.min_psi=0.5");
  set_param(p, "stereo.max_rivals = 2");
  EXPECT_FLOAT_EQ(p.stereo.min_psi, 0.5F);
  EXPECT_EQ(p.stereo.max_rivals, 2);
  for (const char* bad : {"", "stereo.min_psi", "min_psi=1", "stereo.min_psi=", "stereo.max_rivals=1.5", "x=y=z"})
    EXPECT_THROW(set_param(p, bad), Failure) << bad;
}

TEST(counters, name_every_counter_of_the_step_report) {
  StepReport report;
  std::set<std::string> names;
  std::size_t counters = 0;
  const auto visit = [&](const char* name, std::uint32_t) {
    names.insert(name);
    ++counters;
  };
  for_each_counter(report, visit);
  for_each_level(report, visit);
  EXPECT_EQ(names.size(), counters);
  // Everything behind status, frame and motion_covariance_is_default (three words) is a counter of four bytes.
  EXPECT_EQ(counters, (sizeof report - 3 * sizeof(std::uint32_t)) / sizeof(std::uint32_t));
}

TEST(json_text, keeps_plain_arrays_on_one_line_and_reads_back) {
  const nlohmann::ordered_json tree{{"a\"b", {{"n", {1, 2.5, nullptr}}, {"none", nlohmann::ordered_json::array()}}},
                                    {"rows", {{{"x", 1}}, {{"x", "y\n"}}}}};
  const std::string text = json_text(tree);
  EXPECT_EQ(text,
            "{\n \"a\\\"b\": {\n  \"n\": [1, 2.5, null],\n  \"none\": []\n },\n \"rows\": [\n  {\n   \"x\": 1\n  },\n"
            "  {\n   \"x\": \"y\\n\"\n  }\n ]\n}\n");
  EXPECT_EQ(nlohmann::ordered_json::parse(text), tree);
}

TEST(json_text, file_names_that_are_no_utf8_do_no_harm) {
  const nlohmann::ordered_json tree{{"name", "caf\xE9"}};
  EXPECT_EQ(json_text(tree), "{\n \"name\": \"caf\xEF\xBF\xBD\"\n}\n");
  EXPECT_EQ(to_yaml(tree), "name: \"caf\xEF\xBF\xBD\"\n");
}

TEST(yaml, writes_trees_that_json_strings_cannot_break) {
  const nlohmann::ordered_json tree{{"a", {{"b", 0.1}, {"c", "say \"x\": y\n"}, {"none", nullptr}}},
                                    {"list", {{1, 2}, {0.5, true}}},
                                    {"empty", nlohmann::ordered_json::object()}};
  EXPECT_EQ(to_yaml(tree),
            "a:\n  b: 0.1\n  c: \"say \\\"x\\\": y\\n\"\n  none: null\nlist: [[1, 2], [0.5, true]]\nempty: {}\n");
}

}  // namespace
}  // namespace accrete::cli
