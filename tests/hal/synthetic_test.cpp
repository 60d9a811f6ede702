// The synthetic scene: its truth is where its pictures say, and its parts behave as they are said to.
#include "accrete/hal/synthetic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "hal/synthetic_images.h"

namespace accrete::hal {
namespace {

SyntheticOptions quiet(int frames = 60) {
  SyntheticOptions o;
  o.frames = frames;
  o.noise_levels = 0;
  return o;
}

double distance2(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]);
}

struct Tally {
  int count = 0, wrong_side = 0;
  double sum_offset = 0, worst = 0;

  void add(const Step& step, const TruthSegment& truth) {
    ++count;
    sum_offset += step.offset_px;
    worst = std::max(worst, std::abs(step.offset_px));
    double agreement = 0;
    for (std::size_t c = 0; c < 3; ++c) agreement += (step.left[c] - step.right[c]) * (truth.left[c] - truth.right[c]);
    wrong_side += agreement > 0 ? 0 : 1;
  }
  void expect(int at_least) const {
    EXPECT_GE(count, at_least);
    EXPECT_LT(worst, 0.15);
    EXPECT_LT(std::abs(sum_offset / count), 0.01);
    EXPECT_EQ(wrong_side, 0);
  }
};

// Cosine of the view onto a segment's surface.
double facing(const Eye& eye, const Mat3& R, const TruthSegment& s, const Vec3& middle_l) {
  const Vec3 from = eye.T_c_l.inverse().translation - middle_l;
  return dot(R * s.normal, (1 / norm(from)) * from);
}

TEST(Synthetic, TruthProjectsOntoTheStepsInBothImages) {
  const Film film = shoot("box-plain", quiet(), 5);
  Tally tally[2];
  for (const Shot& shot : film.shots) {
    const Mat3 R = to_matrix(shot.motion.T_l_m.rotation);
    for (const TruthSegment& s : film.truth.edges) {
      if (s.kind != TruthKind::kAlbedo) continue;
      const Vec3 p0 = shot.motion.T_l_m * s.p0, p1 = shot.motion.T_l_m * s.p1, middle = 0.5 * (p0 + p1);
      int side = 0;
      for (const Eye& eye : eyes(film, shot)) {
        Tally& t = tally[side++];
        if (facing(eye, R, s, middle) < 0.6) continue;  // flatter, and the neighbour lies within reach
        const auto step = measure(eye, p0, p1);
        ASSERT_TRUE(step.has_value());
        if (step->length_px > 10 && step->clean) t.add(*step, s);
      }
    }
  }
  tally[0].expect(200);
  tally[1].expect(200);
}

TEST(Synthetic, CreasesProjectOntoTheStepsToo) {
  const Film film = shoot("box-plain", quiet(), 5);
  Tally tally;
  for (const Shot& shot : film.shots) {
    const Mat3 R = to_matrix(shot.motion.T_l_m.rotation);
    for (TruthSegment s : film.truth.edges) {
      if (s.kind != TruthKind::kCrease) continue;
      const Vec3 p0 = shot.motion.T_l_m * s.p0, p1 = shot.motion.T_l_m * s.p1, middle = 0.5 * (p0 + p1);
      for (const Eye& eye : eyes(film, shot)) {
        TruthSegment other = s;
        other.normal = s.normal_right;
        // Both faces well in view: otherwise the background is one of the two sides.
        if (facing(eye, R, s, middle) < 0.3 || facing(eye, R, other, middle) < 0.3) continue;
        const auto step = measure(eye, p0, p1);
        ASSERT_TRUE(step.has_value());
        if (step->clean && std::sqrt(distance2(step->left, step->right)) > 0.1) tally.add(*step, s);
      }
    }
  }
  tally.expect(40);
}

TEST(Synthetic, BackgroundTruthIsInTheLeftCamerasFrame) {
  const Film film = shoot("box-plain", quiet(4));
  Tally tally;
  for (const TruthSegment& s : film.truth.background) {
    if (s.visible_both < 0.999 || s.kind != TruthKind::kAlbedo) continue;
    for (const Eye& eye : eyes(film, film.shots[2]))
      if (const auto step = measure(eye, s.p0, s.p1); step && step->clean) tally.add(*step, s);
  }
  tally.expect(40);
}

TEST(Synthetic, RoomMovesTheCamerasAndItsRigIsAskew) {
  const Film film = shoot("room", quiet(9));
  EXPECT_GT(rotation_angle(film.rig.T_r_l.rotation), 0.05);
  EXPECT_EQ(validate(film.rig), Status::kOk);
  Tally tally;
  for (const Shot& shot : film.shots) {
    EXPECT_EQ(shot.motion.mode, MotionMode::kCameraMoves);
    EXPECT_EQ(validate(shot.motion), Status::kOk);
    for (const TruthSegment& s : film.truth.edges) {
      if (s.visible_both < 0.999 || s.kind != TruthKind::kAlbedo) continue;
      const Vec3 p0 = shot.motion.T_l_m * s.p0, p1 = shot.motion.T_l_m * s.p1;
      for (const Eye& eye : eyes(film, shot)) {
        if (facing(eye, to_matrix(shot.motion.T_l_m.rotation), s, 0.5 * (p0 + p1)) < 0.6) continue;
        if (const auto step = measure(eye, p0, p1); step && step->clean) tally.add(*step, s);
      }
    }
  }
  tally.expect(200);
  const Vec3 first = film.shots.front().motion.T_l_m.inverse().translation,
             last = film.shots.back().motion.T_l_m.inverse().translation;
  EXPECT_NEAR(norm(first - last), 2 * 0.6 * std::sin(20 * 3.14159265 / 180), 0.01);
}

TEST(Synthetic, CorrespondingPointsLieOnTheSameRow) {
  const Film film = shoot("box-plain", quiet(3));
  for (const Shot& shot : film.shots) {
    const auto both = eyes(film, shot);
    for (const TruthSegment& s : film.truth.edges) {
      const Vec3 p = shot.motion.T_l_m * s.p0;
      const Pixel l = both[0].project(p), r = both[1].project(p);
      EXPECT_NEAR(l.y, r.y, 1e-9);
      EXPECT_NEAR(l.x - r.x, 800 * 0.12 / p[2], 1e-9);
    }
  }
}

// IEC 61966-2-1.
double decoded(double srgb) { return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4); }

TEST(Synthetic, TruthColoursAreTheMeanLightOfWhatIsSeen) {
  SyntheticOptions o = quiet(8);
  o.degrees_per_frame = 3;  // so little that a face which is well in view stays so
  const Film film = shoot("box-plain", o);
  int judged = 0;
  for (const TruthSegment& s : film.truth.edges) {
    if (s.kind != TruthKind::kAlbedo) continue;
    std::array<double, 3> left{}, right{};
    int count = 0;
    bool clean = true;  // in every frame that shows it, it is wide enough to be measured
    for (const Shot& shot : film.shots) {
      const Vec3 p0 = shot.motion.T_l_m * s.p0, p1 = shot.motion.T_l_m * s.p1;
      const Eye eye = eyes(film, shot)[0];
      const double cosine = facing(eye, to_matrix(shot.motion.T_l_m.rotation), s, 0.5 * (p0 + p1));
      if (cosine <= 0) continue;
      const auto step = measure(eye, p0, p1);
      clean = clean && cosine > 0.45 && step.has_value() && step->clean;
      if (!clean) break;
      ++count;
      for (std::size_t c = 0; c < 3; ++c) left[c] += decoded(step->left[c]), right[c] += decoded(step->right[c]);
    }
    if (!clean || count == 0) continue;
    ++judged;
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(left[c] / count, s.left[c], 0.01);
      EXPECT_NEAR(right[c] / count, s.right[c], 0.01);
    }
    EXPECT_EQ(s.visible, 1);
    EXPECT_EQ(count, 8);
  }
  EXPECT_GE(judged, 15);
}

TEST(Synthetic, VisibleCountsTheFramesThatShowTheSurface) {
  const Film film = shoot("box-plain", quiet());
  bool seen[6] = {};
  for (const TruthSegment& s : film.truth.edges) {
    int left = 0, both = 0;
    for (const Shot& shot : film.shots) {
      const Vec3 middle = shot.motion.T_l_m * (0.5 * (s.p0 + s.p1));
      const Mat3 R = to_matrix(shot.motion.T_l_m.rotation);
      TruthSegment other = s;
      other.normal = s.normal_right;
      bool in[2] = {};
      int side = 0;
      for (const Eye& eye : eyes(film, shot))
        in[side++] = facing(eye, R, s, middle) > 0 || facing(eye, R, other, middle) > 0;
      left += in[0] ? 1 : 0;
      both += in[0] && in[1] ? 1 : 0;
    }
    EXPECT_NEAR(s.visible, left / 60.0, 1e-9);
    EXPECT_NEAR(s.visible_both, both / 60.0, 1e-9);
    for (std::size_t k = 0; k < 3; ++k)
      if (s.kind == TruthKind::kAlbedo && std::abs(s.normal[k]) > 0.5 && both > 5)
        seen[2 * k + (s.normal[k] > 0)] = true;
  }
  EXPECT_EQ(std::count(std::begin(seen), std::end(seen), true), 6) << "a face of the box is never seen";
}

TEST(Synthetic, SideColoursFollowTheConventionOfTheNormal) {
  Truth truth;
  ASSERT_TRUE(synthetic_truth("box-plain", quiet(2), truth).ok());
  for (const TruthSegment& s : truth.edges) {
    const Vec3 t = (1 / norm(s.p1 - s.p0)) * (s.p1 - s.p0), right = cross(t, s.normal);
    EXPECT_NEAR(norm(right), 1, 1e-9);  // the normal stands on the edge
    if (s.kind == TruthKind::kCrease) {
      EXPECT_NEAR(dot(right, s.normal_right), 1, 1e-9);
    } else {
      EXPECT_EQ(s.normal, s.normal_right);
    }
  }
}

// Where two pictures differ: a box of pixels, or nothing.
struct Difference {
  int x0 = 1 << 20, x1 = -1, y0 = 1 << 20, y1 = -1;
  int pixels = 0;
};
Difference difference(const Picture& a, const Picture& b) {
  Difference d;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      int most = 0;
      for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(a.at(x, y, c) - b.at(x, y, c)));
      if (most <= 1) continue;  // sums along a row may round otherwise
      d.x0 = std::min(d.x0, x), d.x1 = std::max(d.x1, x), d.y0 = std::min(d.y0, y), d.y1 = std::max(d.y1, y);
      ++d.pixels;
    }
  }
  return d;
}

TEST(Synthetic, GripperMovesAlongInsideItsExcludedBoxes) {
  const Film with = shoot("box-gripper", quiet(), 10), without = shoot("box-plain", quiet(), 10);
  ASSERT_EQ(with.truth.excluded.size(), 3U);
  EXPECT_TRUE(without.truth.excluded.empty());
  int filled = 0;
  for (std::size_t i = 0; i < with.shots.size(); ++i) {
    int side = 0;
    for (const Eye& eye : eyes(with, with.shots[i])) {
      const Shot& bare = without.shots[i];
      const Difference d = difference(eye.picture, side++ == 0 ? bare.left : bare.right);
      EXPECT_GT(d.pixels, 500);
      double x0 = 1e9, x1 = -1e9, y0 = 1e9, y1 = -1e9;
      for (const TruthBox& box : with.truth.excluded) {
        for (unsigned k = 0; k < 8; ++k) {
          const Pixel p = eye.project(with.shots[i].motion.T_l_m * Vec3{k & 1U ? box.min[0] : box.max[0],
                                                                        k & 2U ? box.min[1] : box.max[1],
                                                                        k & 4U ? box.min[2] : box.max[2]});
          x0 = std::min(x0, p.x), x1 = std::max(x1, p.x), y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
        }
      }
      EXPECT_GE(d.x0, x0);
      EXPECT_LE(d.x1, x1);
      EXPECT_GE(d.y0, y0);
      EXPECT_LE(d.y1, y1);
      filled += d.x1 - d.x0 > 0.8 * (x1 - x0) && d.y1 - d.y0 > 0.8 * (y1 - y0) ? 1 : 0;
    }
  }
  EXPECT_GE(filled, 6) << "of 12 pictures; in the others it stands partly behind the box";
  const auto inside = [&](const TruthSegment& s) {
    const Vec3 m = 0.5 * (s.p0 + s.p1);
    return std::any_of(with.truth.excluded.begin(), with.truth.excluded.end(), [&](const TruthBox& b) {
      return m[0] >= b.min[0] && m[0] <= b.max[0] && m[1] >= b.min[1] && m[1] <= b.max[1] && m[2] >= b.min[2] &&
             m[2] <= b.max[2];
    });
  };
  EXPECT_TRUE(std::none_of(with.truth.edges.begin(), with.truth.edges.end(), inside));
  EXPECT_TRUE(std::all_of(with.truth.extra.begin(), with.truth.extra.end(), inside));
  EXPECT_GT(with.truth.extra.size(), 50U);
}

TEST(Synthetic, OccluderPassesAndHides) {
  const Film with = shoot("box-occluded", quiet(), 6), without = shoot("box-plain", quiet(), 6);
  int before = -1000;
  for (std::size_t i = 0; i < with.shots.size(); ++i) {
    const Difference d = difference(with.shots[i].left, without.shots[i].left);
    ASSERT_GT(d.pixels, 0);
    EXPECT_GE(d.x1 - d.x0, 40);  // 18 mm at 0.36 m
    EXPECT_LE(d.x1 - d.x0, 52);
    EXPECT_EQ(d.y1 - d.y0, 479);
    EXPECT_GT(d.x0, before + 10);
    before = d.x0;
  }
  ASSERT_EQ(with.truth.edges.size(), without.truth.edges.size());
  double lost = 0, had = 0;
  for (std::size_t k = 0; k < with.truth.edges.size(); ++k) {
    EXPECT_LE(with.truth.edges[k].visible_both, without.truth.edges[k].visible_both + 1e-9);
    had += without.truth.edges[k].visible_both;
    lost += without.truth.edges[k].visible_both - with.truth.edges[k].visible_both;
  }
  EXPECT_GT(lost / had, 0.1);
  EXPECT_LT(lost / had, 0.5);
}

TEST(Synthetic, TheDefaultSceneHasBothAndOptionsOverrideNames) {
  SyntheticOptions o = quiet(5);
  const Film box = shoot("box", o);
  o.gripper = true;
  const Film occluded = shoot("box-occluded", o);
  EXPECT_EQ(box.shots[3].left.rgb, occluded.shots[3].left.rgb);
  o.gripper = o.occluder = false;
  EXPECT_EQ(shoot("box", o).shots[3].right.rgb, shoot("box-plain", quiet(5)).shots[3].right.rgb);
}

}  // namespace
}  // namespace accrete::hal
