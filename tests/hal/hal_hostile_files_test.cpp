// Damage at random, a thousand times over: every outcome is a success or a sentence, none is a crash. The sanitizers of
// the dev build see what this alone would not.
#include <gtest/gtest.h>

#include <random>

#include "calibration/calibration.h"
#include "image/image_file.h"
#include "motion/pose_table.h"
#include "opened.h"
#include "outcome_matchers.h"
#include "support/data_folder.h"
#include "text/file.h"
#include "tiny_recording.h"

namespace accrete::hal {
namespace {

using test::TempFolder;

// Changes, removes, doubles or cuts a few bytes.
std::string damaged(std::string text, std::mt19937& rng) {
  const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(rng); };
  static constexpr char kNasty[] = {'\0', '\n', '\xff', '-', '9', 'e', '[', '{', '&', '*', ':', ',', ' ', '#', '%'};
  for (std::size_t n = 1 + below(4); n > 0 && !text.empty(); --n) {
    const std::size_t at = below(text.size());
    switch (below(6)) {
      case 0:
        text[at] = static_cast<char>(below(256));
        break;
      case 1:
        text[at] = kNasty[below(sizeof kNasty)];
        break;
      case 2:
        text.erase(at, 1 + below(20));
        break;
      case 3:
        text.insert(at, text.substr(below(text.size()), below(40)));
        break;
      case 4:
        text.insert(at, std::string(1 + below(8), kNasty[below(sizeof kNasty)]));
        break;
      default:
        if (below(4) == 0) text.resize(at);
    }
  }
  return text;
}

void expect_sentence(const Outcome& o, const std::filesystem::path& path) {
  if (o.ok()) {
    EXPECT_TRUE(o.message.empty());
    return;
  }
  EXPECT_NE(o.message.find(path.filename().string()), std::string::npos) << o.message;
}

TEST(Hostile, Calibrations) {
  const TempFolder folder;
  std::mt19937 rng(1);
  const std::string yml = StereoYml{}.text(),
                    kitti = "P0: 700 0 600 0 0 710 180 0 0 0 1 0\nP1: 700 0 600 -350 0 710 180 0 0 0 1 0\n";
  for (int i = 0; i < 1500; ++i) {
    const auto path = folder.write("calibration.txt", damaged(i % 3 != 0 ? yml : kitti, rng));
    Calibration c;
    const Outcome o = read_calibration_file(path, KittiPair::kGrey, c);
    expect_sentence(o, path);
    // What is let through can be used.
    if (o.ok() && c.rig.left.width_px > 0) {
      EXPECT_EQ(validate(c.rig), Status::kOk);
    }
  }
}

TEST(Hostile, Poses) {
  const TempFolder folder;
  std::mt19937 rng(2);
  const std::string tum = "# t tx\n0.0 1 2 3 0 0 0 1\n0.1 1 2 3 0 0.6 0 0.8\n1e1 1 2 3 1 0 0 0\n";
  const std::string matrices = "1 0 0 0 0 1 0 0 0 0 1 0\n0 -1 0 4 1 0 0 5 0 0 1 6";
  const std::string csv =
      "#t\r\n1403636580838555648,4.6,-1.7,0.8,0.8,0,0,0.6\r\n1403636580938555648,4,-1,0,1,0,0,0\r\n";
  for (int i = 0; i < 1500; ++i) {
    const auto path = folder.write("poses.txt", damaged(i % 3 == 0 ? tum : i % 3 == 1 ? matrices : csv, rng));
    PoseTable table;
    const Outcome o = read_poses(path, table);
    expect_sentence(o, path);
    if (!o.ok()) continue;
    for (const StampedPose& p : table.poses)
      EXPECT_EQ(validate(Motion::object(p.t, {p.rotation, p.translation})), Status::kOk);
  }
}

// Real files where there are some: a JPEG of the chessboard, PNGs of the others.
TEST(Hostile, Images) {
  const TempFolder folder;
  std::mt19937 rng(3);
  std::vector<std::string> seeds = {pgm(20, 10), "P6 # c\n4 4\n65535\n" + std::string(96, 'x')};
  for (const char* name : {"chessboard/left/01.jpg", "kitti_grey/image_0/000000.png", "boxturn/left/000000.png"}) {
    std::string bytes;
    if (read_text(test::data_folder() / name, bytes).ok()) seeds.push_back(bytes);
  }
  ImageReader reader;
  for (int i = 0; i < 300; ++i) {
    const auto path = folder.write("image.bin", damaged(seeds[static_cast<std::size_t>(i) % seeds.size()], rng));
    ImageHeader header;
    Outcome o = reader.open(path, header);
    ImageBuffer image;
    if (o.ok()) o = reader.decode(image);
    expect_sentence(o, path);
    if (o.ok()) {
      EXPECT_TRUE(image.view().valid());
    }
  }
}

TEST(Hostile, ListsAndTimes) {
  const TempFolder folder;
  std::mt19937 rng(4);
  const std::string rows = "#timestamp [ns],filename\n100000000,a.pgm\n150000000,b.pgm\n200000000,c.pgm\n";
  for (int i = 0; i < 500; ++i) {
    folder.write("mav0/cam0/data.csv", damaged(rows, rng));
    folder.write("mav0/cam1/data.csv", damaged(rows, rng));
    const Opened r(folder.path());  // there is no calibration: a sentence in any case
    EXPECT_FALSE(r.outcome.ok());
    EXPECT_NE(r.outcome.message.find("cam"), std::string::npos) << r.outcome.message;
  }
}

}  // namespace
}  // namespace accrete::hal
