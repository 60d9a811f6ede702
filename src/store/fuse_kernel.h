// Comparing and fusing two primitives that may be the same edge, for float or double.
#pragma once

#include "filter/appearance_kernel.h"
#include "math/cholesky.h"
#include "math/lane_state.h"
#include "store/covariance_intersection.h"

namespace accrete::inline ACCRETE_ISA {

// The same edge, described in the opposite direction.
template <class S>
LaneState<S> reversed_state(LaneState<S> x) {
  x.q = {x.q.y, -x.q.x, x.q.w, -x.q.z};
  constexpr int kSign[6] = {-1, -1, 1, -1, -1, 1};
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j)
      if (kSign[i] != kSign[j]) x.P(i, j) = -x.P(i, j);
  return x;
}

// cos 60 degrees: beyond it the linearisation means nothing, and nothing is the same edge.
inline constexpr float kMinAgreement = 0.5F;

// A line in the own frame of a reference primitive at a point of its tangent: where it crosses the plane normal to the
// tangent there (two components), its direction as a tilt, and its roll; with the covariance of all five. Sliding a
// primitive along its own line changes nothing here, so slide and slide variance are out of it.
template <class S>
struct LocalLine {
  S value[5];  // along local y, along local z, roll, tilt about y, tilt about z
  Symmetric<S, 5> P;
};

// `own`: reference frame, `at`: the point on the reference line. x's tangent must agree with that of the frame.
template <class S>
LocalLine<S> local_line(const LaneState<S>& x, const Quat<S>& frame, const Vector3<S>& at) {
  const Matrix3<S> own = rotation_matrix(frame), R = rotation_matrix(x.q);
  const Vector3<S> t = rotate_back<S>(own, R.col(0));  // in the reference frame, as all below
  const Vector3<S> d = rotate_back<S>(own, {x.p[0] - at[0], x.p[1] - at[1], x.p[2] - at[2]});
  const S reach = -d[0] / t[0];  // along its own tangent to the crossing

  LocalLine<S> out;
  out.value[0] = d[1] + reach * t[1];
  out.value[1] = d[2] + reach * t[2];
  const Tilt<S> tilt = tilt_to(t[0], t[1], t[2]);
  out.value[3] = tilt.b;
  out.value[4] = tilt.a;
  // What is left after the tilt is a turn about the tangent: Exp(roll) e_z = (0, -sin, cos).
  const Matrix3<S> tilted = rotation_matrix(frame * exp_rotation(S(0), tilt.b, tilt.a));
  const S sine = -dot<S>(tilted.col(1), R.col(2)), cosine = dot<S>(tilted.col(2), R.col(2));
  out.value[2] = sine * angle_over_sine(cosine);

  // Rows of d(value)/d(error of x), all in its own frame: along, two across, roll, tilt b, tilt a. What moves it across
  // moves the crossing, which stays in the plane; what moves it along does not. A tilt (b, a) turns its tangent by
  // a * R_b - b * R_a, at the lever `reach`.
  S J[5][6] = {};
  const Vector3<S> rb = rotate_back<S>(own, R.col(1)), ra = rotate_back<S>(own, R.col(2));
  for (int i = 0; i < 2; ++i) {
    const S slope = t[i + 1] / t[0];
    J[i][1] = rb[i + 1] - slope * rb[0];
    J[i][2] = ra[i + 1] - slope * ra[0];
    J[i][4] = -reach * J[i][2];
    J[i][5] = reach * J[i][1];
  }
  // Tilts about the two tangents differ by the roll between the frames; nothing of the roll leaks into them.
  J[2][3] = S(1);
  J[3][4] = cosine;
  J[3][5] = -sine;
  J[4][4] = sine;
  J[4][5] = cosine;

  for (int i = 0; i < 5; ++i) {
    S row[6];
    for (int k = 0; k < 6; ++k) {
      row[k] = S(0);
      for (int m = 0; m < 6; ++m) row[k] += J[i][m] * x.P(m, k);
    }
    for (int j = i; j < 5; ++j) {
      out.P(i, j) = S(0);
      for (int k = 0; k < 6; ++k) out.P(i, j) += row[k] * J[j][k];
    }
  }
  return out;
}

// Without the roll: the four degrees of freedom that cameras see.
template <class S>
Symmetric<S, 4> observable(const Symmetric<S, 5>& P) {
  constexpr int kRow[4] = {0, 1, 3, 4};
  Symmetric<S, 4> o;
  for (int i = 0; i < 4; ++i)
    for (int j = i; j < 4; ++j) o(i, j) = P(kRow[i], kRow[j]);
  return o;
}

// Squared distance of two lines; -1 when it has none.
template <class S>
S line_distance2(const LaneState<S>& a, LaneState<S> b, S bias_variance) {
  const S agreement = dot<S>(rotation_matrix(a.q).col(0), rotation_matrix(b.q).col(0));
  if (!(abs_of(agreement) >= S(kMinAgreement))) return S(-1);
  if (agreement < S(0)) b = reversed_state(b);
  Vector3<S> half;
  for (int i = 0; i < 3; ++i) half[i] = S(0.5F) * (a.p[i] + b.p[i]);
  const LocalLine<S> la = local_line(a, a.q, half), lb = local_line(b, a.q, half);
  Symmetric<S, 4> sum = observable(la.P);
  const Symmetric<S, 4> other = observable(lb.P);
  for (int i = 0; i < 10; ++i) sum.v[i] += other.v[i];
  sum(0, 0) += bias_variance;
  sum(1, 1) += bias_variance;
  S d[4] = {lb.value[0] - la.value[0], lb.value[1] - la.value[1], lb.value[3], lb.value[4]};
  S inverse[4];
  if (!cholesky<4>(sum, sum, inverse)) return S(-1);
  solve_lower<4>(sum, inverse, d);
  return d[0] * d[0] + d[1] * d[1] + d[2] * d[2] + d[3] * d[3];
}

template <class S>
S appearance_distance2(const LaneAppearance<S>& a, const LaneAppearance<S>& b) {
  Symmetric<S, 7> sum = a.P;
  for (int i = 0; i < 28; ++i) sum.v[i] += b.P.v[i];
  S d[7], total = S(0);
  for (int i = 0; i < 7; ++i) d[i] = b.mean[i] - a.mean[i];
  d[0] = wrap_phase(d[0]);
  S inverse[7];
  if (!cholesky<7>(sum, sum, inverse)) return S(-1);
  solve_lower<7>(sum, inverse, d);
  for (int i = 0; i < 7; ++i) total += d[i] * d[i];
  return total;
}

// Fuses `other`, of the same sense, into x: the five coordinates of the line. The slide and its variance stay as they
// were. x is overwritten; false when it is then not a Gaussian.
template <class S>
bool fuse_lines(LaneState<S>& x, const LaneState<S>& other) {
  LocalLine<S> line = local_line(x, x.q, x.p);
  const LocalLine<S> second = local_line(other, x.q, x.p);
  S shift[5];
  const auto volume = [](const Symmetric<S, 5>& P) { return root_determinant(observable(P)); };
  if (!intersect_estimates(line.P, second.P, second.value, volume, shift)) return false;

  // The slide, uncorrelated, and the fused block.
  const S slide = x.P(0, 0);
  for (int i = 0; i < 5; ++i) {
    x.P(0, i + 1) = S(0);
    for (int j = i; j < 5; ++j) x.P(i + 1, j + 1) = line.P(i, j);
  }
  const S d[6] = {S(0), shift[0], shift[1], shift[2], shift[3], shift[4]};
  correct(x, rotation_matrix(x.q), d);
  return slide > S(0) && is_finite(x.q.w) && is_positive_definite(x.P);
}

template <class S>
bool fuse_appearance(LaneAppearance<S>& x, const LaneAppearance<S>& other) {
  S difference[7], shift[7];
  for (int i = 0; i < 7; ++i) difference[i] = other.mean[i] - x.mean[i];
  difference[0] = wrap_phase(difference[0]);
  const auto volume = [](const Symmetric<S, 7>& P) { return root_determinant(P); };
  if (!intersect_estimates(x.P, other.P, difference, volume, shift)) return false;
  for (int i = 0; i < 7; ++i) x.mean[i] += shift[i];
  x.mean[0] = wrap_any_phase(x.mean[0]);
  return is_phase(x.mean[0]);
}

}  // namespace accrete::inline ACCRETE_ISA
