// accrete record from outside: the recording gives the same model as its source; killed, or on a full disk, it replays
// to the last complete frame. ACCRETE_RECORD_KILLS says how many times it is killed (8; the full test is 50).
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <random>

#include "accrete/hal/recording.h"
#include "cli/child.h"
#include "cli/text/file.h"
#include "cli/text/number.h"
#include "support/temp_folder.h"

namespace accrete::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// What can be replayed of a recording.
struct Replay {
  std::size_t frames = 0, with_pose = 0, unreadable = 0;
  std::string refused;

  explicit Replay(const fs::path& folder) {
    std::unique_ptr<hal::StereoSource> source;
    std::unique_ptr<hal::MotionSource> motion;
    hal::RecordingInfo info;
    const hal::Outcome opened = hal::open_recording(folder, {}, source, motion, info);
    if (!opened.ok()) {
      refused = opened.message;
      return;
    }
    if (!source->start().ok()) return;
    StereoFrame frame;
    for (hal::Outcome o; (o = source->acquire(0, frame)).status != Status::kEndOfStream;) {
      if (!o.ok()) {
        ++unreadable;
        continue;
      }
      ++frames;
      Motion m;
      if (motion->at(frame.t_left, m).ok()) ++with_pose;
      source->release();
    }
  }
};

// Names that stand in both folders of images.
std::size_t whole_pairs(const fs::path& folder) {
  std::size_t pairs = 0;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder / "mav0/cam1/data", error))
    if (entry.path().filename().string()[0] != '.' && fs::exists(folder / "mav0/cam0/data" / entry.path().filename()))
      ++pairs;
  return pairs;
}

TEST(record, replays_to_the_same_edges) {
  const test::TempFolder folder;
  ASSERT_EQ(run_program(folder.path(), {"run", "--frames", "0:11", "-q", "--out", "source"}).status, 0);
  const Ended recorded = run_program(folder.path(), {"record", "synthetic:box", "--frames", "0:11", "-o", "box"});
  ASSERT_EQ(recorded.status, 0) << recorded.err;
  EXPECT_NE(recorded.out.find("recorded     12 frames"), std::string::npos) << recorded.out;
  // A folder does not know the scene's gripper.
  std::vector<std::string> replay{"run", "box", "-q", "--out", "replay"};
  const json summary = json::parse(read_text_file(folder / "source/summary.json"));
  for (const json& box : summary["configuration"]["params"]["excluded_boxes_m"]) {
    std::string numbers;
    for (const json& v : box) numbers += (numbers.empty() ? "" : ",") + v.dump();
    replay.insert(replay.end(), {"--exclude-box", numbers});
  }
  const Ended replayed = run_program(folder.path(), replay);
  EXPECT_EQ(replayed.status, 0) << replayed.err;
  EXPECT_EQ(read_text_file(folder / "replay/edges.csv"), read_text_file(folder / "source/edges.csv"));

  const Ended again = run_program(folder.path(), {"record", "synthetic:box", "-o", "box"});
  EXPECT_EQ(again.status, 5);
  EXPECT_NE(again.err.find("box/mav0 is there already"), std::string::npos) << again.err;
  EXPECT_EQ(run_program(folder.path(), {"record", "synthetic:box"}).status, 2);
}

// Pairs of 8 x 6 pixels, so that the program writes nearly all of its time; of 64 x 48 noisy ones from `noisy` on.
void write_source(const test::TempFolder& folder, int frames, int noisy = -1) {
  std::mt19937 random(3);
  const int scale = noisy < 0 ? 1 : 8;
  const std::string head = "P5\n" + std::to_string(8 * scale) + " " + std::to_string(6 * scale) + "\n255\n";
  std::string poses, times;
  for (int i = 0; i < frames; ++i) {
    const std::string name = std::to_string(i) + ".pgm";
    std::string image =
        head + std::string(static_cast<std::size_t>(48 * scale * scale), static_cast<char>('a' + i % 26));
    if (noisy >= 0 && i >= noisy)
      for (std::size_t k = head.size(); k < image.size(); ++k) image[k] = static_cast<char>(random());
    folder.write("source/left/" + name, image);
    folder.write("source/right/" + name, image);
    const std::string t = std::to_string(i / 100) + "." + std::to_string(100 + i % 100).substr(1);
    times += t + "\n";
    poses += t + " 0 0 1 0 0 0 1\n";
  }
  folder.write("source/times.txt", times);
  folder.write("source/object_poses.txt", poses);
  folder.write("source/stereo.yml",
               "%YAML:1.0\n---\nunits: m\nM1: [10,0,3.5,0,10,2.5,0,0,1]\nM2: [10,0,3.5,0,10,2.5,0,0,1]\n"
               "D1: [0,0,0,0]\nD2: [0,0,0,0]\nR: [1,0,0,0,1,0,0,0,1]\nT: [-0.1,0,0]\n");
}

TEST(record, killed_at_any_moment_replays_to_the_last_complete_frame) {
  double kills = 8;
  const char* wanted = std::getenv("ACCRETE_RECORD_KILLS");
  if (wanted != nullptr && !parse_number(wanted, kills)) FAIL() << "ACCRETE_RECORD_KILLS=" << wanted;
  const test::TempFolder folder;
  write_source(folder, 1000);
  const std::vector<std::string> arguments{"record", "source", "-q", "-o", "out"};
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(run_program(folder.path(), arguments).status, 0);
  const double whole_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::mt19937 random(1);
  int in_the_middle = 0;
  for (int i = 0; i < static_cast<int>(kills); ++i) {
    fs::remove_all(folder / "out");
    Child child(folder.path(), arguments);
    std::this_thread::sleep_for(
        std::chrono::duration<double>(std::uniform_real_distribution<double>(0, whole_s)(random)));
    child.signal(SIGKILL);
    const bool killed = child.wait().status == 1000 + SIGKILL;
    const std::size_t pairs = whole_pairs(folder / "out");
    const Replay replay(folder / "out");
    // The last pair may have its images, but not its lines yet.
    EXPECT_GE(replay.frames + 1, pairs) << replay.refused;
    EXPECT_LE(replay.frames, pairs);
    EXPECT_EQ(replay.unreadable, 0U);
    EXPECT_EQ(replay.with_pose, replay.frames);
    EXPECT_EQ(replay.frames == 0, !replay.refused.empty()) << replay.refused;
    if (killed && replay.frames > 0) ++in_the_middle;
  }
  RecordProperty("killed_in_the_middle", in_the_middle);
  std::printf("%d of %d kills fell into the writing\n", in_the_middle, static_cast<int>(kills));
  EXPECT_GT(in_the_middle, 0);
}

TEST(record, a_full_disk_is_said_and_what_is_there_replays) {
  const test::TempFolder folder;
  constexpr std::size_t kFit = 5;
  write_source(folder, 8, kFit);  // 3 kB each from there on; everything else is smaller
  const Ended e = Child(folder.path(), {"record", "source", "-q", "-o", "full"}, [] {
                    const rlimit size{2500, 2500};
                    ::setrlimit(RLIMIT_FSIZE, &size);
                  }).wait();
  EXPECT_EQ(e.status, 5) << e.err;
  EXPECT_NE(e.err.find("cannot be written: File too large"), std::string::npos) << e.err;
  EXPECT_NE(e.err.find("can be replayed"), std::string::npos) << e.err;
  const Replay replay(folder / "full");
  EXPECT_EQ(replay.frames, kFit) << replay.refused;
  EXPECT_EQ(replay.with_pose, kFit);
}

TEST(record, interrupt_ends_a_whole_recording) {
  const test::TempFolder folder;
  Child child(folder.path(), {"record", "--scene-frames", "10000", "-o", "out"});
  ASSERT_TRUE(child.wait_for("recorded "));
  child.signal(SIGINT);
  const Ended e = child.wait();
  EXPECT_EQ(e.status, 130) << e.err;
  const Replay replay(folder / "out");
  EXPECT_GT(replay.frames, 0U);
  EXPECT_EQ(replay.frames, whole_pairs(folder / "out"));
}

// The recorded poses as lines on standard input: the same model as with the poses of the source.
TEST(run, takes_live_poses_from_standard_input) {
  const test::TempFolder folder;
  ASSERT_EQ(run_program(folder.path(), {"record", "synthetic:box-plain", "--frames", "0:7", "-q", "-o", "box"}).status,
            0);
  std::string lines;
  std::istringstream rows(read_text_file(folder / "box/mav0/object0/data.csv"));
  for (std::string row; std::getline(rows, row);) {
    if (row[0] == '#') continue;
    std::vector<std::string> v;
    std::istringstream fields(row);
    for (std::string field; std::getline(fields, field, ',');) v.push_back(field);
    ASSERT_GE(v.size(), 8U);
    // Time in seconds, w last.
    const std::string t = std::string(10 - std::min<std::size_t>(10, v[0].size()), '0') + v[0];
    lines += t.substr(0, t.size() - 9) + "." + t.substr(t.size() - 9);
    for (const int k : {1, 2, 3, 5, 6, 7, 4}) lines += " " + v[static_cast<std::size_t>(k)];
    for (std::size_t k = 8; k < v.size(); ++k) lines += " " + v[k];
    lines += "\n";
  }
  folder.write("lines", lines + "no pose\n");
  const auto with_lines = [&](const std::vector<std::string>& arguments) {
    return Child(folder.path(), arguments,
                 [] {
                   const int fd = ::open("lines", O_RDONLY);
                   ::dup2(fd, 0);
                 })
        .wait();
  };
  ASSERT_EQ(run_program(folder.path(), {"run", "box", "-q", "--out", "source"}).status, 0);
  const Ended e = with_lines({"run", "box", "--poses", "-", "--motion", "object", "-q", "--out", "live"});
  EXPECT_EQ(e.status, 0) << e.err;
  EXPECT_NE(e.err.find("8 poses came"), std::string::npos) << e.err;
  EXPECT_NE(e.err.find("1 lines malformed"), std::string::npos) << e.err;
  EXPECT_EQ(read_text_file(folder / "live/edges.csv"), read_text_file(folder / "source/edges.csv"));

  const Ended r = with_lines({"record", "box", "--poses", "-", "--motion", "object", "-q", "-o", "again"});
  EXPECT_EQ(r.status, 0) << r.err;
  EXPECT_EQ(Replay(folder / "again").with_pose, 8U);

  const Ended none = run_program(folder.path(), {"run", "box", "--poses", "fifo:nowhere", "-q"});
  EXPECT_EQ(none.status, 4);
  EXPECT_NE(none.err.find("mkfifo nowhere"), std::string::npos) << none.err;
  EXPECT_EQ(run_program(folder.path(), {"run", "box", "--poses", "udp:x", "-q"}).status, 2);
}

}  // namespace
}  // namespace accrete::cli
