// Two sane recordings, seen once by the doctor, for tests that break them.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/film.h"

namespace accrete::cli {

// The part of an image that shows the box to both eyes: less to look at.
inline constexpr int kCutX = 120, kCutY = 96, kCutWidth = 400, kCutHeight = 288;

inline GreyImage cut_out(const GreyImage& image) {
  GreyImage out{kCutWidth, kCutHeight, {}};
  for (int y = 0; y < kCutHeight; ++y)
    for (int x = 0; x < kCutWidth; ++x) out.pixels.push_back(static_cast<std::uint8_t>(image.at(x + kCutX, y + kCutY)));
  return out;
}

inline Camera cut_out(Camera camera) {
  camera.width_px = kCutWidth;
  camera.height_px = kCutHeight;
  camera.cx_px -= kCutX;
  camera.cy_px -= kCutY;
  return camera;
}

inline Film cut_out(Film film) {
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
inline const Studio& box() {
  static const Studio studio(
      cut_out(film_of_scene("box-plain", 120, {0, 1, 3, 4, 6, 9, 10, 13, 14, 16, 19, 20, 22, 25})));
  return studio;
}
// Lenses and small rotations show in large images.
inline const Studio& room() {
  static const Studio studio(film_of_scene("room", 16, {0, 1, 3, 4, 6, 8, 9, 11, 13, 14}));
  return studio;
}

// What the doctor finds, in the order in which it says so.
inline std::vector<std::string> faults(const Diagnosis& diagnosis) {
  std::vector<std::string> names;
  for (const DoctorFinding& f : diagnosis.findings) names.push_back(f.fault);
  return names;
}
using Names = std::vector<std::string>;

}  // namespace accrete::cli
