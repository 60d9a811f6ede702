// Cameras and calibrations that are broken on purpose: each fault is named, and sane rigs have none.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>

#include "cli/doctor/doctor_report.h"
#include "cli/studio.h"

namespace accrete::cli {
namespace {

void each_image(Film& film, const std::function<void(GreyImage&, bool right, std::size_t frame)>& change) {
  for (std::size_t i = 0; i < film.frames.size(); ++i) {
    change(film.frames[i].left, false, i);
    change(film.frames[i].right, true, i);
  }
}
GreyImage moved_down(const GreyImage& image, int rows) {
  GreyImage out = image;
  for (int y = 0; y < image.height_px; ++y)
    for (int x = 0; x < image.width_px; ++x)
      out.pixels[static_cast<std::size_t>(y * image.width_px + x)] =
          static_cast<std::uint8_t>(image.at(x, std::clamp(y - rows, 0, image.height_px - 1)));
  return out;
}

// Where a pinhole saw what a camera with a lens sees in each of its pixels.
std::vector<Pixel> seen_by_pinhole(const Camera& pinhole, const Camera& lens) {
  std::vector<Pixel> places;
  for (int y = 0; y < lens.height_px; ++y)
    for (int x = 0; x < lens.width_px; ++x) {
      const auto ray = unproject(lens, {static_cast<double>(x), static_cast<double>(y)});
      const auto from = ray.ok() ? project(pinhole, ray.value()) : Result<Pixel>(Status::kInvalidArgument);
      places.push_back(from.ok() ? from.value() : Pixel{});
    }
  return places;
}

GreyImage through_lens(const GreyImage& image, const std::vector<Pixel>& places) {
  GreyImage out = image;
  for (std::size_t n = 0; n < places.size(); ++n) {
    const double u = std::clamp(places[n].x, 0.0, image.width_px - 1.001);
    const double v = std::clamp(places[n].y, 0.0, image.height_px - 1.001);
    const int i = static_cast<int>(u), j = static_cast<int>(v);
    const double a = u - i, b = v - j;
    out.pixels[n] = static_cast<std::uint8_t>((1 - b) * ((1 - a) * image.at(i, j) + a * image.at(i + 1, j)) +
                                              b * ((1 - a) * image.at(i, j + 1) + a * image.at(i + 1, j + 1)) + 0.5);
  }
  return out;
}

Camera with_lens(Camera camera, Distortion model, std::array<double, 12> coefficients) {
  camera.distortion = model;
  camera.coefficients = coefficients;
  return camera;
}

TEST(doctor_rig, finds_nothing_wrong_with_the_sane_scenes) {
  for (const Studio* studio : {&box(), &room()}) {
    const Diagnosis d = examine(studio->film);
    EXPECT_EQ(faults(d), Names{}) << to_text(d);
    Film without = studio->film;
    without.has_poses = false;
    EXPECT_EQ(faults(studio->diagnose(without)), Names{});
  }
}

TEST(doctor_rig, names_a_baseline_of_the_wrong_sign) {
  for (const Studio* sane : {&box(), &room()}) {
    Film film = sane->film;
    film.rig.T_r_l.translation = -1.0 * film.rig.T_r_l.translation;
    const Diagnosis d = sane->diagnose(film);
    ASSERT_EQ(faults(d), Names{"baseline_sign"}) << to_text(d);
  }
}

TEST(doctor_rig, names_inverse_extrinsics) {
  Film film = room().film;
  const auto inverse = film.rig.T_r_l.inverse();
  film.rig.T_r_l = {inverse.rotation, inverse.translation};
  const Diagnosis d = room().diagnose(film);
  EXPECT_EQ(faults(d), Names{"inverse_extrinsics"}) << to_text(d);
}

TEST(doctor_rig, names_a_transposed_rotation) {
  Film film = room().film;
  film.rig.T_r_l.rotation = conjugate(film.rig.T_r_l.rotation);
  const Diagnosis d = room().diagnose(film);
  EXPECT_EQ(faults(d), Names{"inverse_extrinsics"}) << to_text(d);
}

TEST(doctor_rig, names_swapped_eyes) {
  for (const Studio* sane : {&box(), &room()}) {
    Film film = sane->film;
    for (FilmFrame& frame : film.frames) std::swap(frame.left, frame.right);
    const Diagnosis d = examine(film);
    EXPECT_EQ(faults(d), Names{"swapped_eyes"}) << to_text(d);
  }
}

TEST(doctor_rig, names_eyes_that_are_exchanged_in_images_and_calibration_alike) {
  Film film = room().film;
  for (FilmFrame& frame : film.frames) std::swap(frame.left, frame.right);
  std::swap(film.rig.left, film.rig.right);
  const auto inverse = film.rig.T_r_l.inverse();
  film.rig.T_r_l = {inverse.rotation, inverse.translation};
  film.has_poses = false;
  const Diagnosis d = examine(film);
  ASSERT_EQ(faults(d), Names{"swapped_eyes"}) << to_text(d);
  EXPECT_NE(d.findings[0].what.find("alike"), std::string::npos) << to_text(d);
}

TEST(doctor_rig, names_intrinsics_that_are_exchanged) {
  Film film = room().film;  // its cameras have different focal lengths
  std::swap(film.rig.left, film.rig.right);
  const Diagnosis d = room().diagnose(film);
  EXPECT_EQ(faults(d), Names{"intrinsics_exchanged"}) << to_text(d);
}

TEST(doctor_rig, names_millimetres) {
  Film film = box().film;
  film.rig.T_r_l.translation = 1000.0 * film.rig.T_r_l.translation;
  const Diagnosis d = box().diagnose(film);
  EXPECT_EQ(faults(d), Names{"millimetres"}) << to_text(d);
}

TEST(doctor_rig, names_a_calibration_for_another_size) {
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

TEST(doctor_rig, names_distortion_that_is_removed_twice) {
  Film film = room().film;
  for (Camera* camera : {&film.rig.left, &film.rig.right})
    *camera = with_lens(*camera, Distortion::kBrownConrady, {-0.3, 0.1});
  const Diagnosis d = room().diagnose(film);
  ASSERT_EQ(faults(d), Names{"distortion"}) << to_text(d);
  EXPECT_NE(d.findings[0].what.find("second time"), std::string::npos) << to_text(d);
}

TEST(doctor_rig, names_distortion_that_is_ignored) {
  Film film = room().film;
  const auto lens = [](const Camera& pinhole) {
    return seen_by_pinhole(pinhole, with_lens(pinhole, Distortion::kBrownConrady, {-0.35}));
  };
  const auto left = lens(film.rig.left), right = lens(film.rig.right);
  each_image(film, [&](GreyImage& image, bool is_right, std::size_t) {
    image = through_lens(image, is_right ? right : left);
  });
  const Diagnosis d = examine(film);
  EXPECT_EQ(faults(d), Names{"distortion"}) << to_text(d);
}

TEST(doctor_rig, names_a_vertical_offset_of_three_pixels) {
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

TEST(doctor_rig, names_mirrored_images) {
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

TEST(doctor_rig, names_an_eye_that_is_upside_down) {
  Film film = box().film;
  each_image(film, [](GreyImage& image, bool right, std::size_t) {
    if (right) image = mirrored(image, true, true);
  });
  const Diagnosis d = examine(film);
  ASSERT_EQ(faults(d), Names{"mirrored"}) << to_text(d);
  EXPECT_NE(d.findings[0].what.find("upside down"), std::string::npos) << to_text(d);
}

TEST(doctor_rig, says_when_the_eyes_see_nothing_in_common) {
  Film film = box().film;
  for (std::size_t i = 0; i < film.frames.size(); ++i)
    for (std::uint8_t& p : film.frames[i].right.pixels) p = 128;
  const Diagnosis d = examine(film);
  EXPECT_EQ(faults(d), Names{"too_few_points"}) << to_text(d);
}

}  // namespace
}  // namespace accrete::cli
