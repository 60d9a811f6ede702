// The line of each sigma point against an observed line element, in one or two cameras (METHOD 5.2 A). Four degrees of
// freedom are seen, and nine sigma points say what thirteen would (docs/math/prediction.md).
#pragma once

#include "math/cholesky.h"
#include "math/unscented.h"
#include "predict/sight_kernel.h"

namespace accrete::inline ACCRETE_ISA {

// Added to a predicted covariance, so that rounding cannot make it indefinite: (0.3 um)^2 of a pixel, (0.3 urad)^2.
inline constexpr float kResidualFloor = 1e-13F;

// The root of the covariance in the order seen, along, roll, without its last two columns: a pure slide along the
// mean's tangent and a pure roll about it, which move no line.
template <class S>
struct Root {
  Symmetric<S, 4> L;  // L(i, j), i >= j, of the seen
  S inverse[4];       // 1 / L(j, j)
  S along[4];         // the row of what is along
  S along_rest;       // variance along, given the seen
  Bool<S> good;
};

// The row of the unseen component `of`.
template <class S>
ACCRETE_INLINE void root_row(const Symmetric<S, 6>& P, int of, const Root<S>& root, S* row) {
  ACCRETE_UNROLL
  for (int j = 0; j < 4; ++j) {
    S sum = P(of, kSeen[j]);
    ACCRETE_UNROLL
    for (int k = 0; k < j; ++k) sum = sum - row[k] * root.L(j, k);
    row[j] = flush_tiny(sum * root.inverse[j]);
  }
}

template <class S>
ACCRETE_INLINE Root<S> root_of(const Symmetric<S, 6>& P) {
  Root<S> root;
  Symmetric<S, 4> seen;
  ACCRETE_UNROLL
  for (int i = 0; i < 4; ++i) {
    ACCRETE_UNROLL
    for (int j = i; j < 4; ++j) seen(i, j) = P(kSeen[i], kSeen[j]);
  }
  const Bool<S> good = cholesky<4>(seen, root.L, root.inverse);
  root_row(P, kAlong, root, root.along);
  root.along_rest = P(kAlong, kAlong);
  ACCRETE_UNROLL
  for (int j = 0; j < 4; ++j) root.along_rest = root.along_rest - root.along[j] * root.along[j];
  root.good = good & (root.along_rest > P(kAlong, kAlong) * S(kMinPivot)) & (root.along_rest <= S(kLargest));
  return root;
}

// Sums over the sigma points that prediction and update are made of. With r(0) the residual of the central point,
// r(+-j) those of x [+] (+-sqrt(6) L_j), L the root of P:
template <class S, int M>
struct ResidualMoments {
  S mean[M];             // mean residual
  S odd[4][M];           // (r(+j) - r(-j)) / (2 sqrt(6)): with it, cov(state, residual) = sum_j L_j odd_jt
  Symmetric<S, M> even;  // the part of the covariance of the residual that is not sum_j odd_j odd_jt: >= 0, curvature
};

// A linear function of the moment of a line about a camera.
template <class S>
struct OfMoment {
  S n[3];     // of q x (t, b, a), q the mean's point relative to the camera
  S axis[3];  // of (t, b, a) themselves: what a step of the point, across a tangent, adds
};
// Of both signs of a sigma point, even +- odd.
template <class S>
struct BothSigns {
  S even, odd;
};

// What column j of the root does to the line: the tangent becomes along t +- (across_b b + across_a a), the point moves
// by +-(slide t + u b + v a), and the moment by the product of the two. u is 0 from column 1 on, v from 2, the tilt
// about b in 3: they are left out, which no compiler may do with products by zero.
template <class S>
struct Step {
  TiltedTangent<S> tangent;
  S turn;              // of t in the moment: even
  S slide_b, slide_a;  // of a and -b: even
  S shift_b, shift_a;  // of b and -a: odd
};

template <int J, class S>
ACCRETE_INLINE Step<S> step_of(const Root<S>& root) {
  const S spread = S(static_cast<float>(kSpread6));
  Step<S> d;
  d.tangent = tilted_tangent(J < 3 ? root.L(2, J) * spread : S(0), root.L(3, J) * spread);
  const S slide = root.along[J] * spread;
  d.slide_b = slide * d.tangent.across_b;
  if constexpr (J < 3) d.slide_a = slide * d.tangent.across_a;
  if constexpr (J < 2) {
    const S v = root.L(1, J) * spread;
    d.shift_b = v * d.tangent.along;
    d.turn = -(v * d.tangent.across_b);
  }
  if constexpr (J < 1) {
    const S u = root.L(0, J) * spread;
    d.shift_a = u * d.tangent.along;
    d.turn = u * d.tangent.across_a + d.turn;
  }
  return d;
}

template <int J, class S>
ACCRETE_INLINE BothSigns<S> after(const Step<S>& d, const OfMoment<S>& f) {
  S even = d.tangent.along * f.n[0] + d.slide_b * f.axis[2], odd = d.tangent.across_b * f.n[1];
  if constexpr (J < 3) {
    even = even - d.slide_a * f.axis[1];
    odd = odd + d.tangent.across_a * f.n[2];
  }
  if constexpr (J < 2) {
    even = even + d.turn * f.axis[0];
    odd = odd + d.shift_b * f.axis[1];
  }
  if constexpr (J < 1) odd = odd - d.shift_a * f.axis[2];
  return {even, odd};
}

// What the residuals of all sigma points are made of.
template <int Eyes, class S>
struct LineTerms {
  const View<S>* views;
  // n.x of the observed ray x, and the components of n in the image. n.x = w.t, w = x cross q: small, formed once, so
  // that the sigma points add small to small. n_x is the same in both cameras.
  OfMoment<S> across[Eyes], nx, ny[Eyes];
  S least;  // the smallest squared image length that a sigma point is given: a line through the camera has no image
  S central[2 * Eyes];  // e_n in pixels and the sine of the angle, of the mean itself
};

template <int Eyes, class S>
ACCRETE_INLINE LineTerms<Eyes, S> line_terms(const Sight<S>& v, const View<S>* views, S focal) {
  LineTerms<Eyes, S> out;
  out.views = views;
  out.least = S(1e-12F) * v.q[2] * v.q[2];
  const Vector3<S>* axes[3] = {&v.t, &v.b, &v.a};
  ACCRETE_UNROLL
  for (int k = 0; k < 3; ++k) {
    const Vector3<S>& axis = *axes[k];
    const Vector3<S> n = cross(v.q, axis);
    out.nx.n[k] = n[0];
    out.nx.axis[k] = axis[0];
    ACCRETE_UNROLL
    for (int e = 0; e < Eyes; ++e) {
      const Vector3<S> x = {views[e].x, views[e].y, focal};
      out.ny[e].n[k] = n[1] + views[e].offset * axis[2];
      out.ny[e].axis[k] = axis[1];
      out.across[e].n[k] = dot<S>(cross<S>(x, {v.q[0] - views[e].offset, v.q[1], v.q[2]}), axis);
      out.across[e].axis[k] = dot(x, axis);
    }
  }
  ACCRETE_UNROLL
  for (int e = 0; e < Eyes; ++e) {
    const S nx = out.nx.n[0], ny = out.ny[e].n[0];
    const S k = inverse_sqrt(max_of(nx * nx + ny * ny, out.least));
    out.central[2 * e] = out.across[e].n[0] * k;
    out.central[2 * e + 1] = (nx * views[e].c + ny * views[e].s) * k;
  }
  return out;
}

// Both signs of one sigma point, in all cameras: four reciprocal lengths for one division.
template <int J, int Eyes, class S>
ACCRETE_INLINE void pair_residuals(const LineTerms<Eyes, S>& terms, const Step<S>& d, S* plus, S* minus) {
  const BothSigns<S> x = after<J>(d, terms.nx);
  const S xp = x.even + x.odd, xm = x.even - x.odd;
  S yp[Eyes], ym[Eyes], rootp[Eyes], rootm[Eyes], pair[Eyes];
  ACCRETE_UNROLL
  for (int e = 0; e < Eyes; ++e) {
    const BothSigns<S> y = after<J>(d, terms.ny[e]);
    yp[e] = y.even + y.odd;
    ym[e] = y.even - y.odd;
    rootp[e] = sqrt_of(max_of(xp * xp + yp[e] * yp[e], terms.least));
    rootm[e] = sqrt_of(max_of(xm * xm + ym[e] * ym[e], terms.least));
    pair[e] = rootp[e] * rootm[e];
  }
  const S inverse = S(1) / (Eyes == 2 ? pair[0] * pair[Eyes - 1] : pair[0]);
  ACCRETE_UNROLL
  for (int e = 0; e < Eyes; ++e) {
    const View<S>& view = terms.views[e];
    const S k = Eyes == 2 ? inverse * pair[Eyes - 1 - e] : inverse;  // 1 / pair[e]
    const S kp = k * rootm[e], km = k * rootp[e];
    const BothSigns<S> across = after<J>(d, terms.across[e]);
    plus[2 * e] = (across.even + across.odd) * kp;
    minus[2 * e] = (across.even - across.odd) * km;
    plus[2 * e + 1] = (xp * view.c + yp[e] * view.s) * kp;
    minus[2 * e + 1] = (xm * view.c + ym[e] * view.s) * km;
  }
}

// Column j: odd part, and even part without the mean's.
template <int J, int Eyes, class S>
ACCRETE_INLINE void column_moments(const Root<S>& root, const LineTerms<Eyes, S>& terms, S* odd, S* curve) {
  S plus[2 * Eyes], minus[2 * Eyes];
  pair_residuals<J>(terms, step_of<J>(root), plus, minus);
  ACCRETE_UNROLL
  for (int m = 0; m < 2 * Eyes; ++m) {
    odd[m] = flush_tiny((plus[m] - minus[m]) * S(static_cast<float>(0.5 / kSpread6)));
    curve[m] = S(0.5F) * (plus[m] + minus[m]) - terms.central[m];
  }
}

// Eyes: 1 or 2 cameras, M = 2 Eyes residuals.
template <int Eyes, class S>
ACCRETE_INLINE ResidualMoments<S, 2 * Eyes> residual_moments(const Sight<S>& v, const Root<S>& root,
                                                             const View<S>* views, S focal) {
  constexpr int M = 2 * Eyes;
  const LineTerms<Eyes, S> terms = line_terms<Eyes>(v, views, focal);
  ResidualMoments<S, M> out;
  S curve[4][M];
  column_moments<0>(root, terms, out.odd[0], curve[0]);
  column_moments<1>(root, terms, out.odd[1], curve[1]);
  column_moments<2>(root, terms, out.odd[2], curve[2]);
  column_moments<3>(root, terms, out.odd[3], curve[3]);

  // Six columns, of which two have no curvature: 1/6 sum (k - m)(k - m)t + 2 m mt = 1/6 sum k kt + m mt.
  const S sixth = S(static_cast<float>(2 * Unscented<6>::kWeight));
  S shift[M];
  ACCRETE_UNROLL
  for (int m = 0; m < M; ++m) {
    shift[m] = (curve[0][m] + curve[1][m] + curve[2][m] + curve[3][m]) * sixth;
    out.mean[m] = terms.central[m] + shift[m];
  }
  ACCRETE_UNROLL
  for (int i = 0; i < M; ++i) {
    ACCRETE_UNROLL
    for (int k = i; k < M; ++k) {
      S sum = curve[0][i] * curve[0][k];
      ACCRETE_UNROLL
      for (int j = 1; j < 4; ++j) sum = sum + curve[j][i] * curve[j][k];
      out.even(i, k) = sum * sixth + S(static_cast<float>(Unscented<6>::kCovariance0 - 1)) * shift[i] * shift[k];
    }
  }
  return out;
}

// The covariance of the residual that the state causes.
template <class S, int M>
ACCRETE_INLINE Symmetric<S, M> state_covariance(const ResidualMoments<S, M>& moments) {
  Symmetric<S, M> c;
  ACCRETE_UNROLL
  for (int i = 0; i < M; ++i) {
    ACCRETE_UNROLL
    for (int k = i; k < M; ++k) {
      S sum = moments.even(i, k);
      ACCRETE_UNROLL
      for (int j = 0; j < 4; ++j) sum = sum + moments.odd[j][i] * moments.odd[j][k];
      c(i, k) = sum;
    }
  }
  return c;
}

}  // namespace accrete::inline ACCRETE_ISA
