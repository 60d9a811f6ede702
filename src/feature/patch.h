// A patch of surface: a point, its normal with a direction in the plane, and a colour. An eye sees the point and the
// affine shape: the images of the two axes in the plane. From one eye to the other that shape changes by the gradient
// of the disparity, and that is the normal; its size and shear on the surface are not known and say nothing.
#pragma once

#include <cmath>

#include "base/elementary.h"
#include "feature/feature.h"
#include "filter/reconstructed_kernel.h"
#include "math/lane_real.h"
#include "stereo/reconstruct_kernel.h"

namespace accrete::inline ACCRETE_ISA {
namespace feature {

struct Patch {
  static constexpr bool kPositionInMap = true;
  static constexpr int kTangent = 6;     // position, tilts about local x and y, turn about the normal
  static constexpr int kObservable = 6;  // the turn from the direction of the first axis
  static constexpr double kSpread2 = 3;  // the fourth moment of a Gaussian (docs/math/features.md)
  static constexpr int kAcross = 2;
  static constexpr int kSenses = 2;  // the axes, or both of them the other way
  static constexpr int kPhases = 0, kColours = 1;
  // Point px and angle; of both eyes two points, the left angle, and the gradient of the disparity. The right angle
  // follows from those: the shape of the right eye is the left one's, sheared.
  static constexpr int residuals(int eyes) { return eyes == 1 ? 3 : 7; }

  // cos(80 degrees), between normal and ray: seen more from the edge there is no shape to speak of.
  static constexpr float kMinFacing = 0.1736F;

  template <class S>
  struct State {
    Vector3<S> p;
    Quat<S> q;  // local z is the normal, away from the viewer, local x the direction in the plane
  };
  template <class S>
  struct View {
    S x, y;
    S a[2][2];                 // column k: image of axis k, in any unit
    S sigma_px, sigma_affine;  // of every element of the relative error E of the shape, (I + E) a
  };

  template <class S>
  static State<S> retract(const State<S>& x, const S* d) {
    // First the tilt, then the turn about the new normal, which may be hardly known (docs/math/prediction.md).
    return {{x.p[0] + d[0], x.p[1] + d[1], x.p[2] + d[2]},
            normalized(x.q * exp_rotation(d[3], d[4], S(0)) * exp_rotation(S(0), S(0), d[5]))};
  }
  template <class S>
  static void local(const State<S>& from, const State<S>& to, S* d) {
    for (int i = 0; i < 3; ++i) d[i] = to.p[i] - from.p[i];
    // The chart of the edge, whose local x is this z: roll, b, a are turn and tilts about x and y.
    const Quat<S> f{from.q.z, from.q.x, from.q.y, from.q.w}, t{to.q.z, to.q.x, to.q.y, to.q.w};
    const RotationBetween<S> turn = rotation_between(f, t);
    d[3] = turn.b;
    d[4] = turn.a;
    d[5] = turn.roll;
  }
  template <class S>
  static void settle(Symmetric<S, kTangent>& P, const S* d) {
    // A tilt by d before one by e turns the frame by -(1 - cos |d|) / |d|^2 (d x e) about the normal: known tilts would
    // leak into the turn, which an edge does not know and a patch does (docs/math/features.md).
    const HalfAngle<S> tilt = half_angle(d[3] * d[3] + d[4] * d[4]);
    const S k = S(2) * tilt.sine_over_angle * tilt.sine_over_angle, x = -k * d[3], y = k * d[4];
    P(5, 5) += S(2) * (x * P(4, 5) + y * P(3, 5)) + x * x * P(4, 4) + S(2) * x * y * P(3, 4) + y * y * P(3, 3);
    for (int i = 0; i < 5; ++i) P(i, 5) += x * P(i, 4) + y * P(i, 3);
    // And as turn_pair of an edge (math/lane_state.h): the tilts' axes turn with the frame.
    const HalfAngle<S> h = half_angle(d[5] * d[5]);
    const S v = d[5] * h.sine_over_angle, c = S(1) - S(2) * v * v, s = S(2) * v * h.cosine;
    for (const int i : {0, 1, 2, 5}) {
      const S a = P(i, 3), b = P(i, 4);
      P(i, 3) = c * a + s * b;
      P(i, 4) = c * b - s * a;
    }
    const S aa = P(3, 3), ab = P(3, 4), bb = P(4, 4);
    P(3, 3) = c * c * aa + S(2) * c * s * ab + s * s * bb;
    P(3, 4) = c * s * (bb - aa) + (c * c - s * s) * ab;
    P(4, 4) = s * s * aa - S(2) * c * s * ab + c * c * bb;
  }
  template <class S>
  static State<S> moved(const State<S>& x, const Rigid<S>& motion) {
    return {motion * x.p, normalized(motion.q * x.q)};
  }

  // Refused: behind the camera, seen edge-on or from behind.
  template <class S>
  static Bool<S> look(const State<S>& x, const Camera<S>& camera, View<S>& view) {
    const Matrix3<S> own = rotation_matrix(x.q);
    const Vector3<S> q = Rigid<S>{camera.R, {}, camera.t} * x.p, normal = rotate<S>(camera.R, own.col(2));
    const Bool<S> in_front = q[2] > S(kMinDepth_m);
    const S inverse = S(1) / select(in_front, q[2], S(kMinDepth_m)), scale = camera.focal * inverse;
    view.x = q[0] * scale;
    view.y = q[1] * scale;
    view.sigma_px = view.sigma_affine = S(0);
    for (int k = 0; k < 2; ++k) {
      const Vector3<S> axis = rotate<S>(camera.R, own.col(k));
      for (int i = 0; i < 2; ++i) view.a[i][k] = scale * (axis[i] - q[i] * inverse * axis[2]);
    }
    const S facing = dot(normal, q);
    return in_front & (facing > S(0)) & (facing * facing > S(kMinFacing * kMinFacing) * dot(q, q));
  }

  // First row of a_r a_l^-1: (1 - g_x, -g_y), g the gradient of the disparity in the left image.
  template <class S>
  static void shear(const View<S>& l, const View<S>& r, S& along_x, S& along_y) {
    const S determinant = l.a[0][0] * l.a[1][1] - l.a[0][1] * l.a[1][0];
    const S k = S(1) / select(abs_of(determinant) > S(1e-12F), determinant, S(1e-12F));
    along_x = (r.a[0][0] * l.a[1][1] - r.a[0][1] * l.a[1][0]) * k;
    along_y = (r.a[0][1] * l.a[0][0] - r.a[0][0] * l.a[0][1]) * k;
  }
  template <int Eyes, class S>
  static void difference(const View<S>* predicted, const View<S>* observed, S* r) {
    for (int e = 0; e < Eyes; ++e) {
      r[2 * e] = observed[e].x - predicted[e].x;
      r[2 * e + 1] = observed[e].y - predicted[e].y;
    }
    const auto &p = predicted[0].a, &o = observed[0].a;
    r[2 * Eyes] = atan2_of(p[0][0] * o[1][0] - p[1][0] * o[0][0], p[0][0] * o[0][0] + p[1][0] * o[1][0]);
    if constexpr (Eyes == 2) {
      S px, py, ox, oy;
      shear(predicted[0], predicted[1], px, py);
      shear(observed[0], observed[1], ox, oy);
      r[5] = px - ox;  // of g: the other sign
      r[6] = py - oy;
    }
  }
  // The left shape is in the angle and in the gradient: their errors are correlated (docs/math/features.md).
  template <int Eyes, class S>
  static void noise(const View<S>* observed, Symmetric<S, (Eyes == 1 ? 3 : 7)>& R) {
    for (S& v : R.v) v = S(0);
    for (int m = 0; m < 2 * Eyes; ++m) R(m, m) = observed[m / 2].sigma_px * observed[m / 2].sigma_px;
    const auto& a = observed[0].a;
    const S left = observed[0].sigma_affine * observed[0].sigma_affine;
    R(2 * Eyes, 2 * Eyes) = left;
    if constexpr (Eyes == 2) {
      const S right = observed[1].sigma_affine * observed[1].sigma_affine;
      const S k = inverse_sqrt(max_of(a[0][0] * a[0][0] + a[1][0] * a[1][0], S(1e-20F)));
      const S c = a[0][0] * k, s = a[1][0] * k;
      S m, n;  // first row of the shear
      shear(observed[0], observed[1], m, n);
      R(5, 5) = right * m * m + left * (m * m + n * n);
      R(5, 6) = right * m * n;
      R(6, 6) = right * (n * n + S(1)) + left * (m * m + n * n);
      R(4, 5) = left * c * (n * c - m * s);
      R(4, 6) = left * s * (n * c - m * s);
    }
  }
  template <class S>
  static void observable(const State<S>& from, const State<S>& to, S* d, S (*J)[kTangent]) {
    local(from, to, d);
    for (int i = 0; i < kTangent; ++i)
      for (int k = 0; k < kTangent; ++k) J[i][k] = S(i == k ? 1 : 0);
  }

  static View<float> described(const View<float>& v, int sense) {
    View<float> w = v;
    if (sense != 0)
      for (auto& row : w.a)
        for (float& element : row) element = -element;
    return w;
  }
  static std::array<float, 3> described(const std::array<float, 3>& a, int) { return a; }
  static bool near(const View<float>& predicted, const View<float>& observed) {
    float r[3];
    difference<1>(&predicted, &observed, r);
    return std::fabs(r[0]) <= kMaxAcross && std::fabs(r[1]) <= kMaxAcross && std::fabs(r[2]) <= kMaxAngle;
  }
  // An undirected angle, 1 / pi; and a gradient below 1 in either direction, where human vision ends as well (Burt and
  // Julesz, A disparity gradient limit for binocular fusion, Science 208, 1980).
  static float log_chance(int eyes) { return -1.1447299F - (eyes == 2 ? 1.3862944F : 0.0F); }

  template <class S>
  static void perturbed(const View<S>* views, const S* r, View<S>* out) {
    const SineCosine<S> turn = sine_cosine(r[4]);
    S m, n;
    shear(views[0], views[1], m, n);
    for (int e = 0; e < 2; ++e) {
      out[e] = views[e];
      out[e].x += r[2 * e];
      out[e].y += r[2 * e + 1];
    }
    for (int k = 0; k < 2; ++k) {
      out[0].a[0][k] = views[0].a[0][k] * turn.cosine - views[0].a[1][k] * turn.sine;
      out[0].a[1][k] = views[0].a[1][k] * turn.cosine + views[0].a[0][k] * turn.sine;
      out[1].a[0][k] = (m - r[5]) * out[0].a[0][k] + (n - r[6]) * out[0].a[1][k];
      out[1].a[1][k] = out[0].a[1][k];
    }
  }
  // On the plane n.X = h the disparity is f b / Z = (b / h) n.(x, y, f): its gradient is (b / h)(n_x, n_y).
  template <class S>
  static ReconstructOutcome reconstruct(const View<S>* views, const AlignedOptics& optics, State<S>& x) {
    const View<S>&l = views[0], &r = views[1];
    const S focal = S(optics.focal_px), row = S(0.5F) * (l.y + r.y), disparity = l.x - r.x;
    const S depth = focal * S(optics.baseline_m) / disparity;
    if (!is_finite(depth) || !is_finite(row * l.x)) return ReconstructOutcome::kDegenerate;
    if (!(depth > S(kMinDepth_m))) return ReconstructOutcome::kBehind;
    S m, n;
    shear(l, r, m, n);
    const Vector3<S> plane = {S(1) - m, -n, (disparity - (S(1) - m) * l.x + n * row) / focal};
    const S k = inverse_sqrt(dot(plane, plane));
    const Vector3<S> normal = {plane[0] * k, plane[1] * k, plane[2] * k};
    x.p = {l.x / focal * depth, row / focal * depth, depth};
    const S facing = dot(normal, x.p);  // positive: the disparity is
    if (!(facing * facing > S(kMinFacing * kMinFacing) * dot(x.p, x.p))) return ReconstructOutcome::kDegenerate;
    if (!(l.a[0][0] * l.a[1][1] > l.a[0][1] * l.a[1][0])) return ReconstructOutcome::kDegenerate;  // a mirror image

    // The direction in the plane whose image is the first axis: where the plane through it and the camera meets it.
    const Vector3<S> through = cross<S>(x.p, {l.a[0][0], l.a[1][0], S(0)});
    Vector3<S> t = cross(normal, through);
    const S length2 = dot(t, t), sign = select(dot<S>(cross(x.p, t), through) < S(0), S(-1), S(1));
    if (!(length2 > S(0))) return ReconstructOutcome::kDegenerate;
    const S scale = sign * inverse_sqrt(length2);
    for (int i = 0; i < 3; ++i) t[i] = t[i] * scale;
    const Vector3<S> b = cross(normal, t);
    Matrix3<S> own;
    for (int i = 0; i < 3; ++i) {
      own(i, 0) = t[i];
      own(i, 1) = b[i];
      own(i, 2) = normal[i];
    }
    x.q = quaternion_of(own);
    return is_finite(x.q.w) ? ReconstructOutcome::kOk : ReconstructOutcome::kDegenerate;
  }
};

}  // namespace feature
}  // namespace accrete::inline ACCRETE_ISA
