// The doctor and recordings on disk: what cannot be opened otherwise, and what real cameras saw.
#include <gtest/gtest.h>

#include <array>
#include <filesystem>

#include "cli/child.h"
#include "cli/doctor/doctor_report.h"
#include "cli/scene_recording.h"
#include "cli/studio.h"
#include "cli/text/file.h"

namespace accrete::cli {
namespace {

Camera with_lens(Camera camera, Distortion model, std::array<double, 12> coefficients) {
  camera.distortion = model;
  camera.coefficients = coefficients;
  return camera;
}

// Calibrations that `run` refuses: the program opens them all the same, and its exit status tells.
TEST(doctor_recordings, the_program_opens_what_cannot_be_right_and_says_why) {
  const test::TempFolder folder;
  write_scene(folder, "scene", 4);
  const std::string sane = read_text_file(folder / "scene/stereo.yml");
  const auto broken = [&](const char* what, const char* with) {
    std::string text = sane;
    text.replace(text.find(what), std::string(what).size(), with);
    folder.write("scene/stereo.yml", text);
    const Ended e = run_program(folder.path(), {"doctor", "scene", "--json"});
    EXPECT_EQ(e.status, 6) << e.err;
    return nlohmann::json::parse(e.out)["findings"][0]["fault"].get<std::string>();
  };
  EXPECT_EQ(broken("-0.120000", "0.120000"), "baseline_sign");
  EXPECT_EQ(broken("image_width: 640\nimage_height: 480", "image_width: 1280\nimage_height: 960"), "image_size");
  std::string millimetres = sane;
  millimetres.erase(millimetres.find("units: m\n"), 9);
  millimetres.replace(millimetres.find("-0.120000"), 9, "-120.0");
  folder.write("scene/stereo.yml", millimetres);
  const Ended e = run_program(folder.path(), {"doctor", "scene"});
  EXPECT_EQ(e.status, 6) << e.err;
  EXPECT_NE(e.out.find("\nmillimetres (clear)"), std::string::npos) << e.out;
  EXPECT_NE(e.out.find("What to do: Write 'units: mm'"), std::string::npos) << e.out;
  folder.write("scene/stereo.yml", sane);
  const Ended well = run_program(folder.path(), {"doctor", "scene", "--samples", "4"});
  EXPECT_EQ(well.status, 0) << well.err << well.out;
  EXPECT_NE(well.out.find("Nothing is wrong"), std::string::npos) << well.out;
}

// chessboard is not rectified and its poses jump, temple_ring has gaps in its ring, kitti_grey is a drive.
TEST(doctor_recordings, finds_nothing_wrong_with_recordings_that_are_sane) {
  const std::filesystem::path data = ACCRETE_TEST_DATA;
  if (!std::filesystem::exists(data)) GTEST_SKIP() << data << " is not there";
  for (const char* name : {"chessboard", "temple_ring", "kitti_grey", "boxturn"}) {
    DoctorOptions options;
    options.run.recording = (data / name).string();
    options.samples = 12;
    Input input = open_input(options.run);
    const Diagnosis d = examine(input, options);
    EXPECT_EQ(faults(d), Names{}) << name << "\n" << to_text(d);
  }
}

TEST(doctor_recordings, names_the_lens_that_a_real_recording_lacks) {
  const std::filesystem::path data = ACCRETE_TEST_DATA;
  if (!std::filesystem::exists(data)) GTEST_SKIP() << data << " is not there";
  DoctorOptions options;
  options.run.recording = (data / "chessboard").string();
  Input input = open_input(options.run);
  Film film;
  film.mode = input.mode;
  take(*input.source, nullptr, {0, 1, 2, 3, 4, 5, 6}, film);
  const StereoRig sane = film.rig;
  const Studio studio(film);
  EXPECT_EQ(faults(studio.diagnose(film)), Names{});
  for (Camera* camera : {&film.rig.left, &film.rig.right}) camera->distortion = Distortion::kNone;
  const Diagnosis ignored = studio.diagnose(film);
  EXPECT_EQ(faults(ignored), Names{"distortion"}) << to_text(ignored);
  film.rig.left = with_lens(sane.left, Distortion::kKannalaBrandt, sane.left.coefficients);
  film.rig.right = with_lens(sane.right, Distortion::kKannalaBrandt, sane.right.coefficients);
  for (Camera* camera : {&film.rig.left, &film.rig.right}) camera->coefficients[4] = 0;
  const Diagnosis fisheye = studio.diagnose(film);
  EXPECT_EQ(faults(fisheye), Names{"distortion"}) << to_text(fisheye);
}

}  // namespace
}  // namespace accrete::cli
