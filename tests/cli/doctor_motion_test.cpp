// Times, exposures and poses that are broken on purpose: each fault is named.
#include <gtest/gtest.h>

#include <algorithm>
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
void each_pose(Film& film, const std::function<Transform<Left, Map>(const Transform<Left, Map>&)>& change) {
  for (FilmFrame& frame : film.frames) frame.motion.T_l_m = change(frame.motion.T_l_m);
}

TEST(doctor_motion, names_the_camera_that_is_a_frame_late) {
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

TEST(doctor_motion, names_exposure_that_drifts_apart) {
  Film film = box().film;
  each_image(film, [](GreyImage& image, bool right, std::size_t frame) {
    for (std::uint8_t& p : image.pixels)
      if (right) p = static_cast<std::uint8_t>(std::min(255.0, p * (0.8 + 0.03 * static_cast<double>(frame))));
  });
  const Diagnosis d = examine(film);
  EXPECT_EQ(faults(d), Names{"exposure_drift"}) << to_text(d);
}

TEST(doctor_motion, names_exposure_that_differs) {
  Film film = box().film;
  each_image(film, [](GreyImage& image, bool right, std::size_t) {
    for (std::uint8_t& p : image.pixels)
      if (right) p = static_cast<std::uint8_t>(0.6 * p);
  });
  const Diagnosis d = examine(film);
  EXPECT_EQ(faults(d), Names{"exposure_difference"}) << to_text(d);
}

TEST(doctor_motion, names_inverse_poses) {
  for (const Studio* sane : {&box(), &room()}) {
    Film film = sane->film;
    each_pose(film, [](const auto& p) { return retag<Left, Map>(p.inverse()); });
    const Diagnosis d = sane->diagnose(film);
    EXPECT_EQ(faults(d), Names{"poses_inverse"}) << to_text(d);
  }
}

TEST(doctor_motion, names_poses_that_are_a_frame_late) {
  Film film = box().film;
  for (std::size_t i = film.frames.size() - 1; i > 0; --i) film.frames[i].motion = film.frames[i - 1].motion;
  const Diagnosis d = box().diagnose(film);
  EXPECT_EQ(faults(d), Names{"poses_late"}) << to_text(d);
}

TEST(doctor_motion, names_poses_that_are_a_frame_early) {
  Film film = box().film;
  for (std::size_t i = 0; i + 1 < film.frames.size(); ++i) film.frames[i].motion = film.frames[i + 1].motion;
  film.frames.pop_back();
  const Diagnosis d = box().diagnose(film);
  EXPECT_EQ(faults(d), Names{"poses_early"}) << to_text(d);
}

TEST(doctor_motion, names_stamps_that_lie_apart) {
  Film film = box().film;
  film.right_later_ns = 12'000'000;  // of 33 ms
  const Diagnosis d = examine(film);
  EXPECT_EQ(faults(d), Names{"unsynchronised"}) << to_text(d);
}

TEST(doctor_motion, names_poses_of_another_scale) {
  Film film = room().film;
  each_pose(film, [](const auto& p) { return Transform<Left, Map>{p.rotation, 0.001 * p.translation}; });
  const Diagnosis d = room().diagnose(film);
  EXPECT_EQ(faults(d), Names{"poses_scale"}) << to_text(d);
}

TEST(doctor_motion, names_poses_of_the_right_eye) {
  Film film = box().film;
  each_pose(film, [&film](const auto& p) { return retag<Left, Map>(retag<Left, Left>(film.rig.T_r_l) * p); });
  const Diagnosis d = box().diagnose(film);
  EXPECT_EQ(faults(d), Names{"poses_of_right_eye"}) << to_text(d);
}

TEST(doctor_motion, names_poses_in_millimetres) {
  for (const Studio* sane : {&box(), &room()}) {
    Film film = sane->film;
    each_pose(film, [](const auto& p) { return Transform<Left, Map>{p.rotation, 1000.0 * p.translation}; });
    const Diagnosis d = sane->diagnose(film);
    EXPECT_EQ(faults(d), Names{"poses_millimetres"}) << to_text(d);
  }
}

TEST(doctor_motion, names_poses_with_other_axes) {
  Film film = room().film;
  each_pose(film, [](const auto& p) {  // OpenGL's camera: y up, z backward
    const Quaternion flip{1, 0, 0, 0};
    return Transform<Left, Map>{flip * p.rotation, to_matrix(flip) * p.translation};
  });
  const Diagnosis d = room().diagnose(film);
  EXPECT_EQ(faults(d), Names{"poses_axes"}) << to_text(d);
}

TEST(doctor_motion, names_quaternions_in_the_wrong_order) {
  Film film = box().film;
  each_pose(film, [](const auto& p) {
    const Quaternion& q = p.rotation;  // a file with w first, read as x y z w
    return Transform<Left, Map>{{q.w, q.x, q.y, q.z}, p.translation};
  });
  const Diagnosis d = box().diagnose(film);
  EXPECT_EQ(faults(d), Names{"poses_quaternion"}) << to_text(d);
}

TEST(doctor_motion, does_not_guess_at_poses_that_belong_to_something_else) {
  Film film = box().film;
  for (std::size_t i = 0; i < film.frames.size(); ++i)
    film.frames[i].motion = box().film.frames[(5 * i) % film.frames.size()].motion;
  const Diagnosis d = box().diagnose(film);
  EXPECT_EQ(faults(d), Names{"poses_unknown"}) << to_text(d);
}

}  // namespace
}  // namespace accrete::cli
