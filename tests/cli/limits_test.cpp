// Images that are larger than the limits: refused before the first frame, and the sentence names both sizes.
#include <gtest/gtest.h>

#include "cli/child.h"
#include "support/temp_folder.h"

namespace accrete::cli {
namespace {

// A recording of one pair of grey images, `width` x `height`, and its calibration.
void write_recording(const test::TempFolder& folder, int width, int height) {
  const std::string image = "P5\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n" +
                            std::string(static_cast<std::size_t>(width) * height, 'a');
  for (const char* eye : {"left", "right"}) folder.write("tape/" + std::string(eye) + "/0.pgm", image);
  const auto matrix = [](const char* key, int rows, int columns, const char* data) {
    return std::string(key) + ": !!opencv-matrix\n   rows: " + std::to_string(rows) +
           "\n   cols: " + std::to_string(columns) + "\n   dt: d\n   data: [ " + data + " ]\n";
  };
  constexpr const char* kCamera = "500., 0., 20., 0., 500., 20., 0., 0., 1.";
  folder.write("tape/stereo.yml",
               "%YAML:1.0\n---\nimage_width: " + std::to_string(width) + "\nimage_height: " + std::to_string(height) +
                   "\nunits: m\n" + matrix("M1", 3, 3, kCamera) + matrix("D1", 1, 4, "0., 0., 0., 0.") +
                   matrix("M2", 3, 3, kCamera) + matrix("D2", 1, 4, "0., 0., 0., 0.") +
                   matrix("R", 3, 3, "1., 0., 0., 0., 1., 0., 0., 0., 1.") + matrix("T", 3, 1, "-0.1, 0., 0."));
  folder.write("tape/object_poses.txt", "0 0 0 1 0 0 0 1\n");
}

struct Case {
  int width, height;
  const char* capacity;
  int status;  // 1: read and processed, but one frame confirms nothing
  const char* says;
};
class Limits : public ::testing::TestWithParam<Case> {};

TEST_P(Limits, are_held_before_the_first_frame) {
  const Case c = GetParam();
  const test::TempFolder folder;
  write_recording(folder, c.width, c.height);
  const Ended e = run_program(folder.path(), {"run", "tape", "--capacity", c.capacity, "--out", "out"});
  EXPECT_EQ(e.status, c.status) << e.err;
  EXPECT_NE(e.err.find(c.says), std::string::npos) << e.err;
  EXPECT_EQ(std::filesystem::exists(folder / "out"), c.status == 1) << "it began to work";
}

INSTANTIATE_TEST_SUITE_P(
    all, Limits,
    ::testing::Values(Case{640, 480, "small", 1, "too few frames"},
                      Case{641, 48, "small", 2, "images have 641 x 48 pixels, capacity small holds 640 x 480"},
                      Case{48, 481, "small", 2, "images have 48 x 481 pixels, capacity small holds 640 x 480"},
                      Case{1281, 48, "default", 2, "images have 1281 x 48 pixels, capacity default holds 1280 x 720"},
                      Case{1921, 48, "auto", 4, "images have 1921 x 48 pixels, capacity large holds 1920 x 1200"},
                      Case{48, 1201, "large", 4, "images have 48 x 1201 pixels, capacity large holds 1920 x 1200"}));

}  // namespace
}  // namespace accrete::cli
