#include "associate/gate.h"

#include "associate/gate_kernel.h"

// The kernel on one lane.
namespace accrete::associate {
namespace {

LaneElement<float> element(const LineElement& e) { return {e.x_px, e.y_px, e.c, e.s}; }
LaneResidual<float> of(const Residual& r) { return {r.n_px, r.sine, r.slide_px, r.reversed}; }

template <int Eyes>
Likelihood likelihood(const Symmetric<float, 2 * Eyes>& P, const LaneResidual<float>* r, const LineElement* const* seen,
                      const Noise& noise) {
  float variance[2 * Eyes];
  for (int e = 0; e < Eyes; ++e) {
    variance[2 * e] = seen[e]->sigma_n_px * seen[e]->sigma_n_px + noise.variance_n_px2;
    variance[2 * e + 1] = seen[e]->sigma_theta * seen[e]->sigma_theta + noise.variance_theta;
  }
  const LaneGaussian<float> g = gaussian<Eyes>(innovation_covariance<Eyes>(P, r, variance), r);
  return {g.d2, -0.5F * (g.d2 + log_determinant(g.determinant) + static_cast<float>(2 * Eyes) * kLogTwoPi)};
}

}  // namespace

Residual residual(float x, float y, float c, float s, const LineElement& observed) {
  const LaneResidual<float> r = residual(LaneElement<float>{x, y, c, s}, element(observed));
  return {r.n, r.sine, r.slide, r.reversed};
}

Likelihood stereo_likelihood(const PredictedObservation& p, const Residual& rl, const LineElement& l,
                             const Residual& rr, const LineElement& r, const Noise& noise) {
  Symmetric<float, 4> P;
  for (std::size_t k = 0; k < 10; ++k) P.v[k] = p.covariance[k];
  const LaneResidual<float> both[2] = {of(rl), of(rr)};
  const LineElement* const seen[2] = {&l, &r};
  return likelihood<2>(P, both, seen, noise);
}

Likelihood mono_likelihood(const PredictedObservation& p, int eye, const Residual& r, const LineElement& observed,
                           const Noise& noise) {
  const std::size_t n = eye == 0 ? 0 : 2;
  Symmetric<float, 2> P;
  P(0, 0) = p.covariance[packed_index(4, n, n)];
  P(0, 1) = p.covariance[packed_index(4, n, n + 1)];
  P(1, 1) = p.covariance[packed_index(4, n + 1, n + 1)];
  const LaneResidual<float> one = of(r);
  const LineElement* const seen[1] = {&observed};
  return likelihood<1>(P, &one, seen, noise);
}

Likelihood appearance_likelihood(const Appearance& mean, const float variance[7], const Appearance& seen,
                                 float sigma_phase, float sigma_colour, float independent_channels) {
  const float m[7] = {mean.phase,    mean.left[0],  mean.left[1], mean.left[2],
                      mean.right[0], mean.right[1], mean.right[2]};
  const LaneLook<float> look{
      {seen.phase, seen.left[0], seen.left[1], seen.left[2], seen.right[0], seen.right[1], seen.right[2]},
      sigma_phase,
      sigma_colour};
  const float share = independent_channels / 3;
  const LaneAppearanceFit<float> fit = fit_appearance(m, variance, look, share);
  const float log_norm = share * (log_determinant(fit.colour) + 6 * kLogTwoPi) + log_determinant(fit.phase) + kLogTwoPi;
  return {fit.d2, -0.5F * (fit.d2 + log_norm)};
}

}  // namespace accrete::associate
