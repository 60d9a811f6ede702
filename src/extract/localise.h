// Where in a cell the edge is: position across it, orientation and phase of one candidate pixel.
#pragma once

#include "accrete/params.h"
#include "extract/quadrature.h"

namespace accrete::extract {

// |cos(phase)| below which an edge is a step, and no line (METHOD 1.4).
inline constexpr float kStepLike = 0.7F;

enum class LocaliseOutcome : unsigned char {
  kOk,
  kNoPeak,     // no zero crossing and no extremum near: the candidate belongs to a neighbour
  kDimension,  // homogeneous or junction
};

struct Localised {
  float x_px, y_px;
  float theta;   // [0, pi)
  float ux, uy;  // its cosine and sine: along the edge; the right-hand normal is (-uy, ux)
  float phase;
  float amplitude;
  float confidence_i0d, confidence_i1d, confidence_i2d;
  float sigma_n_px, sigma_theta, sigma_phase;
  float phase_slope;  // d(phase)/d(normal), rad per px: for the flow
};

// Precondition: the rows y - 6 .. y + 5 are in the filter's ring and x is at least 6 px inside.
[[nodiscard]] LocaliseOutcome localise(const QuadratureFilter& filter, int x, int y, const ExtractParams& params,
                                       Localised& out);

}  // namespace accrete::extract
