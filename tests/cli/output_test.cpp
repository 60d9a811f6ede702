// Where what the program prints and writes cannot go, or must not.
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "cli/child.h"
#include "cli/damaged_images.h"
#include "cli/failure.h"
#include "cli/text/file.h"
#include "cli/write/result_folder.h"
#include "support/temp_folder.h"

namespace accrete::cli {
namespace {

namespace fs = std::filesystem;

class Output : public ::testing::Test {
 protected:
  Ended run(const std::vector<std::string>& arguments, const std::function<void()>& prepare = {}) {
    return Child(folder_.path(), arguments, prepare).wait();
  }
  // A recording of four frames, and a model's edges.csv of it.
  void record() {
    ASSERT_EQ(run({"record", "synthetic:box-plain", "--frames", "0:3", "-q", "--out", "rec"}).status, 0);
    ASSERT_NE(run({"run", "rec", "-q", "--out", "model"}).status, 5);
  }
  test::TempFolder folder_;
};

std::function<void()> full(int stream) {
  return [stream] { ::dup2(::open("/dev/full", O_WRONLY), stream); };
}
std::function<void()> closed(int stream) {
  return [stream] { ::close(stream); };
}
// A pipe that nobody reads any more.
std::function<void()> abandoned(int stream) {
  return [stream] {
    int ends[2];
    if (::pipe(ends) != 0) ::_exit(97);
    ::dup2(ends[1], stream);
    ::close(ends[0]);
    ::close(ends[1]);
  };
}

TEST_F(Output, a_run_whose_messages_nobody_takes_writes_its_results_all_the_same) {
  for (const auto& lost : {full(2), closed(2), abandoned(2)}) {
    const Ended e = run({"run", "--frames", "0:5", "--out", "out"}, lost);
    EXPECT_EQ(e.status, 0);
    EXPECT_TRUE(fs::exists(folder_ / "out/summary.json"));
    fs::remove_all(folder_ / "out");
  }
  EXPECT_EQ(run({"record", "--frames", "0:3", "--out", "rec"}, full(2)).status, 0);
  EXPECT_TRUE(fs::exists(folder_ / "rec/mav0/cam1/data.csv"));
  // A file that was opened as the closed stream would have got the messages.
  EXPECT_EQ(run({"record", "--frames", "0:3", "--out", "rec2"}, closed(2)).status, 0);
  for (const char* file : {"mav0/cam0/data.csv", "mav0/cam1/data.csv", "mav0/object0/data.csv"})
    EXPECT_EQ(read_text_file(folder_ / "rec2" / file), read_text_file(folder_ / "rec" / file));
  EXPECT_EQ(run({"info"}, closed(1)).status, 5);
  EXPECT_EQ(run({"walk"}, full(2)).status, 2);
  EXPECT_EQ(run({"doctor", "nowhere"}, full(2)).status, 4);
}

TEST_F(Output, that_does_not_arrive_is_a_status_and_a_sentence) {
  for (const char* command : {"info", "devices", "--help", "--version"}) {
    const Ended e = run({command}, full(1));
    EXPECT_EQ(e.status, 5) << command;
    EXPECT_NE(e.err.find("standard output: No space left on device"), std::string::npos) << e.err;
  }
  const Ended e = run({"run", "--frames", "0:5", "--json", "-q", "--out", "out"}, full(1));
  EXPECT_EQ(e.status, 5) << e.err;
  EXPECT_TRUE(fs::exists(folder_ / "out/summary.json"));
  EXPECT_EQ(run({"info"}, abandoned(1)).status, 0) << "who reads the first lines only has seen enough";
}

TEST_F(Output, goes_through_links_and_leaves_devices_alone) {
  fs::create_symlink("page.md", folder_ / "link.md");
  write_file(folder_ / "link.md", "one");  // leads to what is not there yet
  write_file(folder_ / "link.md", "two");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.md"));
  EXPECT_EQ(read_text_file(folder_ / "page.md"), "two");
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  fs::create_symlink("pipe", folder_ / "pipe.md");
  EXPECT_THROW(write_file(folder_ / "pipe.md", "three"), Failure);
  EXPECT_TRUE(fs::is_fifo(folder_ / "pipe"));
  fs::create_symlink("loop.md", folder_ / "loop.md");
  EXPECT_THROW(write_file(folder_ / "loop.md", "four"), Failure);
  const Ended e = run({"evaluate", "--frames", "0:1", "-q", "--markdown", "loop.md"});
  EXPECT_EQ(e.status, 5);
  EXPECT_NE(
      e.err.find("loop.md: cannot be written: Too many levels of symbolic links; name another file with --markdown"),
      std::string::npos)
      << e.err;
}

TEST_F(Output, into_a_recording_or_its_truth_is_refused) {
  record();
  fs::create_directories(folder_ / "rec/truth");
  fs::create_directories(folder_ / "exact");
  for (const char* out : {"rec", "rec/", "rec/mav0", "rec/truth"}) {
    const Ended e = run({"run", "rec", "-q", "--out", out});
    EXPECT_EQ(e.status, 2) << out;
    EXPECT_NE(e.err.find("choose another folder with --out"), std::string::npos) << e.err;
  }
  std::ofstream(folder_ / "exact/bbox.txt") << "-1 -1 -1 1 1 1\n";
  EXPECT_EQ(run({"evaluate", "rec", "-q", "--truth", "exact", "--out", "exact"}).status, 2);
  EXPECT_FALSE(fs::exists(folder_ / "exact/edges.csv"));
  EXPECT_NE(run({"run", "rec", "-q", "--out", "rec/results"}).status, 2);
  EXPECT_TRUE(fs::exists(folder_ / "rec/results/summary.json"));
}

TEST_F(Output, of_an_evaluation_is_called_by_the_recordings_folder) {
  record();
  fs::create_directories(folder_ / "rec/truth");
  std::ofstream(folder_ / "rec/truth/edges.csv") << "x0,y0,z0,x1,y1,z1\n0,0,0,1,0,0\n";
  for (const char* recording : {"rec", "rec/", "./rec/.", "rec/mav0"}) {
    const Ended e = run({"evaluate", recording, "--edges", "model/edges.csv", "--json", "--markdown", "page.md"});
    ASSERT_EQ(e.status, 0) << e.err;
    EXPECT_EQ(nlohmann::json::parse(e.out)["recording"], "rec");
  }
  const std::string page = read_text_file(folder_ / "page.md");
  EXPECT_NE(page.find("\n## rec\n"), std::string::npos) << page;
  EXPECT_EQ(page.find("\n## "), page.rfind("\n## ")) << page;
  EXPECT_EQ(run({"evaluate", "rec", "--edges", "model/edges.csv", "--out", "out"}).status, 2);
  EXPECT_EQ(run({"evaluate", "rec", "--edges", "model/edges.csv", "--hold-out", "3"}).status, 2);
}

TEST_F(Output, truth_of_astronomic_length_is_scored_in_no_time) {
  record();
  fs::create_directories(folder_ / "exact");
  for (const char* segment : {"0,0,0,1e200,1e30,1e30", "-1e6,0,0.9,1e6,0,0.9", "0,0,0,1e308,1e308,1e308"}) {
    std::ofstream(folder_ / "exact/edges.csv") << "x0,y0,z0,x1,y1,z1\n" << segment << '\n';
    const Ended e = run({"evaluate", "rec", "--truth", "exact", "--edges", "model/edges.csv"});
    EXPECT_TRUE(e.status == 0 || e.status == 4) << segment << ": " << e.status << e.err;
  }
}

TEST_F(Output, of_an_earlier_run_in_the_same_folder_is_named) {
  ASSERT_EQ(run({"run", "--frames", "0:5", "-q", "--save-model", "--out", "out"}).status, 0);
  fs::create_directories(folder_ / "out/overlay");
  const Ended e = run({"run", "--frames", "0:5", "-q", "--out", "out"});
  EXPECT_EQ(e.status, 0);
  EXPECT_NE(e.err.find("out/model.accrete is of an earlier run"), std::string::npos) << e.err;
  EXPECT_NE(e.err.find("out/overlay has pictures of an earlier run"), std::string::npos) << e.err;
}

TEST_F(Output, of_a_recorder_that_got_no_frame_does_not_block_the_next_one) {
  EXPECT_EQ(run({"record", recording_of_damaged_images(folder_.path()), "-q", "--out", "again"}).status, 1);
  EXPECT_EQ(run({"record", "synthetic:box-plain", "--frames", "0:3", "-q", "--out", "again"}).status, 0);
}

// What asks for no interruption ends by the signal itself.
TEST_F(Output, of_bench_ends_with_the_first_interruption) {
  // Whoever runs the tests in the background may have told them to ignore it.
  Child child(folder_.path(), {"bench", "--repetitions", "10000"}, [] { std::signal(SIGINT, SIG_DFL); });
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  child.signal(SIGINT);
  EXPECT_EQ(child.wait().status, 1000 + SIGINT);
}

TEST_F(Output, names_what_stands_in_the_way_of_a_path) {
  fs::create_symlink("loop", folder_ / "loop");
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"info", "loop"}, {"run", "--resume", "loop"}, {"evaluate", "--truth", "loop"}}) {
    const Ended e = run(words);
    EXPECT_TRUE(e.status == 4 || e.status == 2) << e.status;
    EXPECT_EQ(e.err.find("filesystem error"), std::string::npos) << e.err;
  }
  EXPECT_NE(run({"info", "loop"}).err.find("loop cannot be reached: Too many levels of symbolic links"),
            std::string::npos);
}

TEST_F(Output, poses_that_were_named_and_cannot_be_read_are_an_error_everywhere) {
  record();
  for (const char* command : {"run", "info", "doctor", "evaluate"}) {
    const Ended e = run({command, "rec", "--poses", "typo.txt"});
    EXPECT_EQ(e.status, 4) << command;
    EXPECT_NE(e.err.find("typo.txt is not there"), std::string::npos) << e.err;
  }
  EXPECT_EQ(run({"record", "rec", "--poses", "typo.txt", "-q", "--out", "again"}).status, 4);
}

}  // namespace
}  // namespace accrete::cli
