// Reconstruction of an oriented edge from two line elements, for float or double (births are few: no lanes).
#pragma once

#include "math/cholesky.h"
#include "math/lane_state.h"
#include "math/unscented.h"
#include "stereo/reconstruct.h"

namespace accrete::inline ACCRETE_ISA {

// A line element without its noise.
template <class S>
struct Element {
  S x, y, c, s;
};

// Moved by `slide` along, by `normal` across, and turned by `angle`.
template <class S>
Element<S> moved(const Element<S>& e, S slide, S normal, S angle) {
  const HalfAngle<S> h = half_angle(angle * angle);
  const S v = angle * h.sine_over_angle;
  const S cosine = S(1) - S(2) * v * v, sine = S(2) * v * h.cosine;
  return {e.x + slide * e.c - normal * e.s, e.y + slide * e.s + normal * e.c, e.c * cosine - e.s * sine,
          e.s * cosine + e.c * sine};
}

template <class S>
struct EdgePoint {
  Vector3<S> point, tangent;  // aligned left frame; tangent signed by the left direction
  S plane_sine;               // sine of the angle between the two back-projected planes
};

// Left ray meets right plane; tangent along the intersection of both planes (METHOD 3.1).
template <class S>
EdgePoint<S> intersect(const Element<S>& l, const Element<S>& r, S focal, S baseline) {
  const S k = S(1) / focal;
  const Vector3<S> ray = {l.x * k, l.y * k, S(1)};
  const Vector3<S> nl = {-l.s, l.c, (l.x * l.s - l.y * l.c) * k};  // ray x direction
  const Vector3<S> nr = {-r.s, r.c, (r.x * r.s - r.y * r.c) * k};
  EdgePoint<S> e;
  const S depth = nr[0] * baseline / dot(nr, ray);
  e.point = {ray[0] * depth, ray[1] * depth, depth};
  e.tangent = cross(nl, nr);
  const S length2 = dot(e.tangent, e.tangent);
  e.plane_sine = sqrt_of(length2 / (dot(nl, nl) * dot(nr, nr)));
  // The moment of the line points along nl exactly when its image runs along the left direction.
  const S sense = dot<S>(cross(e.point, e.tangent), nl);
  const S scale = select(sense < S(0), S(-1), S(1)) * inverse_sqrt(length2);
  for (int i = 0; i < 3; ++i) e.tangent[i] = e.tangent[i] * scale;
  return e;
}

// The quaternion of a rotation matrix, by the largest of its four squared elements.
template <class S>
Quat<S> quaternion_of(const Matrix3<S>& m) {
  const S xx = S(1) + m(0, 0) - m(1, 1) - m(2, 2), yy = S(1) - m(0, 0) + m(1, 1) - m(2, 2);
  const S zz = S(1) - m(0, 0) - m(1, 1) + m(2, 2), ww = S(1) + m(0, 0) + m(1, 1) + m(2, 2);
  const S xw = m(2, 1) - m(1, 2), yw = m(0, 2) - m(2, 0), zw = m(1, 0) - m(0, 1);
  const S xy = m(0, 1) + m(1, 0), xz = m(0, 2) + m(2, 0), yz = m(1, 2) + m(2, 1);
  if (ww >= xx && ww >= yy && ww >= zz) return normalized(Quat<S>{xw, yw, zw, ww});
  if (xx >= yy && xx >= zz) return normalized(Quat<S>{xx, xy, xz, xw});
  if (yy >= zz) return normalized(Quat<S>{xy, yy, yz, yw});
  return normalized(Quat<S>{xz, yz, zz, zw});
}

// Variance added to every reconstruction, position and rotation (METHOD 3.3): (10 um)^2, (0.1 mrad)^2.
inline constexpr float kBirthPositionVariance = 1e-10F;
inline constexpr float kBirthRotationVariance = 1e-8F;

template <class S>
struct Noise5 {
  S slide, normal_l, angle_l, normal_r, angle_r;  // standard deviations
};

template <class S>
ReconstructOutcome reconstruct(const Element<S>& l, const Element<S>& r, const Noise5<S>& sigma, S focal, S baseline,
                               S sigma_roll, S min_plane_sine, LaneState<S>& out) {
  const EdgePoint<S> centre = intersect(l, r, focal, baseline);
  const Vector3<S>& t = centre.tangent;
  if (!(centre.plane_sine >= min_plane_sine)) return ReconstructOutcome::kDegenerate;
  if (!is_finite(dot(centre.point, centre.point))) return ReconstructOutcome::kDegenerate;
  if (!(centre.point[2] > S(kMinDepth_m))) return ReconstructOutcome::kBehind;

  const Vector3<S> v = {centre.point[0] - S(0.5F) * baseline, centre.point[1], centre.point[2]};
  const S along = dot(v, t);
  Vector3<S> a = {v[0] - along * t[0], v[1] - along * t[1], v[2] - along * t[2]};
  const S length2 = dot(a, a);
  if (!(length2 > S(1e-6F) * dot(v, v))) return ReconstructOutcome::kDegenerate;  // seen from its end
  const S scale = inverse_sqrt(length2);
  for (int i = 0; i < 3; ++i) a[i] = a[i] * scale;
  const Vector3<S> b = cross(a, t);

  // Sigma points: each moves one of the five inputs, so the covariance is a sum over ten differences. Components: point
  // along t, b and a, tilt about b, tilt about a.
  constexpr int kInputs = 5;
  S point[2 * kInputs][5];
  S mean[5] = {};
  const S spread = S(static_cast<float>(kSpread5));
  for (int k = 0; k < 2 * kInputs; ++k) {
    const S h = k % 2 == 0 ? spread : -spread;
    Element<S> le = l, re = r;
    switch (k / 2) {
      case 0:
        le = moved(l, h * sigma.slide, S(0), S(0));
        break;
      case 1:
        le = moved(l, S(0), h * sigma.normal_l, S(0));
        break;
      case 2:
        le = moved(l, S(0), S(0), h * sigma.angle_l);
        break;
      case 3:
        re = moved(r, S(0), h * sigma.normal_r, S(0));
        break;
      default:
        re = moved(r, S(0), S(0), h * sigma.angle_r);
        break;
    }
    const EdgePoint<S> e = intersect(le, re, focal, baseline);
    if (!(e.point[2] > S(kMinDepth_m)) || !is_finite(dot(e.point, e.point))) return ReconstructOutcome::kDegenerate;
    const Tilt<S> tilt = tilt_to(dot(e.tangent, t), dot(e.tangent, b), dot(e.tangent, a));
    const Vector3<S> shift = {e.point[0] - centre.point[0], e.point[1] - centre.point[1], e.point[2] - centre.point[2]};
    point[k][0] = dot(shift, t);
    point[k][1] = dot(shift, b);
    point[k][2] = dot(shift, a);
    point[k][3] = tilt.b;
    point[k][4] = tilt.a;
    for (int i = 0; i < 5; ++i) mean[i] += S(static_cast<float>(Unscented<5>::kWeight)) * point[k][i];
  }

  constexpr int kRow[5] = {0, 1, 2, 4, 5};  // of the six; 3 is the roll
  for (int i = 0; i < 21; ++i) out.P.v[i] = S(0);
  for (int i = 0; i < 5; ++i) {
    for (int j = i; j < 5; ++j) {
      S sum = S(static_cast<float>(Unscented<5>::kCovariance0)) * mean[i] * mean[j];
      for (int k = 0; k < 2 * kInputs; ++k)
        sum += S(static_cast<float>(Unscented<5>::kWeight)) * (point[k][i] - mean[i]) * (point[k][j] - mean[j]);
      out.P(kRow[i], kRow[j]) = sum;
    }
  }
  out.P(3, 3) = sigma_roll * sigma_roll;
  for (int i = 0; i < 6; ++i) out.P(i, i) += S(i < 3 ? kBirthPositionVariance : kBirthRotationVariance);

  Matrix3<S> own;
  for (int i = 0; i < 3; ++i) {
    own(i, 0) = t[i];
    own(i, 1) = b[i];
    own(i, 2) = a[i];
  }
  out.p = centre.point;
  out.q = quaternion_of(own);
  return is_positive_definite(out.P) ? ReconstructOutcome::kOk : ReconstructOutcome::kDegenerate;
}

}  // namespace accrete::inline ACCRETE_ISA
