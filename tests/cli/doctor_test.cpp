// Rigs that are broken on purpose: each fault is named, and sane rigs have none.
#include "cli/doctor/doctor_command.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "cli/doctor/doctor_report.h"
#include "cli/film.h"

namespace accrete::cli {
namespace {

// Steps of one, two and three frames, so that a pose too late is not the next pose of a steady turn.
const std::vector<std::uint64_t> kUneven{0, 1, 3, 4, 6, 9, 10, 13, 14, 16, 19, 20, 22, 25};

const Film& box() {
  static const Film film = film_of_scene("box-plain", kUneven);
  return film;
}
const Film& room() {
  static const Film film = film_of_scene("room", {0, 4, 6, 12, 16, 18, 24, 30, 33, 38, 44, 46});
  return film;
}

// What the doctor finds, in the order in which it says so.
std::vector<std::string> faults(const Diagnosis& diagnosis) {
  std::vector<std::string> names;
  for (const DoctorFinding& f : diagnosis.findings) names.push_back(f.fault);
  return names;
}
std::vector<std::string> faults(const Film& film) { return faults(examine(film)); }
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

GreyImage half_size(const GreyImage& image) {
  GreyImage out{image.width_px / 2, image.height_px / 2, {}};
  for (int y = 0; y < out.height_px; ++y)
    for (int x = 0; x < out.width_px; ++x)
      out.pixels.push_back(static_cast<std::uint8_t>((image.at(2 * x, 2 * y) + image.at(2 * x + 1, 2 * y) +
                                                      image.at(2 * x, 2 * y + 1) + image.at(2 * x + 1, 2 * y + 1) + 2) /
                                                     4));
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
  for (const Film* film : {&box(), &room()}) {
    const Diagnosis d = examine(*film);
    EXPECT_EQ(faults(d), Names{}) << to_text(d);
    Film without = *film;
    without.has_poses = false;
    EXPECT_EQ(faults(without), Names{});
  }
}

TEST(doctor, names_a_baseline_of_the_wrong_sign) {
  for (const Film* sane : {&box(), &room()}) {
    Film film = *sane;
    film.rig.T_r_l.translation = -1.0 * film.rig.T_r_l.translation;
    const Diagnosis d = examine(film);
    ASSERT_EQ(faults(d), Names{"baseline_sign"}) << to_text(d);
  }
}

TEST(doctor, names_inverse_extrinsics) {
  Film film = room();
  const auto inverse = film.rig.T_r_l.inverse();
  film.rig.T_r_l = {inverse.rotation, inverse.translation};
  const Diagnosis d = examine(film);
  EXPECT_EQ(faults(d), Names{"inverse_extrinsics"}) << to_text(d);
}

TEST(doctor, names_a_transposed_rotation) {
  Film film = room();
  film.rig.T_r_l.rotation = conjugate(film.rig.T_r_l.rotation);
  const Diagnosis d = examine(film);
  EXPECT_EQ(faults(d), Names{"inverse_extrinsics"}) << to_text(d);
}

TEST(doctor, names_swapped_eyes) {
  for (const Film* sane : {&box(), &room()}) {
    Film film = *sane;
    for (FilmFrame& frame : film.frames) std::swap(frame.left, frame.right);
    const Diagnosis d = examine(film);
    EXPECT_EQ(faults(d), Names{"swapped_eyes"}) << to_text(d);
  }
}

TEST(doctor, names_millimetres) {
  Film film = box();
  film.rig.T_r_l.translation = 1000.0 * film.rig.T_r_l.translation;
  const Diagnosis d = examine(film);
  EXPECT_EQ(faults(d), Names{"millimetres"}) << to_text(d);
}

TEST(doctor, names_a_calibration_for_another_size) {
  Film film = box();
  each_image(film, [](GreyImage& image, bool, std::size_t) { image = half_size(image); });
  for (Camera* camera : {&film.rig.left, &film.rig.right}) {
    camera->width_px /= 2;
    camera->height_px /= 2;
  }
  const Diagnosis unstated = examine(film);
  EXPECT_EQ(faults(unstated), Names{"image_size"}) << to_text(unstated);
  film.calibrated_width_px = 640;
  film.calibrated_height_px = 480;
  const Diagnosis stated = examine(film);
  EXPECT_EQ(faults(stated), Names{"image_size"}) << to_text(stated);
  EXPECT_NE(stated.findings[0].advice.find("by 0.5 "), std::string::npos) << to_text(stated);
}

TEST(doctor, names_distortion_that_is_removed_twice) {
  Film film = room();
  for (Camera* camera : {&film.rig.left, &film.rig.right})
    *camera = with_lens(*camera, Distortion::kBrownConrady, {-0.3, 0.1});
  const Diagnosis d = examine(film);
  ASSERT_EQ(faults(d), Names{"distortion"}) << to_text(d);
  EXPECT_NE(d.findings[0].what.find("second time"), std::string::npos) << to_text(d);
}

TEST(doctor, names_distortion_that_is_ignored) {
  Film film = room();
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
    Film film = box();
    each_image(film, [rows](GreyImage& image, bool right, std::size_t) {
      if (right) image = moved_down(image, rows);
    });
    const Diagnosis d = examine(film);
    ASSERT_EQ(faults(d), Names{"vertical_offset"}) << to_text(d);
    EXPECT_NE(d.findings[0].what.find(rows < 0 ? "3.0 px too high" : "3.0 px too low"), std::string::npos) << to_text(d);
  }
}

TEST(doctor, names_the_camera_that_is_a_frame_late) {
  for (const bool right : {true, false}) {
    Film film = box();
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
  Film film = box();
  each_image(film, [](GreyImage& image, bool right, std::size_t frame) {
    for (std::uint8_t& p : image.pixels)
      if (right) p = static_cast<std::uint8_t>(std::min(255.0, p * (0.8 + 0.03 * static_cast<double>(frame))));
  });
  const Diagnosis d = examine(film);
  EXPECT_EQ(faults(d), Names{"exposure_drift"}) << to_text(d);
}

TEST(doctor, names_exposure_that_differs) {
  Film film = box();
  each_image(film, [](GreyImage& image, bool right, std::size_t) {
    for (std::uint8_t& p : image.pixels)
      if (right) p = static_cast<std::uint8_t>(0.6 * p);
  });
  const Diagnosis d = examine(film);
  EXPECT_EQ(faults(d), Names{"exposure_difference"}) << to_text(d);
}

TEST(doctor, names_mirrored_images) {
  for (const auto& [left, right] : {std::pair{false, true}, std::pair{true, false}, std::pair{true, true}}) {
    Film film = box();
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
  Film film = box();
  each_image(film, [](GreyImage& image, bool right, std::size_t) {
    if (right) image = mirrored(image, true, true);
  });
  const Diagnosis d = examine(film);
  ASSERT_EQ(faults(d), Names{"mirrored"}) << to_text(d);
  EXPECT_NE(d.findings[0].what.find("upside down"), std::string::npos) << to_text(d);
}

TEST(doctor, names_inverse_poses) {
  for (const Film* sane : {&box(), &room()}) {
    Film film = *sane;
    each_pose(film, [](const auto& p) { return retag<Left, Map>(p.inverse()); });
    const Diagnosis d = examine(film);
    EXPECT_EQ(faults(d), Names{"poses_inverse"}) << to_text(d);
  }
}

TEST(doctor, names_poses_that_are_a_frame_late) {
  Film film = box();
  for (std::size_t i = film.frames.size() - 1; i > 0; --i) film.frames[i].motion = film.frames[i - 1].motion;
  film.frames.erase(film.frames.begin());
  const Diagnosis d = examine(film);
  EXPECT_EQ(faults(d), Names{"poses_late"}) << to_text(d);
}

TEST(doctor, names_poses_in_millimetres) {
  for (const Film* sane : {&box(), &room()}) {
    Film film = *sane;
    each_pose(film, [](const auto& p) { return Transform<Left, Map>{p.rotation, 1000.0 * p.translation}; });
    const Diagnosis d = examine(film);
    EXPECT_EQ(faults(d), Names{"poses_millimetres"}) << to_text(d);
  }
}

TEST(doctor, names_poses_with_other_axes) {
  Film film = room();
  each_pose(film, [](const auto& p) {  // OpenGL's camera: y up, z backward
    const Quaternion flip{1, 0, 0, 0};
    return Transform<Left, Map>{flip * p.rotation, to_matrix(flip) * p.translation};
  });
  const Diagnosis d = examine(film);
  EXPECT_EQ(faults(d), Names{"poses_axes"}) << to_text(d);
}

TEST(doctor, names_quaternions_in_the_wrong_order) {
  Film film = box();
  each_pose(film, [](const auto& p) {
    const Quaternion& q = p.rotation;  // a file with w first, read as x y z w
    return Transform<Left, Map>{{q.w, q.x, q.y, q.z}, p.translation};
  });
  const Diagnosis d = examine(film);
  EXPECT_EQ(faults(d), Names{"poses_quaternion"}) << to_text(d);
}

TEST(doctor, does_not_guess_at_poses_that_belong_to_something_else) {
  Film film = box();
  std::reverse(film.frames.begin(), film.frames.end());
  std::vector<Motion> motions;
  for (const FilmFrame& f : film.frames) motions.push_back(f.motion);
  std::reverse(film.frames.begin(), film.frames.end());
  for (std::size_t i = 0; i < motions.size(); ++i)
    film.frames[i].motion.T_l_m = motions[(5 * i) % motions.size()].T_l_m;
  const Diagnosis d = examine(film);
  EXPECT_EQ(faults(d), Names{"poses_unknown"}) << to_text(d);
}

TEST(doctor, says_when_the_eyes_see_nothing_in_common) {
  Film film = box();
  const Film other = room();
  for (std::size_t i = 0; i < film.frames.size(); ++i)
    for (std::uint8_t& p : film.frames[i].right.pixels) p = 128;
  const Diagnosis d = examine(film);
  EXPECT_EQ(faults(d), Names{"too_few_points"}) << to_text(d);
}

}  // namespace
}  // namespace accrete::cli
