// How well observations fit a prediction: residuals, gates and likelihoods (METHOD 5.2, 5.3, 6.2).
#pragma once

#include "accrete/primitive.h"
#include "predict/predict.h"

namespace accrete::associate {

// Quantiles of chi-squared (METHOD 5.3).
inline constexpr float kGate2 = 9.21F;      // 2 dof, 99 %
inline constexpr float kGate4 = 13.28F;     // 4 dof, 99 %
inline constexpr float kGateAll4 = 31.26F;  // 11 dof, 99.9 %: geometry and appearance of a stereo pair
inline constexpr float kGateAll2 = 27.88F;  // 9 dof, 99.9 %: of one eye

// An element against the predicted one of its eye.
struct Residual {
  float n_px;      // distance of the observed point from the predicted line, along the predicted normal
  float sine;      // of the angle from the predicted to the observed direction, in the predicted sense
  float slide_px;  // along the edge: gated only, never used for correction (aperture)
  bool reversed;   // the observation is described in the opposite direction
};
[[nodiscard]] Residual residual(float x, float y, float c, float s, const LineElement& observed);

// A side's share of d2 is capped at this: three colours at 97 %. And what a colour never is surer than.
inline constexpr float kSideGate = 9.0F, kColourFloor2 = 0.05F * 0.05F;

// What is added to the state's own covariance at each eye.
struct Noise {
  float variance_n_px2;  // pose error and consider bias; the element's own sigma comes on top
  float variance_theta;
};

struct Likelihood {
  float d2;     // squared Mahalanobis distance
  float log_g;  // log of the Gaussian density: px^-1 rad^-1 per eye
};

// Both eyes, 4 degrees of freedom. The slides enter the covariance: a line that may turn is less certain away from its
// predicted point. d2 = infinity when the covariance is not positive definite.
[[nodiscard]] Likelihood stereo_likelihood(const PredictedObservation& p, const Residual& rl, const LineElement& l,
                                           const Residual& rr, const LineElement& r, const Noise& noise);
// One eye (0 left, 1 right), 2 degrees of freedom.
[[nodiscard]] Likelihood mono_likelihood(const PredictedObservation& p, int eye, const Residual& r,
                                         const LineElement& observed, const Noise& noise);

// Appearance, 7 dimensions: `state` against what was seen, already in the state's sense. Each side's share of d2 is
// capped, because beyond an occluding contour the background changes; and the phase's, unless both sides are at their
// cap, because another background, or other light on one face, may reverse the contrast. Floors keep a small covariance
// from rejecting alone (METHOD 5.3). `independent_channels`: see clutter.h; colours count that much.
[[nodiscard]] Likelihood appearance_likelihood(const Appearance& mean, const float variance[7], const Appearance& seen,
                                               float sigma_phase, float sigma_colour, float independent_channels);

}  // namespace accrete::associate
