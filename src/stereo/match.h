// Stereo matching of 2D-primitives: epipolar constraint and multi-modal similarity; ambiguity is kept as rivals.
#pragma once

#include <array>
#include <span>

#include "accrete/params.h"
#include "accrete/primitive.h"
#include "accrete/step_report.h"
#include "math/aligned.h"
#include "stereo/row_index.h"

namespace accrete::stereo {

// A right primitive that may show the same edge as a left one.
struct Candidate {
  std::uint16_t right;
  bool reversed;  // described in the opposite direction
  float mismatch, disparity_px, similarity;
};

// The best few of one left primitive, best first, one per contour.
struct Candidates {
  static constexpr std::size_t kMax = 6;
  std::array<Candidate, kMax> item;
  std::size_t count = 0;
};

struct Scratch {
  RowIndex left_rows, right_rows;
  std::span<Candidates> candidates;  // one per left primitive
  std::span<float> best_of_right;    // smallest mismatch that any left primitive has with it
};

// Writes hypotheses, those of one left primitive together and the best first, and returns their number. Pairs share an
// epipolar line (the right element slides along itself), have a disparity inside the range, are mutually best or rivals
// of the best, and share their prior existence (METHOD 2, 3.1; docs/math/stereo.md).
std::size_t match(std::span<const Primitive2d> left, std::span<const Primitive2d> right, const StereoParams& params,
                  const AlignedOptics& optics, int image_width_px, Scratch& scratch, std::span<StereoMatch> out,
                  StepReport& report);

}  // namespace accrete::stereo
