// Recordings with faults: what can be used is used, the rest is counted and said, and the exit status tells.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/child.h"
#include "cli/scene_recording.h"
#include "cli/score/csv_table.h"
#include "cli/text/file.h"

namespace accrete::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class DamagedRecording : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_NO_FATAL_FAILURE(write_scene(folder_, "scene", 9)); }

  Ended run(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"run", "scene", "--out", "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(folder_.path(), arguments);
  }
  json summary() { return json::parse(read_text_file(folder_ / "out/summary.json")); }
  // Keeps the lines of a file for whose index `keep` says so.
  void keep_lines(const std::string& file, const std::function<bool(int)>& keep) {
    std::istringstream in(read_text_file(folder_ / file));
    std::string out, line;
    for (int i = 0; std::getline(in, line); ++i)
      if (keep(i)) out += line + "\n";
    folder_.write(file, out);
  }

  test::TempFolder folder_;
};

TEST_F(DamagedRecording, sound_it_is_used_completely) {
  const Ended e = run();
  EXPECT_EQ(e.status, 0) << e.err;
  EXPECT_EQ(summary()["frames"]["used"], 9);
  EXPECT_EQ(summary()["exit_status"], 0);
  EXPECT_NE(e.out.find("9 of 9 frames covered"), std::string::npos) << e.out;
}

TEST_F(DamagedRecording, a_truncated_image_costs_one_frame) {
  fs::resize_file(folder_ / "scene/right/03.ppm", 1000);
  const Ended e = run();
  EXPECT_EQ(e.status, 3) << e.err;
  EXPECT_NE(e.err.find("warning: frame 3 is left out"), std::string::npos) << e.err;
  EXPECT_NE(e.err.find("03.ppm"), std::string::npos) << e.err;
  const json s = summary();
  EXPECT_EQ(s["frames"]["used"], 8);
  EXPECT_EQ(s["frames"]["unreadable"], 1);
  EXPECT_EQ(s["per_frame"]["fate"][3], "unreadable");
  EXPECT_EQ(s["per_frame"]["frame"][4], 4);
  EXPECT_FALSE(s["warnings"].empty());
}

TEST_F(DamagedRecording, a_frame_of_another_size_costs_one_frame) {
  folder_.write("scene/left/05.ppm", "P6\n4 3\n255\n" + std::string(36, 'x'));
  const Ended e = run();
  EXPECT_EQ(e.status, 3) << e.err;
  EXPECT_NE(e.err.find("4x3 pixels"), std::string::npos) << e.err;
  EXPECT_EQ(summary()["frames"]["used"], 8);
  EXPECT_EQ(summary()["frames"]["unreadable"], 1);
}

TEST_F(DamagedRecording, frames_without_a_pose_are_counted) {
  keep_lines("scene/object_poses.txt", [](int i) { return i < 7; });
  const Ended e = run();
  EXPECT_EQ(e.status, 3) << e.err;
  EXPECT_NE(e.err.find("frame 7 is left out"), std::string::npos) << e.err;
  EXPECT_EQ(summary()["frames"]["used"], 7);
  EXPECT_EQ(summary()["frames"]["without_pose"], 2);
}

TEST_F(DamagedRecording, the_gap_between_poses_that_is_bridged_can_be_chosen) {
  keep_lines("scene/object_poses.txt", [](int i) { return i != 4; });  // a gap of 67 ms
  EXPECT_EQ(run({"-q"}).status, 3);
  EXPECT_EQ(run({"-q", "--max-pose-gap", "100ms"}).status, 0);
}

TEST_F(DamagedRecording, first_and_last_frame_in_edges_csv_count_the_recording) {
  fs::resize_file(folder_ / "scene/left/00.ppm", 10);
  fs::resize_file(folder_ / "scene/left/01.ppm", 10);
  EXPECT_EQ(run({"-q"}).status, 3);
  const CsvTable table(read_text_file(folder_ / "out/edges.csv"), "edges.csv", {"first_frame"});
  const std::vector<double> first = table.numbers("first_frame"), last = table.numbers("last_frame");
  EXPECT_EQ(*std::min_element(first.begin(), first.end()), 2);
  EXPECT_EQ(*std::max_element(last.begin(), last.end()), 8);
}

TEST_F(DamagedRecording, no_readable_image_at_all_is_refused) {
  for (int i = 0; i < 9; ++i) folder_.write("scene/left/0" + std::to_string(i) + ".ppm", "no image");
  const Ended e = run();
  EXPECT_EQ(e.status, 4) << e.err;
  EXPECT_NE(e.err.find(".ppm"), std::string::npos) << e.err;
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(DamagedRecording, missing_poses_stop_run_but_not_info) {
  fs::remove(folder_ / "scene/object_poses.txt");
  EXPECT_EQ(run().status, 4);
  const Ended e = run_program(folder_.path(), {"info", "scene"});
  EXPECT_EQ(e.status, 0) << e.err;
  EXPECT_NE(e.out.find("there are no poses"), std::string::npos) << e.out;
}

TEST_F(DamagedRecording, black_and_saturated_images_are_used_and_change_nothing_else) {
  const std::string size = std::string("P6\n640 480\n255\n");
  folder_.write("scene/left/02.ppm", size + std::string(640 * 480 * 3, '\0'));
  folder_.write("scene/right/05.ppm", size + std::string(640 * 480 * 3, '\xFF'));
  const Ended e = run();
  EXPECT_EQ(e.status, 0) << e.err;
  EXPECT_EQ(summary()["frames"]["used"], 9);
  EXPECT_EQ(summary()["per_frame"]["left_primitives"][2], 0);
  EXPECT_EQ(summary()["per_frame"]["right_primitives"][5], 0);
}

TEST_F(DamagedRecording, a_wrong_motion_accumulates_nothing_and_says_what_to_check) {
  // Every pose the same: the box turns, the poses say that it does not.
  std::istringstream in(read_text_file(folder_ / "scene/object_poses.txt"));
  std::string first, line, out;
  std::getline(in, first);
  for (int i = 0; i < 9; ++i) {
    char time[32];
    std::snprintf(time, sizeof time, "%.9f", i / 30.0);
    out += time + first.substr(first.find(' ')) + "\n";
  }
  folder_.write("scene/object_poses.txt", out);
  const Ended e = run();
  EXPECT_EQ(e.status, 1) << e.err;
  EXPECT_NE(e.err.find("--pose-dir"), std::string::npos) << e.err;
}

}  // namespace
}  // namespace accrete::cli
