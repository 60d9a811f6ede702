// Rigs that are broken on purpose: each fault is named, and sane rigs have none.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "cli/child.h"
#include "cli/doctor/doctor_command.h"
#include "cli/doctor/doctor_report.h"
#include "cli/film.h"
#include "cli/scene_recording.h"
#include "cli/text/file.h"

namespace accrete::cli {
namespace {

// The part of an image that shows the box to both eyes: less to look at.
constexpr int kCutX = 120, kCutY = 96, kCutWidth = 400, kCutHeight = 288;

GreyImage cut_out(const GreyImage& image) {
  GreyImage out{kCutWidth, kCutHeight, {}};
  for (int y = 0; y < kCutHeight; ++y)
    for (int x = 0; x < kCutWidth; ++x) out.pixels.push_back(static_cast<std::uint8_t>(image.at(x + kCutX, y + kCutY)));
  return out;
}

Camera cut_out(Camera camera) {
  camera.width_px = kCutWidth;
  camera.height_px = kCutHeight;
  camera.cx_px -= kCutX;
  camera.cy_px -= kCutY;
  return camera;
}

Film cut_out(Film film) {
  for (FilmFrame& frame : film.frames) {
    frame.left = cut_out(frame.left);
    frame.right = cut_out(frame.right);
  }
  film.rig.left = cut_out(film.rig.left);
  film.rig.right = cut_out(film.rig.right);
  return film;
}

// A sane recording, and what the doctor sees of it: whoever breaks the calibration or the poses need not look again.
struct Studio {
  Film film;
  Samples samples;

  explicit Studio(Film sane) : film(std::move(sane)) {
    FilmSource source(film);
    EXPECT_TRUE(source.configure().ok());
    FilmMotion motion(film);
    samples = take_samples(source, &motion, {}, 40, [] { return false; });
  }
  // The diagnosis of a film with the same images.
  [[nodiscard]] Diagnosis diagnose(const Film& broken) const {
    Samples seen = samples;
    const auto motion = [&](std::size_t i) {
      return i < broken.frames.size() ? std::optional<Motion>(broken.frames[i].motion) : std::nullopt;
    };
    for (std::size_t i = 0; i < seen.list.size(); ++i) {
      seen.list[i].motion = motion(i);
      seen.list[i].motion_before = motion(i - 1);
      seen.list[i].motion_after = motion(i + 1);
    }
    Patient patient;
    patient.samples = &seen;
    patient.rig = broken.rig;
    patient.mode = broken.mode;
    patient.has_poses = broken.has_poses;
    return cli::diagnose(patient);
  }
};

// Steps of one, two and three frames, so that a pose too late is not the next pose of a steady turn.
const Studio& box() {
  static const Studio studio(
      cut_out(film_of_scene("box-plain", 120, {0, 1, 3, 4, 6, 9, 10, 13, 14, 16, 19, 20, 22, 25})));
  return studio;
}
// Lenses and small rotations show in large images.
const Studio& room() {
  static const Studio studio(film_of_scene("room", 16, {0, 1, 3, 4, 6, 8, 9, 11, 13, 14}));
  return studio;
}

// What the doctor finds, in the order in which it says so.
std::vector<std::string> faults(const Diagnosis& diagnosis) {
  std::vector<std::string> names;
  for (const DoctorFinding& f : diagnosis.findings) names.push_back(f.fault);
  return names;
}
using Names = std::vector<std::string>;

void each_image(Film& film, const std::function<void(GreyImage&, bool right, std::size_t frame)>& change) {
  for (std::size_t i = 0; i < film.frames.size(); ++i) {
    change(film.frames[i].left, false, i);
    change(film.frames[i].right, true, i);
  }
}
void each_pose(Film& film, const std::function<Transform<Left, Map>(const Transform<Left, Map>&)>& change) {
  for (FilmFrame& frame : film.frames) frame.motion.T_l_m = change(frame.motion.T_l_m);
}

GreyImage moved_down(const GreyImage& image, int rows) {
  GreyImage out = image;
  for (int y = 0; y < image.height_px; ++y)
    for (int x = 0; x < image.width_px; ++x)
      out.pixels[static_cast<std::size_t>(y * image.width_px + x)] =
          static_cast<std::uint8_t>(image.at(x, std::clamp(y - rows, 0, image.height_px - 1)));
  return out;
}

// What a camera with a lens would have seen of what a pinhole of the same intrinsics saw.
GreyImage through_lens(const GreyImage& image, const Camera& pinhole, const Camera& lens) {
  GreyImage out = image;
  for (int y = 0; y < image.height_px; ++y)
    for (int x = 0; x < image.width_px; ++x) {
      const auto ray = unproject(lens, {static_cast<double>(x), static_cast<double>(y)});
      const auto from = ray.ok() ? project(pinhole, ray.value()) : Result<Pixel>(Status::kInvalidArgument);
      double value = 0;
      if (from.ok()) {
        const double u = std::clamp(from.value().x, 0.0, image.width_px - 1.001);
        const double v = std::clamp(from.value().y, 0.0, image.height_px - 1.001);
        const int i = static_cast<int>(u), j = static_cast<int>(v);
        const double a = u - i, b = v - j;
        value = (1 - b) * ((1 - a) * image.at(i, j) + a * image.at(i + 1, j)) +
                b * ((1 - a) * image.at(i, j + 1) + a * image.at(i + 1, j + 1));
      }
      out.pixels[static_cast<std::size_t>(y * image.width_px + x)] = static_cast<std::uint8_t>(value + 0.5);
    }
  return out;
}

Camera with_lens(Camera camera, Distortion model, std::array<double, 12> coefficients) {
  camera.distortion = model;
  camera.coefficients = coefficients;
  return camera;
}

TEST(doctor, finds_nothing_wrong_with_the_sane_scenes) {
  for (const Studio* studio : {&box(), &room()}) {
    const Diagnosis d = examine(studio->film);
    EXPECT_EQ(faults(d), Names{}) << to_text(d);
    Film without = studio->film;
    without.has_poses = false;
    EXPECT_EQ(faults(studio->diagnose(without)), Names{});
  }
}

TEST(doctor, names_a_baseline_of_the_wrong_sign) {
  for (const Studio* sane : {&box(), &room()}) {
    Film film = sane->film;
    film.rig.T_r_l.translation = -1.0 * film.rig.T_r_l.translation;
    const Diagnosis d = sane->diagnose(film);
    ASSERT_EQ(faults(d), Names{"baseline_sign"}) << to_text(d);
  }
}

TEST(doctor, names_inverse_extrinsics) {
  Film film = room().film;
  const auto inverse = film.rig.T_r_l.inverse();
  film.rig.T_r_l = {inverse.rotation, inverse.translation};
  const Diagnosis d = room().diagnose(film);
  EXPECT_EQ(faults(d), Names{"inverse_extrinsics"}) << to_text(d);
}

TEST(doctor, names_a_transposed_rotation) {
  Film film = room().film;
  film.rig.T_r_l.rotation = conjugate(film.rig.T_r_l.rotation);
  const Diagnosis d = room().diagnose(film);
  EXPECT_EQ(faults(d), Names{"inverse_extrinsics"}) << to_text(d);
}

TEST(doctor, names_swapped_eyes) {
  for (const Studio* sane : {&box(), &room()}) {
    Film film = sane->film;
    for (FilmFrame& frame : film.frames) std::swap(frame.left, frame.right);
    const Diagnosis d = examine(film);
    EXPECT_EQ(faults(d), Names{"swapped_eyes"}) << to_text(d);
  }
}

TEST(doctor, names_millimetres) {
  Film film = box().film;
  film.rig.T_r_l.translation = 1000.0 * film.rig.T_r_l.translation;
  const Diagnosis d = box().diagnose(film);
  EXPECT_EQ(faults(d), Names{"millimetres"}) << to_text(d);
}

TEST(doctor, names_a_calibration_for_another_size) {
  Film film = box().film;
  for (Camera* camera : {&film.rig.left, &film.rig.right}) {
    camera->fx_px *= 2;
    camera->fy_px *= 2;
    camera->cx_px = 2 * camera->cx_px + 0.5;
    camera->cy_px = 2 * camera->cy_px + 0.5;
  }
  const Diagnosis unstated = box().diagnose(film);
  EXPECT_EQ(faults(unstated), Names{"image_size"}) << to_text(unstated);
  EXPECT_NE(unstated.findings[0].advice.find("by 0.5 "), std::string::npos) << to_text(unstated);
  film.calibrated_width_px = 2 * kCutWidth;
  film.calibrated_height_px = 2 * kCutHeight;
  const Diagnosis stated = examine(film);
  EXPECT_EQ(faults(stated), Names{"image_size"}) << to_text(stated);
  EXPECT_NE(stated.findings[0].advice.find("by 0.5 "), std::string::npos) << to_text(stated);
}

TEST(doctor, names_distortion_that_is_removed_twice) {
  Film film = room().film;
  for (Camera* camera : {&film.rig.left, &film.rig.right})
    *camera = with_lens(*camera, Distortion::kBrownConrady, {-0.3, 0.1});
  const Diagnosis d = room().diagnose(film);
  ASSERT_EQ(faults(d), Names{"distortion"}) << to_text(d);
  EXPECT_NE(d.findings[0].what.find("second time"), std::string::npos) << to_text(d);
}

TEST(doctor, names_distortion_that_is_ignored) {
  Film film = room().film;
  const Camera left = with_lens(film.rig.left, Distortion::kBrownConrady, {-0.35});
  const Camera right = with_lens(film.rig.right, Distortion::kBrownConrady, {-0.35});
  each_image(film, [&](GreyImage& image, bool is_right, std::size_t) {
    image = is_right ? through_lens(image, film.rig.right, right) : through_lens(image, film.rig.left, left);
  });
  const Diagnosis d = examine(film);
  EXPECT_EQ(faults(d), Names{"distortion"}) << to_text(d);
}

TEST(doctor, names_a_vertical_offset_of_three_pixels) {
  for (const int rows : {-3, 3}) {
    Film film = box().film;
    each_image(film, [rows](GreyImage& image, bool right, std::size_t) {
      if (right) image = moved_down(image, rows);
    });
    const Diagnosis d = examine(film);
    ASSERT_EQ(faults(d), Names{"vertical_offset"}) << to_text(d);
    EXPECT_NE(d.findings[0].what.find(rows < 0 ? "3.0 px too high" : "3.0 px too low"), std::string::npos)
        << to_text(d);
  }
}

TEST(doctor, names_the_camera_that_is_a_frame_late) {
  const Film sane = cut_out(film_of_scene("box-plain", 60, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13}));
  EXPECT_EQ(faults(examine(sane)), Names{});
  for (const bool right : {true, false}) {
    Film film = sane;
    for (std::size_t i = film.frames.size() - 1; i > 0; --i)
      (right ? film.frames[i].right : film.frames[i].left) =
          (right ? film.frames[i - 1].right : film.frames[i - 1].left);
    film.frames.erase(film.frames.begin());
    const Diagnosis d = examine(film);
    ASSERT_EQ(faults(d), Names{"late_camera"}) << to_text(d);
    EXPECT_NE(d.findings[0].what.find(right ? "right camera is late" : "left camera is late"), std::string::npos)
        << to_text(d);
  }
}

TEST(doctor, names_exposure_that_drifts_apart) {
  Film film = box().film;
  each_image(film, [](GreyImage& image, bool right, std::size_t frame) {
    for (std::uint8_t& p : image.pixels)
      if (right) p = static_cast<std::uint8_t>(std::min(255.0, p * (0.8 + 0.03 * static_cast<double>(frame))));
  });
  const Diagnosis d = examine(film);
  EXPECT_EQ(faults(d), Names{"exposure_drift"}) << to_text(d);
}

TEST(doctor, names_exposure_that_differs) {
  Film film = box().film;
  each_image(film, [](GreyImage& image, bool right, std::size_t) {
    for (std::uint8_t& p : image.pixels)
      if (right) p = static_cast<std::uint8_t>(0.6 * p);
  });
  const Diagnosis d = examine(film);
  EXPECT_EQ(faults(d), Names{"exposure_difference"}) << to_text(d);
}

TEST(doctor, names_mirrored_images) {
  for (const auto& [left, right] : {std::pair{false, true}, std::pair{true, false}, std::pair{true, true}}) {
    Film film = box().film;
    each_image(film, [l = left, r = right](GreyImage& image, bool is_right, std::size_t) {
      if (is_right ? r : l) image = mirrored(image, true, false);
    });
    const Diagnosis d = examine(film);
    ASSERT_EQ(faults(d), Names{"mirrored"}) << left << right << to_text(d);
    const char* which = left && right ? "Both images are" : left ? "The left image is" : "The right image is";
    EXPECT_NE(d.findings[0].what.find(which), std::string::npos) << to_text(d);
  }
}

TEST(doctor, names_an_eye_that_is_upside_down) {
  Film film = box().film;
  each_image(film, [](GreyImage& image, bool right, std::size_t) {
    if (right) image = mirrored(image, true, true);
  });
  const Diagnosis d = examine(film);
  ASSERT_EQ(faults(d), Names{"mirrored"}) << to_text(d);
  EXPECT_NE(d.findings[0].what.find("upside down"), std::string::npos) << to_text(d);
}

TEST(doctor, names_inverse_poses) {
  for (const Studio* sane : {&box(), &room()}) {
    Film film = sane->film;
    each_pose(film, [](const auto& p) { return retag<Left, Map>(p.inverse()); });
    const Diagnosis d = sane->diagnose(film);
    EXPECT_EQ(faults(d), Names{"poses_inverse"}) << to_text(d);
  }
}

TEST(doctor, names_poses_that_are_a_frame_late) {
  Film film = box().film;
  for (std::size_t i = film.frames.size() - 1; i > 0; --i) film.frames[i].motion = film.frames[i - 1].motion;
  const Diagnosis d = box().diagnose(film);
  EXPECT_EQ(faults(d), Names{"poses_late"}) << to_text(d);
}

TEST(doctor, names_poses_in_millimetres) {
  for (const Studio* sane : {&box(), &room()}) {
    Film film = sane->film;
    each_pose(film, [](const auto& p) { return Transform<Left, Map>{p.rotation, 1000.0 * p.translation}; });
    const Diagnosis d = sane->diagnose(film);
    EXPECT_EQ(faults(d), Names{"poses_millimetres"}) << to_text(d);
  }
}

TEST(doctor, names_poses_with_other_axes) {
  Film film = room().film;
  each_pose(film, [](const auto& p) {  // OpenGL's camera: y up, z backward
    const Quaternion flip{1, 0, 0, 0};
    return Transform<Left, Map>{flip * p.rotation, to_matrix(flip) * p.translation};
  });
  const Diagnosis d = room().diagnose(film);
  EXPECT_EQ(faults(d), Names{"poses_axes"}) << to_text(d);
}

TEST(doctor, names_quaternions_in_the_wrong_order) {
  Film film = box().film;
  each_pose(film, [](const auto& p) {
    const Quaternion& q = p.rotation;  // a file with w first, read as x y z w
    return Transform<Left, Map>{{q.w, q.x, q.y, q.z}, p.translation};
  });
  const Diagnosis d = box().diagnose(film);
  EXPECT_EQ(faults(d), Names{"poses_quaternion"}) << to_text(d);
}

TEST(doctor, does_not_guess_at_poses_that_belong_to_something_else) {
  Film film = box().film;
  for (std::size_t i = 0; i < film.frames.size(); ++i)
    film.frames[i].motion = box().film.frames[(5 * i) % film.frames.size()].motion;
  const Diagnosis d = box().diagnose(film);
  EXPECT_EQ(faults(d), Names{"poses_unknown"}) << to_text(d);
}

TEST(doctor, says_when_the_eyes_see_nothing_in_common) {
  Film film = box().film;
  for (std::size_t i = 0; i < film.frames.size(); ++i)
    for (std::uint8_t& p : film.frames[i].right.pixels) p = 128;
  const Diagnosis d = examine(film);
  EXPECT_EQ(faults(d), Names{"too_few_points"}) << to_text(d);
}

// The same from files, which `run` refuses: the program opens them all the same, and its exit status tells.
TEST(doctor, the_program_opens_what_cannot_be_right_and_says_why) {
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

// The recordings that the project shares, where they are: chessboard is not rectified and its poses jump, temple_ring
// has gaps in its ring, kitti_grey is a drive.
TEST(doctor, finds_nothing_wrong_with_recordings_that_are_sane) {
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

TEST(doctor, names_the_lens_that_a_real_recording_lacks) {
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
