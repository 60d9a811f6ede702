// The program from outside: exit statuses, sentences, files, signals. Frames 0 .. 7 of the scene are enough to confirm.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/child.h"
#include "cli/damaged_images.h"
#include "cli/score/csv_table.h"
#include "cli/text/file.h"
#include "support/temp_folder.h"

namespace accrete::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kShort = "0:7";

const std::vector<std::string> kFiles{"config.yaml", "edges.csv",   "edges.ply",
                                      "lines.ply",   "ribbons.ply", "summary.json"};

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

json summary_of(const fs::path& folder) { return json::parse(read_text_file(folder / "summary.json")); }

std::size_t rows_of(const fs::path& folder) {
  return CsvTable(read_text_file(folder / "edges.csv"), "edges.csv", {"id"}).rows();
}

class Program : public ::testing::Test {
 protected:
  Ended run(const std::vector<std::string>& arguments) { return run_program(folder_.path(), arguments); }
  test::TempFolder folder_;
};

TEST_F(Program, without_a_recording_runs_the_synthetic_scene_and_writes_every_file) {
  const Ended e = run({"run", "--frames", kShort, "--out", "out", "--overlay", "4"});
  EXPECT_EQ(e.status, 0) << e.err;
  std::vector<std::string> expected = kFiles;
  expected.insert(expected.begin() + 3, "overlay");
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(names_in(folder_ / "out"), expected);
  EXPECT_EQ(names_in(folder_ / "out/overlay"),
            (std::vector<std::string>{"000000_matches.png", "000000_model.png", "000000_overview.png",
                                      "000000_primitives.png", "000004_matches.png", "000004_model.png",
                                      "000004_overview.png", "000004_primitives.png"}));
  EXPECT_NE(e.out.find("recording    box (synthetic scene)"), std::string::npos) << e.out;
  EXPECT_NE(e.out.find("guess"), std::string::npos) << e.out;
  EXPECT_NE(e.out.find("out/"), std::string::npos) << e.out;
  EXPECT_NE(e.err.find("confirmed"), std::string::npos) << "no progress lines: " << e.err;
  const json s = summary_of(folder_ / "out");
  EXPECT_EQ(s["frames"]["used"], 8);
  EXPECT_EQ(s["exit_status"], 0);
  EXPECT_GT(s["primitives"]["confirmed"], 20);
  EXPECT_EQ(rows_of(folder_ / "out"), s["primitives"]["confirmed"].get<std::size_t>() +
                                          s["primitives"]["preserved"].get<std::size_t>() +
                                          s["primitives"]["tentative"].get<std::size_t>());
}

TEST_F(Program, default_folder_is_linked_as_latest) {
  EXPECT_EQ(run({"run", "--frames", kShort, "-q"}).status, 0);
  EXPECT_EQ(names_in(folder_ / "results/latest"), kFiles);
  EXPECT_EQ(names_in(folder_ / "results").size(), 2U);
}

TEST_F(Program, two_runs_write_the_same_bytes_with_one_thread_and_with_two) {
  for (const char* threads : {"1", "2"}) {
    EXPECT_EQ(
        run({"run", "--frames", kShort, "-q", "--out", threads, "--full-covariance", "--threads", threads}).status, 0);
    EXPECT_EQ(summary_of(folder_ / threads)["threads"], threads[0] - '0');
  }
  for (const char* file : {"edges.csv", "edges.ply", "lines.ply", "ribbons.ply", "config.yaml"})
    EXPECT_EQ(read_text_file(folder_ / "1" / file), read_text_file(folder_ / "2" / file)) << file;
}

TEST_F(Program, json_is_all_that_standard_output_gets) {
  const Ended e = run({"run", "--frames", kShort, "--json", "--out", "out"});
  EXPECT_EQ(e.status, 0);
  EXPECT_EQ(json::parse(e.out), summary_of(folder_ / "out"));
}

TEST_F(Program, quiet_prints_nothing_but_warnings) {
  const Ended e = run({"run", "--frames", kShort, "--quiet", "--out", "out"});
  EXPECT_EQ(e.status, 0);
  EXPECT_EQ(e.out, "");
  for (std::size_t at = 0; at < e.err.size(); at = e.err.find('\n', at) + 1)
    EXPECT_EQ(e.err.compare(at, 9, "warning: "), 0) << e.err;
}

TEST_F(Program, nothing_accumulated_is_no_success) {
  const Ended e = run({"run", "--frames", "0:1", "--out", "out"});
  EXPECT_EQ(e.status, 1);
  EXPECT_NE(e.err.find("too few frames"), std::string::npos) << e.err;
  EXPECT_EQ(summary_of(folder_ / "out")["exit_status"], 1);  // results are written all the same
  const std::string recording = recording_of_damaged_images(folder_.path());
  const Ended none = run({"run", recording, "--out", "out"});
  EXPECT_EQ(none.status, 1);
  EXPECT_NE(none.err.find("no frame could be used"), std::string::npos) << none.err;
}

TEST_F(Program, an_interrupt_and_a_closed_terminal_finish_the_frame_and_write_complete_results) {
  for (const int signal : {SIGINT, SIGHUP}) {
    fs::remove_all(folder_ / "out");
    Child child(folder_.path(), {"run", "--scene-frames", "600", "--out", "out"}, [] { std::signal(SIGHUP, SIG_DFL); });
    ASSERT_TRUE(child.wait_for("frame   61 of 600"));
    child.signal(signal);
    const Ended e = child.wait();
    EXPECT_EQ(e.status, 130) << e.err;
    EXPECT_NE(e.err.find("interrupted"), std::string::npos) << e.err;
    EXPECT_EQ(names_in(folder_ / "out"), kFiles);
    const json s = summary_of(folder_ / "out");
    EXPECT_EQ(s["interrupted"], true);
    EXPECT_GE(s["frames"]["used"], 61);
    EXPECT_LT(s["frames"]["used"], 600);
    EXPECT_EQ(s["frames"]["used"], s["frames"]["seen"]);
    EXPECT_EQ(rows_of(folder_ / "out"), s["primitives"]["confirmed"].get<std::size_t>() +
                                            s["primitives"]["preserved"].get<std::size_t>() +
                                            s["primitives"]["tentative"].get<std::size_t>());
  }
}

TEST_F(Program, unwritable_output_is_refused_before_any_work) {
  folder_.write("file", "x");
  const Ended e = run({"run", "--out", "file/below"});
  EXPECT_EQ(e.status, 5);
  EXPECT_NE(e.err.find("file/below: cannot be written: Not a directory"), std::string::npos) << e.err;
  EXPECT_EQ(e.out, "");  // nothing was read or processed
}

TEST_F(Program, a_full_disk_at_the_end_is_said_and_leaves_no_half_file) {
  const Ended e = Child(folder_.path(), {"run", "--frames", kShort, "--out", "out"}, [] {
                    const rlimit limit{20000, 20000};  // edges.csv is larger
                    ::setrlimit(RLIMIT_FSIZE, &limit);
                  }).wait();
  EXPECT_EQ(e.status, 5) << e.err;
  EXPECT_NE(e.err.find("out/edges.csv: cannot be written"), std::string::npos) << e.err;
  EXPECT_TRUE(names_in(folder_ / "out").empty());
}

TEST_F(Program, a_closed_pipe_does_not_cost_the_results) {
  const Ended e = Child(folder_.path(), {"run", "--frames", kShort, "--out", "out"}, [] {
                    int ends[2];
                    if (::pipe(ends) == 0 && ::dup2(ends[1], 1) == 1) ::close(ends[0]);
                    ::close(ends[1]);
                  }).wait();
  EXPECT_LT(e.status, 1000) << "died of a signal";
  EXPECT_EQ(names_in(folder_ / "out"), kFiles);
}

struct Wrong {
  std::vector<std::string> arguments;
  int status;
  const char* says;
};
class WrongCommandLine : public ::testing::TestWithParam<Wrong> {};

TEST_P(WrongCommandLine, gets_a_sentence_and_its_status) {
  const test::TempFolder folder;
  const Ended e = run_program(folder.path(), GetParam().arguments);
  EXPECT_EQ(e.status, GetParam().status) << e.err;
  EXPECT_NE(e.err.find(GetParam().says), std::string::npos) << e.err;
  EXPECT_FALSE(fs::exists(folder / "results"));
}

INSTANTIATE_TEST_SUITE_P(
    all, WrongCommandLine,
    ::testing::Values(
        Wrong{{}, 2, "say what to do"}, Wrong{{"walk"}, 2, "no command 'walk'"},
        Wrong{{"run", "--bogus"}, 2, "--bogus"}, Wrong{{"run", "a", "b"}, 2, "not expected: b"},
        Wrong{{"run", "ftp:somewhere"}, 2, "synthetic:box"}, Wrong{{"run", "v4l2:0"}, 2, "name the right one, too"},
        Wrong{{"run", "synthetic:box", "--poses", "poses.txt"}, 2, "knows its own motion"},
        Wrong{{"run", "synthetic:moon"}, 2, "no synthetic scene 'moon'"}, Wrong{{"run", "nowhere"}, 4, "EuRoC"},
        Wrong{{"run", "/"}, 4, "left/"}, Wrong{{"run", "--motion", "both"}, 2, "both not in {object,camera}"},
        Wrong{{"run", "--pose-sigma", "0.3:1"}, 2, "with units"},
        Wrong{{"run", "--scene-pose-noise", "1"}, 2, "--scene-pose-noise 1: needs two"},
        Wrong{{"run", "--depth-range", "2:1"}, 2, "NEAR:FAR"}, Wrong{{"run", "--frames", "5:3"}, 2, "FIRST:LAST"},
        Wrong{{"run", "--max-pose-gap", "50"}, 2, "with its unit"},
        Wrong{{"run", "--exclude-box", "0,0,0,1,1"}, 2, "six numbers"},
        Wrong{{"run", "--pose-dir", "world_from_frame"}, 2, "--motion"},
        Wrong{{"run", "--pose-dir", "world_from_left", "--motion", "object"}, 2, "contradicts --motion"},
        Wrong{{"run", "--set", "stereo.speed=3"}, 2, "stereo.min_psi"},
        Wrong{{"run", "--set", "stereo.min_psi=fast"}, 2, "NUMBER"},
        Wrong{{"run", "--set", "stereo.min_psi=nan"}, 2, "--set stereo.min_psi=nan: out of its range"},
        Wrong{{"run", "--noise", "nan"}, 2, "--noise nan: out of its range"},
        Wrong{{"run", "--depth-range", "0.4:1e40"}, 2, "--depth-range 0.4:1e40: out of its range"},
        Wrong{{"run", "--frames", "60:70"}, 2, "the recording has 60 frames, 0 to 59"},
        Wrong{{"run", "--overlay", "0"}, 2, "--overlay"}, Wrong{{"run", "--min-existence", "2"}, 2, "--min-existence"},
        Wrong{{"evaluate", "--hold-out", "100"}, 2, "only 60 frames"},
        Wrong{{"evaluate", "--truth", "nowhere"}, 4, "--truth needs one"},
        Wrong{{"evaluate", "--edges", "nowhere.csv"}, 4, "nowhere.csv: cannot be read"},
        Wrong{{"selftest", "--scene-frames", "0"}, 2, "--scene-frames"},
        Wrong{{"bench", "--primitives", "0"}, 2, "--primitives"}));

TEST_F(Program, repeated_flags_do_not_swallow_the_recording) {
  const Ended e = run({"run", "--set", "stereo.min_psi=0.5", "--exclude-box", "-0.1,-0.1,-0.1,-0.05,0.1,0.1",
                       "synthetic:box-plain", "--frames", kShort, "-q", "--out", "out"});
  EXPECT_EQ(e.status, 0) << e.err;
  const json c = summary_of(folder_ / "out")["configuration"];
  EXPECT_EQ(c["input"]["recording"], "synthetic:box-plain");
  EXPECT_EQ(c["params"]["stereo"]["min_psi"], 0.5);
  EXPECT_EQ(c["params"]["excluded_boxes_m"].size(), 1U);
}

TEST_F(Program, help_and_version_succeed_and_show_examples) {
  for (const char* command : {"run", "record", "info", "evaluate", "selftest", "bench"}) {
    const Ended e = run({command, "--help"});
    EXPECT_EQ(e.status, 0);
    EXPECT_NE(e.out.find("Usage: accrete " + std::string(command)), std::string::npos) << e.out;
  }
  EXPECT_NE(run({"--help"}).out.find("Examples"), std::string::npos);
  EXPECT_EQ(run({"--version"}).out.substr(0, 8), "accrete ");
}

TEST_F(Program, info_computes_nothing) {
  const Ended e = run({"info"});
  EXPECT_EQ(e.status, 0);
  EXPECT_NE(e.out.find("baseline 120.00 mm"), std::string::npos) << e.out;
  EXPECT_NE(e.out.find("the object moves"), std::string::npos) << e.out;
  EXPECT_NE(e.out.find("truth"), std::string::npos) << e.out;
  EXPECT_FALSE(fs::exists(folder_ / "results"));
}

TEST_F(Program, selftest_is_passed_by_a_sound_build) {
  const Ended e = run({"selftest", "--json"});
  EXPECT_EQ(e.status, 0) << e.out;
  const json result = json::parse(e.out);
  EXPECT_EQ(result["passed"], true);
  EXPECT_GE(result["checks"].size(), 8U);
}

TEST_F(Program, selftest_says_what_is_missed) {
  const Ended e = run({"selftest", "-q", "--scene-frames", "2"});  // nothing can be confirmed in two frames
  EXPECT_EQ(e.status, 1);
  EXPECT_NE(e.out.find("MISSED"), std::string::npos) << e.out;
}

}  // namespace
}  // namespace accrete::cli
