#include "cli/doctor/hypotheses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace accrete::cli {
namespace {

constexpr std::size_t kEnoughPairs = 1500;  // to fit one number: the score then has a standard deviation of 0.01

Transform<Right, Left> with_translation(Transform<Right, Left> t, const Vec3& translation) {
  t.translation = translation;
  return t;
}

bool distorted(const StereoRig& rig) {
  return rig.left.distortion != Distortion::kNone || rig.right.distortion != Distortion::kNone;
}

StereoRig with_lenses(StereoRig rig, Distortion model, double k1) {
  for (Camera* camera : {&rig.left, &rig.right}) {
    camera->distortion = model;
    camera->coefficients = {k1};
  }
  return rig;
}

std::vector<std::vector<Pair>> thinned(const std::vector<std::vector<Pair>>& stereo) {
  std::size_t all = 0, n = 0;
  for (const auto& pairs : stereo) all += pairs.size();
  const std::size_t every = std::max<std::size_t>(1, all / kEnoughPairs);
  std::vector<std::vector<Pair>> out(stereo.size());
  for (std::size_t s = 0; s < stereo.size(); ++s)
    for (const Pair& pair : stereo[s])
      if (n++ % every == 0) out[s].push_back(pair);
  return out;
}

// Where most rows differences lie: the fullest window of 2 px.
double peak_of_rows(const RigView& view) {
  std::vector<double> rows;
  for (const AlignedPair& p : view.pairs)
    if (std::abs(p.rows()) <= kWindowPx) rows.push_back(p.rows());
  std::sort(rows.begin(), rows.end());
  double best = 0;
  std::size_t most = 0;
  for (std::size_t i = 0, j = 0; i < rows.size(); ++i) {
    while (j < rows.size() && rows[j] <= rows[i] + 2) ++j;
    if (j - i <= most) continue;
    most = j - i;
    best = rows[i + (j - i) / 2];
  }
  return best;
}

Hypothesis vertical_offset(const StereoRig& rig, const RigView& view) {
  const double offset = peak_of_rows(view);
  const AlignedRig aligned = align(rig);
  Hypothesis h{"vertical_offset", rig, {}, "", "", true, {}};
  h.rig.right.cy_px -= offset * rig.right.fy_px / aligned.focal_px;
  h.what =
      fmt::format("The right image lies {:.1f} px too {}: after rectification the rows of the two images do not agree.",
                  std::abs(offset), offset > 0 ? "high" : "low");
  h.advice = fmt::format(
      "Calibrate again: a camera has moved, or the images are cut out differently. As a makeshift change cy of the "
      "right camera (M2) from {:.2f} to {:.2f}.",
      rig.right.cy_px, h.rig.right.cy_px);
  return h;
}

// The strength of a lens of one coefficient, the same for both eyes, that explains the pairs best.
Hypothesis unknown_lens(const StereoRig& rig, const std::vector<std::vector<Pair>>& stereo) {
  const auto few = thinned(stereo);
  double best = 0, best_score = -1;
  const auto try_k1 = [&](double k1) {
    const double score = weigh(look(few, with_lenses(rig, Distortion::kBrownConrady, k1), {})).score;
    if (score > best_score) {
      best_score = score;
      best = k1;
    }
  };
  for (int i = -12; i <= 12; ++i) try_k1(0.05 * i);
  const double coarse = best;
  for (int i = -4; i <= 4; ++i) try_k1(coarse + 0.01 * i);
  Hypothesis h{"distortion", with_lenses(rig, Distortion::kBrownConrady, best), {}, "", "", true, {}};
  h.what = fmt::format(
      "The lens distortion of the calibration does not fit the images: one coefficient k1 = {:.2f} for both lenses "
      "explains them much better than what the file says.",
      best);
  h.advice =
      "Calibrate again, and write all coefficients (D1, D2) with the model that they belong to. Were the images "
      "undistorted, or were they not?";
  return h;
}

}  // namespace

std::vector<Hypothesis> lens_hypotheses(const StereoRig& rig, const std::vector<std::vector<Pair>>& stereo) {
  std::vector<Hypothesis> list;
  if (distorted(rig)) {
    list.push_back({"distortion",
                    with_lenses(rig, Distortion::kNone, 0),
                    {},
                    "The images have no lens distortion any more, and the calibration removes it a second time.",
                    "Set D1 and D2 to zeros (the images were undistorted when they were recorded), or record raw "
                    "images.",
                    false,
                    {}});
    StereoRig other = rig;
    bool possible = true;
    for (Camera* camera : {&other.left, &other.right}) {
      for (std::size_t i = 4; i < camera->coefficients.size(); ++i) possible = possible && camera->coefficients[i] == 0;
      camera->distortion =
          camera->distortion == Distortion::kKannalaBrandt ? Distortion::kBrownConrady : Distortion::kKannalaBrandt;
    }
    const bool fisheye = rig.left.distortion == Distortion::kKannalaBrandt;
    if (possible)
      list.push_back({"distortion",
                      other,
                      {},
                      fmt::format("The distortion coefficients are read as {}, and are those of {}.",
                                  fisheye ? "a fisheye's (Kannala-Brandt)" : "radial-tangential (Brown-Conrady)",
                                  fisheye ? "radial-tangential (Brown-Conrady)" : "a fisheye's (Kannala-Brandt)"),
                      fisheye ? "Remove 'model: fisheye' (EuRoC: distortion_model: radial-tangential)."
                              : "Write 'model: fisheye' into the calibration (EuRoC: distortion_model: equidistant).",
                      false,
                      {}});
  }
  list.push_back(unknown_lens(rig, stereo));
  return list;
}

std::vector<Hypothesis> image_hypotheses(const StereoRig& rig) {
  std::vector<Hypothesis> list;
  const auto add = [&](const char* fault, const ImageChange& change, const char* what, const char* advice) {
    list.push_back({fault, rig, change, what, advice, false, {}});
  };
  ImageChange change;
  change.swap = true;
  add("swapped_eyes", change, "Left and right are exchanged: the right image shows what the left camera saw.",
      "Exchange the folders left/ and right/ (or image_0/ and image_1/, cam0/ and cam1/). Keep the calibration.");
  for (const bool right : {true, false}) {
    const char* eye = right ? "right" : "left";
    change = {};
    (right ? change.right_columns : change.left_columns) = true;
    list.push_back({"mirrored",
                    rig,
                    change,
                    fmt::format("The {} image is mirrored, left for right.", eye),
                    fmt::format("Switch off the mirroring of the {} camera, or mirror its images back.", eye),
                    false,
                    {}});
    (right ? change.right_rows : change.left_rows) = true;
    list.push_back({"mirrored",
                    rig,
                    change,
                    fmt::format("The {} image is upside down (turned by 180 degrees).", eye),
                    fmt::format("Turn the {} camera or its images by 180 degrees, or calibrate it as it is.", eye),
                    false,
                    {}});
    (right ? change.right_columns : change.left_columns) = false;
    list.push_back({"mirrored",
                    rig,
                    change,
                    fmt::format("The {} image is flipped, top for bottom.", eye),
                    fmt::format("Switch off the flip of the {} camera, or flip its images back.", eye),
                    false,
                    {}});
  }
  change = {};
  change.left_columns = change.right_columns = true;
  add("mirrored", change, "Both images are mirrored, left for right.",
      "Switch off the mirroring of the cameras, or mirror the images back.");
  return list;
}

std::vector<Hypothesis> rig_hypotheses(const StereoRig& rig, const RigView& view,
                                       const std::vector<std::vector<Pair>>& stereo) {
  std::vector<Hypothesis> list;
  const auto& t = rig.T_r_l;
  StereoRig other = rig;
  other.T_r_l = with_translation(t, -1.0 * t.translation);
  list.push_back({"baseline_sign",
                  other,
                  {},
                  fmt::format("The baseline has the wrong sign: T = ({:.4g}, {:.4g}, {:.4g}) puts every point behind "
                              "the cameras.",
                              t.translation[0], t.translation[1], t.translation[2]),
                  "Negate T (x_right = R x_left + T, so T[0] is negative; KITTI: the last number of P1's first row).",
                  false,
                  {}});
  const auto inverse = t.inverse();
  other.T_r_l = {inverse.rotation, inverse.translation};
  list.push_back({"inverse_extrinsics",
                  other,
                  {},
                  "R and T are those of the left camera seen from the right one, the wrong way round.",
                  "Write R transposed for R, and -R^T T for T: x_right = R x_left + T (EuRoC: T_BS maps camera to "
                  "body).",
                  false,
                  {}});
  other.T_r_l = {conjugate(t.rotation), t.translation};
  list.push_back({"inverse_extrinsics",
                  other,
                  {},
                  "R is transposed (its rows and columns are exchanged), T is right.",
                  "Write R transposed for R: matrices are row after row, x_right = R x_left + T.",
                  false,
                  {}});
  other = rig;
  std::swap(other.left, other.right);
  list.push_back({"intrinsics_exchanged",
                  other,
                  {},
                  "The intrinsics of the two cameras are exchanged.",
                  "Exchange M1 with M2, and D1 with D2.",
                  false,
                  {}});
  for (Hypothesis& lens : lens_hypotheses(rig, stereo)) list.push_back(std::move(lens));
  list.push_back(vertical_offset(rig, view));
  return list;
}

std::vector<std::vector<Pair>> pair_mirrored(const Samples& samples, bool columns, bool rows) {
  std::vector<std::vector<Pair>> out;
  for (const Sample& sample : samples.list) {
    const LandmarkImage right = find_landmarks(mirrored(sample.right.grey, columns, rows));
    std::vector<Pair> pairs = pair_landmarks(sample.left, right);
    for (Pair& pair : pairs) {
      if (columns) pair.b.x = sample.right.grey.width_px - 1 - pair.b.x;
      if (rows) pair.b.y = sample.right.grey.height_px - 1 - pair.b.y;
    }
    out.push_back(std::move(pairs));
  }
  return out;
}

}  // namespace accrete::cli
