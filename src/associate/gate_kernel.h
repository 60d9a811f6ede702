// Residuals, gates and likelihoods of association, for any scalar of the kernels (METHOD 5.2, 5.3, 6.2, 7.2;
// docs/math/association.md).
#pragma once

#include "associate/clutter.h"
#include "associate/gate.h"
#include "base/angles.h"
#include "base/elementary.h"
#include "math/lane_real.h"
#include "math/matrix.h"

namespace accrete::associate::inline ACCRETE_ISA {

inline constexpr float kLogTwoPi = 1.83787707F;
// A pivot of a covariance (px^2, rad^2) must exceed this: there is nothing that is known to 1e-10 px.
inline constexpr float kLeastPivot = 1e-20F;
// What a product of variances counts for at least: above the smallest normal number.
inline constexpr float kLeastProduct = 1e-37F;
// 2^20: keeps products of variances and squared densities of chance (1e-3 .. 1e-7 per px rad) far from that.
inline constexpr float kLift = 1048576.0F, kLogLift = 13.8629436F;
inline constexpr float kFloorPhase2 = 0.35F * 0.35F;  // what a phase never is surer than
inline constexpr float kGateProbability = 0.99F;      // of kGate2 and kGate4
// exp() of anything above this is clipped long before it is used.
inline constexpr float kMaxLogRatio = 30.0F;

// A line element, or where one is expected: a point and a unit direction.
template <class S>
struct LaneElement {
  S x, y, c, s;
};

template <class S>
struct LaneResidual {
  S n, sine, slide;
  Bool<S> reversed;
};

// A Gaussian density: exp(-d2 / 2) / sqrt((2 pi)^dimensions determinant). No logarithm yet: one does for several.
template <class S>
struct LaneGaussian {
  S d2, determinant;
};

// Phase, left RGB, right RGB; what was observed, with its deviations.
template <class S>
struct LaneLook {
  S a[7];
  S sigma_phase, sigma_colour;
};

template <class S>
ACCRETE_INLINE LaneResidual<S> residual(const LaneElement<S>& p, const LaneElement<S>& o) {
  const S dx = o.x - p.x, dy = o.y - p.y;
  const S sine = p.c * o.s - p.s * o.c;
  const Bool<S> reversed = p.c * o.c + p.s * o.s < S(0);
  return {dy * p.c - dx * p.s, select(reversed, -sine, sine), dx * p.c + dy * p.s, reversed};
}

// J P Jt + R. P: what the state causes, (n, theta) of each eye. J moves each normal offset along its line by the slide:
// n(slide) = n + slide * theta, both being errors of the prediction (a line that turns leaves the point at distance
// `slide` by that much). noise: variances of (n, theta) of each eye.
template <int Eyes, class S>
ACCRETE_INLINE Symmetric<S, 2 * Eyes> innovation_covariance(const Symmetric<S, 2 * Eyes>& P, const LaneResidual<S>* r,
                                                            const S* noise) {
  Symmetric<S, 2 * Eyes> out = P;
  ACCRETE_UNROLL
  for (int e = 0; e < Eyes; ++e) {
    ACCRETE_UNROLL
    for (int f = e; f < Eyes; ++f) {
      const int n = 2 * e, m = 2 * f;
      const S cross = P(n, m + 1) + r[e].slide * P(n + 1, m + 1);
      out(n, m + 1) = cross;
      if (f > e) out(n + 1, m) = P(n + 1, m) + r[f].slide * P(n + 1, m + 1);
      out(n, m) = P(n, m) + r[e].slide * P(n + 1, m) + r[f].slide * cross;
    }
    out(2 * e, 2 * e) += noise[2 * e];
    out(2 * e + 1, 2 * e + 1) += noise[2 * e + 1];
  }
  return out;
}

// Of the residuals. d2 = infinity where A is not positive definite. A = L D Lt: no square root.
template <int Eyes, class S>
ACCRETE_INLINE LaneGaussian<S> gaussian(const Symmetric<S, 2 * Eyes>& A, const LaneResidual<S>* r) {
  constexpr int N = 2 * Eyes;
  constexpr float kInfinity = __builtin_inff();
  Bool<S> good = S(0) == S(0);
  S l[N][N], unscaled[N][N], pivot[N], y[N];  // unscaled: L D
  S d2 = S(0);
  ACCRETE_UNROLL
  for (int j = 0; j < N; ++j) {
    S d = A(j, j), z = j % 2 == 0 ? r[j / 2].n : r[j / 2].sine;
    ACCRETE_UNROLL
    for (int k = 0; k < j; ++k) {
      d = d - unscaled[j][k] * l[j][k];
      z = z - l[j][k] * y[k];
    }
    const Bool<S> ok = d > S(kLeastPivot);
    good = good & ok;
    pivot[j] = select(ok, d, S(1));
    const S inverse = S(1) / pivot[j];
    y[j] = z;
    d2 = d2 + z * z * inverse;
    ACCRETE_UNROLL
    for (int i = j + 1; i < N; ++i) {
      S sum = A(j, i);
      ACCRETE_UNROLL
      for (int k = 0; k < j; ++k) sum = sum - unscaled[i][k] * l[j][k];
      unscaled[i][j] = sum;
      l[i][j] = sum * inverse;
    }
  }
  const S first = pivot[0] * pivot[1];
  return {select(good, d2, S(kInfinity)), Eyes == 2 ? first * (pivot[N - 2] * pivot[N - 1]) : first};
}

// To [-pi, pi].
template <class S>
ACCRETE_INLINE S wrapped(S a) {
  using Format = typename Real<S>::Format;
  const S turns = (a * S(1 / (2 * kPi)) + S(Format::kShift)) - S(Format::kShift);
  return a - turns * S(2 * kPi);
}

// In the other sense where the mask is true: the lanes' form of accrete::reversed.
template <class S>
ACCRETE_INLINE void reverse_where(Bool<S> mask, S* a) {
  a[0] = select(mask, -a[0], a[0]);
  ACCRETE_UNROLL
  for (int c = 1; c < 4; ++c) {
    const S left = a[c];
    a[c] = select(mask, a[c + 3], left);
    a[c + 3] = select(mask, left, a[c + 3]);
  }
}

// What both eyes saw: the phase half-way between (their circular mean), means of the colours and of the deviations.
template <class S>
ACCRETE_INLINE LaneLook<S> mean_of(const LaneLook<S>& l, const LaneLook<S>& r) {
  LaneLook<S> m;
  m.a[0] = wrapped(l.a[0] + S(0.5F) * wrapped(r.a[0] - l.a[0]));
  ACCRETE_UNROLL
  for (int c = 1; c < 7; ++c) m.a[c] = S(0.5F) * (l.a[c] + r.a[c]);
  m.sigma_phase = S(0.5F) * (l.sigma_phase + r.sigma_phase);
  m.sigma_colour = S(0.5F) * (l.sigma_colour + r.sigma_colour);
  return m;
}

// Both blocks of the appearance's density, but for the powers of 2 pi: the colours count `share` of theirs.
template <class S>
struct LaneAppearanceFit {
  S d2;      // capped as in gate.h
  S colour;  // determinant of the six colours
  S phase;   // variance
};

// See gate.h. share: independent channels / 3.
template <class S>
ACCRETE_INLINE LaneAppearanceFit<S> fit_appearance(const S* mean, const S* variance, const LaneLook<S>& seen, S share) {
  const S colour2 = seen.sigma_colour * seen.sigma_colour + S(kColourFloor2);
  S side[2], determinant[2];
  ACCRETE_UNROLL
  for (int k = 0; k < 2; ++k) {
    S v[3], d[3];
    ACCRETE_UNROLL
    for (int c = 0; c < 3; ++c) {
      const int i = 1 + 3 * k + c;
      v[c] = variance[i] + colour2;
      d[c] = seen.a[i] - mean[i];
    }
    // Three quotients by one division.
    const S v01 = v[0] * v[1];
    determinant[k] = v01 * v[2];
    const S sum = v[2] * (d[0] * d[0] * v[1] + d[1] * d[1] * v[0]) + d[2] * d[2] * v01;
    side[k] = share * (sum / determinant[k]);
  }
  const Bool<S> changed = (side[0] > S(kSideGate)) & (side[1] > S(kSideGate));
  const S sides = min_of(side[0], S(kSideGate)) + min_of(side[1], S(kSideGate));
  const S vp = variance[0] + seen.sigma_phase * seen.sigma_phase + S(kFloorPhase2);
  const S dp = wrapped(seen.a[0] - mean[0]);
  const S phase2 = dp * dp / vp;
  const S d2 = sides + select(changed, phase2, min_of(phase2, S(kSideGate)));
  return {d2, determinant[0] * determinant[1], vp};
}

// Log of a determinant, or of a product of some: bounded, because what is below no measurement ever had.
template <class S>
ACCRETE_INLINE S log_determinant(S product) {
  return log_of(max_of(product, S(kLeastProduct)));
}

// See Clutter::log_appearance.
template <class S>
ACCRETE_INLINE S clutter_log_appearance(const Clutter& clutter, const S* a) {
  S colour = S(clutter.log_colour_height);
  ACCRETE_UNROLL
  for (std::size_t c = 0; c < 3; ++c) {
    const S dl = a[1 + c] - S(clutter.mean[c]), dr = a[4 + c] - S(clutter.mean[c]);
    colour = colour - (dl * dl + dr * dr) * S(clutter.half_precision[c]);
  }
  const S magnitude = abs_of(wrapped(a[0]));
  S phase = S(clutter.log_phase[0]);
  ACCRETE_UNROLL
  for (std::size_t k = 1; k < clutter.log_phase.size(); ++k)
    phase =
        select(magnitude < S(2 * kPi / Clutter::kPhaseBins * static_cast<float>(k)), phase, S(clutter.log_phase[k]));
  return phase + colour * S(clutter.independent_channels / 3);
}

// The IPDA bracket for two eyes that detect independently, given how probably the edge is visible (METHOD 7.2).
template <class S>
ACCRETE_INLINE S miss_likelihood(S visible, S detection) {
  const S q = S(1) - detection * S(kGateProbability);
  return S(1) - visible + visible * q * q;
}
// log_ratio: log of the density of what was seen over that of chance.
template <int Eyes, class S>
ACCRETE_INLINE S log_match_likelihood(S visible, S detection, S log_ratio) {
  const S other = Eyes == 2 ? detection : S(1) - detection;
  return log_of(miss_likelihood(visible, detection) +
                visible * detection * other * exp_of(min_of(log_ratio, S(kMaxLogRatio))));
}

// A candidate pair: an expected primitive and what one eye or both saw.
template <int Eyes, class S>
struct LanePair {
  LaneElement<S> expected[Eyes], seen[Eyes];
  Symmetric<S, 2 * Eyes> P;
  S noise[2 * Eyes];  // of pose and observation together
  S mean[7], variance[7];
  LaneLook<S> look[Eyes];
  S density[Eyes];  // beta, of chance observations there (Clutter::density)
  S visible, detection;
};
template <int Eyes, class S>
struct LaneVerdict {
  S d2;              // of the geometry; infinity where there is none
  S log_likelihood;  // IPDA bracket; -infinity where a gate is closed
  Bool<S> reversed[Eyes];
};

// `clutter`: of the image whose colours the appearance is compared with.
template <int Eyes, class S>
ACCRETE_INLINE LaneVerdict<Eyes, S> gate_pair(LanePair<Eyes, S>& p, const Clutter& clutter) {
  LaneVerdict<Eyes, S> out;
  LaneResidual<S> r[Eyes];
  ACCRETE_UNROLL
  for (int e = 0; e < Eyes; ++e) {
    r[e] = residual(p.expected[e], p.seen[e]);
    out.reversed[e] = r[e].reversed;
    reverse_where(r[e].reversed, p.look[e].a);
  }
  const LaneGaussian<S> geometry = gaussian<Eyes>(innovation_covariance<Eyes>(p.P, r, p.noise), r);
  const LaneLook<S> look = Eyes == 2 ? mean_of(p.look[0], p.look[Eyes - 1]) : p.look[0];
  const S share = S(clutter.independent_channels / 3);
  const LaneAppearanceFit<S> appearance = fit_appearance(p.mean, p.variance, look, share);
  // The density of chance belongs to the determinant, -log(beta) = -1/2 log(beta^2): one logarithm for both.
  S product = geometry.determinant * appearance.phase;
  ACCRETE_UNROLL
  for (int e = 0; e < Eyes; ++e) product = product * ((S(kLift) * p.density[e]) * p.density[e]);
  const S log_norm = log_determinant(product) + share * (log_determinant(appearance.colour) + S(6 * kLogTwoPi)) +
                     S(static_cast<float>(2 * Eyes + 1) * kLogTwoPi - static_cast<float>(Eyes) * kLogLift);
  const S log_ratio = S(-0.5F) * (geometry.d2 + appearance.d2 + log_norm) - clutter_log_appearance(clutter, look.a);
  const Bool<S> open = (geometry.d2 <= S(Eyes == 2 ? kGate4 : kGate2)) &
                       (geometry.d2 + appearance.d2 <= S(Eyes == 2 ? kGateAll4 : kGateAll2));
  out.d2 = geometry.d2;
  out.log_likelihood =
      select(open, log_match_likelihood<Eyes>(p.visible, p.detection, log_ratio), S(-__builtin_inff()));
  return out;
}

}  // namespace accrete::associate::inline ACCRETE_ISA
