// The line of each sigma point against an observed line element, in both cameras (METHOD 5.2 A). All of it is in terms
// of the line's moment n = q x t, the normal of the plane through the line and the centre of projection: the image of
// the line is n.(x, y, f) = 0. So there is no division by a depth, and the slide along the line drops out by itself.
#pragma once

#include "math/aligned.h"
#include "math/lane_state.h"
#include "math/unscented.h"

namespace accrete::inline ACCRETE_ISA {

// A line element of one camera. `offset` is where that camera stands on the aligned x axis: 0 or the baseline.
template <class S>
struct View {
  S x, y, c, s;
  S offset;
};

// Point and own frame of the primitive, seen from the aligned left camera.
template <class S>
struct Sight {
  Vector3<S> q, t, b, a;
  Matrix3<S> R_a_m;  // the same in all lanes
};

template <class S>
ACCRETE_INLINE Sight<S> look_at(const Vector3<S>& p, const Quat<S>& rotation, const AlignedPose& pose) {
  Sight<S> v;
  v.R_a_m = matrix_from<S>(pose.R);
  v.q = rotate(v.R_a_m, p);
  for (int i = 0; i < 3; ++i) v.q[i] += S(pose.t[i]);
  const Matrix3<S> own = rotation_matrix(rotation);
  v.t = rotate<S>(v.R_a_m, own.col(0));
  v.b = rotate<S>(v.R_a_m, own.col(1));
  v.a = rotate<S>(v.R_a_m, own.col(2));
  return v;
}

// n_x, n_y of the moment about the camera at (offset, 0, 0), from q x t about the left one.
template <class S>
ACCRETE_INLINE S squared_image_length(const Vector3<S>& moment, const Vector3<S>& t, S offset) {
  const S ny = moment[1] + offset * t[2];
  return moment[0] * moment[0] + ny * ny;
}

// In front of both cameras, and not a line through a centre of projection, whose image is a point: its image must be
// longer than 1e-3 of its length (0.06 degrees between line and ray).
template <class S>
ACCRETE_INLINE Bool<S> is_in_front(const Sight<S>& v, S offset) {
  const Vector3<S> n = cross(v.q, v.t);
  const S least = S(1e-6F) * v.q[2] * v.q[2];
  return (v.q[2] > S(kMinDepth_m)) & (squared_image_length(n, v.t, S(0)) > least) &
         (squared_image_length(n, v.t, offset) > least);
}

// What both cameras should see: the line elements of the projection, left and right. true where is_in_front.
template <class S>
ACCRETE_INLINE Bool<S> expected_views(const Sight<S>& v, S focal, S baseline, View<S>* views) {
  const Vector3<S> n = cross(v.q, v.t);
  const S scale = focal / v.q[2];
  for (int e = 0; e < 2; ++e) {
    const S offset = e == 0 ? S(0) : baseline;
    const S ny = n[1] + offset * v.t[2];
    const S k = inverse_sqrt(max_of(n[0] * n[0] + ny * ny, S(1e-30F)));
    views[e] = {(v.q[0] - offset) * scale, v.q[1] * scale, ny * k, -n[0] * k, offset};
  }
  return is_in_front(v, baseline);
}

// Added to a predicted covariance, so that rounding cannot make it indefinite: (0.3 um)^2 of a pixel, (0.3 urad)^2.
inline constexpr float kResidualFloor = 1e-13F;

// Sums over the sigma points that prediction and update are made of. With r(0) the residual of the central point,
// r(+-j) those of x [+] (+-sqrt(6) L_j), L the root of P:
template <class S, int M>
struct ResidualMoments {
  S mean[M];             // mean residual
  S odd[6][M];           // (r(+j) - r(-j)) / (2 sqrt(6)): with it, cov(state, residual) = sum_j L_j odd_jt
  Symmetric<S, M> even;  // the part of the covariance of the residual that is not sum_j odd_j odd_jt: >= 0, curvature
};

// What stays the same for all sigma points of one camera.
template <class S>
struct EyeTerms {
  Vector3<S> x;  // ray of the observed point (x, y, f)
  Vector3<S> w;  // x cross (q - camera): small, formed once, so that the sigma points add small to small
};

// The moment of a line about a camera as far as its image needs it, and the squared length of the image.
template <class S>
struct ImageLine {
  S nx, ny, length2;
};
template <class S>
ACCRETE_INLINE ImageLine<S> image_line(const View<S>& view, S nx, S ny, S tz, S least) {
  const S y = ny + view.offset * tz;
  return {nx, y, max_of(nx * nx + y * y, least)};
}

// e_n in pixels and the sine of the angle. `w` is x cross (q_i - camera): n_i.x = w.t. `k` is 1 / length.
template <class S>
ACCRETE_INLINE void line_residual(const View<S>& view, const Vector3<S>& w, const ImageLine<S>& line,
                                  const Vector3<S>& t, S k, S* r) {
  r[0] = dot(w, t) * k;
  r[1] = (line.nx * view.c + line.ny * view.s) * k;
}

// Both signs of one sigma point, in all cameras: four reciprocal lengths for one division.
template <int Eyes, class S>
ACCRETE_INLINE void pair_residuals(const View<S>* views, const Vector3<S>* wp, const Vector3<S>* wm,
                                   const Vector3<S>& np, const Vector3<S>& nm, const Vector3<S>& tp,
                                   const Vector3<S>& tm, S least, S* rp, S* rm) {
  ImageLine<S> plus[Eyes], minus[Eyes];
  S rootp[Eyes], rootm[Eyes], pair[Eyes];
  ACCRETE_UNROLL
  for (int e = 0; e < Eyes; ++e) {
    plus[e] = image_line(views[e], np[0], np[1], tp[2], least);
    minus[e] = image_line(views[e], nm[0], nm[1], tm[2], least);
    rootp[e] = sqrt_of(plus[e].length2);
    rootm[e] = sqrt_of(minus[e].length2);
    pair[e] = rootp[e] * rootm[e];
  }
  const S inverse = S(1) / (Eyes == 2 ? pair[0] * pair[Eyes - 1] : pair[0]);
  ACCRETE_UNROLL
  for (int e = 0; e < Eyes; ++e) {
    const S k = Eyes == 2 ? inverse * pair[Eyes - 1 - e] : inverse;  // 1 / pair[e]
    line_residual(views[e], wp[e], plus[e], tp, k * rootm[e], rp + 2 * e);
    line_residual(views[e], wm[e], minus[e], tm, k * rootp[e], rm + 2 * e);
  }
}

// Eyes: 1 or 2 cameras, M = 2 Eyes residuals. L: root of P (cholesky.h).
template <int Eyes, class S>
ACCRETE_INLINE ResidualMoments<S, 2 * Eyes> residual_moments(const Sight<S>& v, const Symmetric<S, 6>& L,
                                                             const View<S>* views, S focal) {
  constexpr int M = 2 * Eyes;
  const S spread = S(static_cast<float>(kSpread6));
  // The smallest squared image length that a sigma point is given: a line through the camera has no image.
  const S least = S(1e-12F) * v.q[2] * v.q[2];
  const Vector3<S> n0 = cross(v.q, v.t), nb = cross(v.q, v.b), na = cross(v.q, v.a);

  EyeTerms<S> eye[Eyes];
  S r0[M];
  for (int e = 0; e < Eyes; ++e) {
    eye[e].x = {views[e].x, views[e].y, focal};
    eye[e].w = cross<S>(eye[e].x, {v.q[0] - views[e].offset, v.q[1], v.q[2]});
    const ImageLine<S> line = image_line(views[e], n0[0], n0[1], v.t[2], least);
    line_residual(views[e], eye[e].w, line, v.t, inverse_sqrt(line.length2), r0 + 2 * e);
  }

  ResidualMoments<S, M> out;
  S curve[6][M];  // (r(+j) + r(-j)) / 2 - r(0)
  const auto store = [&](int j, const S* plus, const S* minus) {
    ACCRETE_UNROLL
    for (int m = 0; m < M; ++m) {
      out.odd[j][m] = flush_tiny((plus[m] - minus[m]) * S(static_cast<float>(0.5 / kSpread6)));
      curve[j][m] = S(0.5F) * (plus[m] + minus[m]) - r0[m];
    }
  };

  // Columns of the lower triangle: 0 .. 2 move the point and tilt the tangent. Rolled: unrolled it does not fit the
  // first-level instruction cache (PERFORMANCE B.6).
  S column[6][6];
  ACCRETE_UNROLL
  for (int j = 0; j < 6; ++j) {
    ACCRETE_UNROLL
    for (int i = 0; i < 6; ++i) column[j][i] = i >= j ? L(i, j) * spread : S(0);
  }
  ACCRETE_ROLLED
  for (int j = 0; j < 3; ++j) {
    const Vector3<S> dq = rotate<S>(v.R_a_m, {column[j][0], column[j][1], column[j][2]});
    const TiltedTangent<S> k = tilted_tangent(column[j][4], column[j][5]);
    Vector3<S> tp, tm, np, nm;
    ACCRETE_UNROLL
    for (int i = 0; i < 3; ++i) {
      const S side = k.across_b * v.b[i] + k.across_a * v.a[i];
      tp[i] = k.along * v.t[i] + side;
      tm[i] = k.along * v.t[i] - side;
    }
    const Vector3<S> dp = cross(dq, tp), dm = cross(dq, tm);
    ACCRETE_UNROLL
    for (int i = 0; i < 3; ++i) {
      const S side = k.across_b * nb[i] + k.across_a * na[i];
      np[i] = k.along * n0[i] + side + dp[i];
      nm[i] = k.along * n0[i] - side - dm[i];
    }
    Vector3<S> wp[Eyes], wm[Eyes];
    ACCRETE_UNROLL
    for (int e = 0; e < Eyes; ++e) {
      const Vector3<S> dw = cross(eye[e].x, dq);
      wp[e] = eye[e].w + dw;
      wm[e] = eye[e].w - dw;
    }
    S rp[M], rm[M];
    pair_residuals<Eyes>(views, wp, wm, np, nm, tp, tm, least, rp, rm);
    store(j, rp, rm);
  }
  // Columns 3 .. 5 tilt the tangent only.
  ACCRETE_ROLLED
  for (int j = 3; j < 6; ++j) {
    const TiltedTangent<S> k = tilted_tangent(column[j][4], column[j][5]);
    Vector3<S> tp, tm, np, nm;
    ACCRETE_UNROLL
    for (int i = 0; i < 3; ++i) {
      const S side = k.across_b * v.b[i] + k.across_a * v.a[i];
      tp[i] = k.along * v.t[i] + side;
      tm[i] = k.along * v.t[i] - side;
    }
    ACCRETE_UNROLL
    for (int i = 0; i < 2; ++i) {
      const S side = k.across_b * nb[i] + k.across_a * na[i];
      np[i] = k.along * n0[i] + side;
      nm[i] = k.along * n0[i] - side;
    }
    np[2] = nm[2] = S(0);  // not used
    Vector3<S> w[Eyes];
    ACCRETE_UNROLL
    for (int e = 0; e < Eyes; ++e) w[e] = eye[e].w;
    S rp[M], rm[M];
    pair_residuals<Eyes>(views, w, w, np, nm, tp, tm, least, rp, rm);
    store(j, rp, rm);
  }

  S shift[M];
  ACCRETE_UNROLL
  for (int m = 0; m < M; ++m) {
    S sum = curve[0][m];
    ACCRETE_UNROLL
    for (int j = 1; j < 6; ++j) sum = sum + curve[j][m];
    shift[m] = sum * S(static_cast<float>(2 * Unscented<6>::kWeight));
    out.mean[m] = r0[m] + shift[m];
  }
  ACCRETE_UNROLL
  for (int i = 0; i < M; ++i) {
    ACCRETE_UNROLL
    for (int k = i; k < M; ++k) {
      S sum = S(0);
      ACCRETE_UNROLL
      for (int j = 0; j < 6; ++j) sum = sum + (curve[j][i] - shift[i]) * (curve[j][k] - shift[k]);
      out.even(i, k) = sum * S(static_cast<float>(2 * Unscented<6>::kWeight)) +
                       S(static_cast<float>(Unscented<6>::kCovariance0)) * shift[i] * shift[k];
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
      for (int j = 0; j < 6; ++j) sum = sum + moments.odd[j][i] * moments.odd[j][k];
      c(i, k) = sum;
    }
  }
  return c;
}

}  // namespace accrete::inline ACCRETE_ISA
