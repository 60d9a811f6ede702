// How well the pairs of landmarks agree with a rig: distances from their epipolar lines and signs of their disparities.
#pragma once

#include <string>
#include <vector>

#include "accrete/camera.h"
#include "cli/doctor/samples.h"

namespace accrete::cli {

// A change of the images that undoes a fault.
struct ImageChange {
  bool left_columns = false, left_rows = false;    // mirror the left image
  bool right_columns = false, right_rows = false;  // mirror the right one
  bool swap = false;                               // then take the left for the right one

  // Whether the eyes see each other mirrored: pairs are then found in mirrored images only.
  [[nodiscard]] bool relative_columns() const { return left_columns != right_columns; }
  [[nodiscard]] bool relative_rows() const { return left_rows != right_rows; }
  [[nodiscard]] bool none() const { return !left_columns && !left_rows && !right_columns && !right_rows && !swap; }
};

// One pair in the aligned images of a rig.
struct AlignedPair {
  double x_l = 0, y_l = 0, x_r = 0, y_r = 0;  // px
  std::uint32_t sample = 0, index_left = 0, index_right = 0;
  float brightness_left = 0, brightness_right = 0;

  [[nodiscard]] double rows() const { return y_l - y_r; }
  [[nodiscard]] double disparity() const { return x_l - x_r; }
};

struct RigEvidence {
  std::size_t pairs = 0;
  double score = 0;           // mean of max(0, 1 - (rows / 1.5 px)^2), 0 where the disparity is negative: 0 .. 1
  double on_line = 0;         // share of the pairs within 1.5 px of their epipolar line
  double negative = 0;        // share of those with a disparity below -1 px
  double median_rows_px = 0;  // of those within the window, signed and absolute
  double median_abs_rows_px = 0;
  double p90_abs_rows_px = 0;
};

inline constexpr double kOnLinePx = 1.5;
inline constexpr double kWindowPx = 24;

// The pairs of all samples under a rig and a change of images, which decides which eye is whose. Pairs that a camera
// model cannot take are left out of the list and counted in `pairs` of the evidence.
struct RigView {
  std::vector<AlignedPair> pairs;
  std::size_t all = 0;
};
// `stereo`: the pairs per sample, in pixels of the images as they are.
[[nodiscard]] RigView look(const std::vector<std::vector<Pair>>& stereo, const StereoRig& rig,
                           const ImageChange& change);
[[nodiscard]] RigEvidence weigh(const RigView& view);

// A pixel of an eye in its aligned image; false outside the domain of its model.
[[nodiscard]] bool to_aligned(const Camera& camera, const Mat3& R_a_c, double focal_px, const Pixel& p, double& x,
                              double& y);

}  // namespace accrete::cli
