// A junction: a point where 2 to 4 edges end, and the colours of the sectors between them. An arm is a direction in
// space; in the image the arms follow each other from +x towards +y, and sector i lies between arm i and the next.
#pragma once

#include <cmath>

#include "base/elementary.h"
#include "feature/feature.h"
#include "filter/appearance_kernel.h"
#include "math/lane_real.h"
#include "stereo/reconstruct_kernel.h"

namespace accrete::inline ACCRETE_ISA {
namespace feature {

// From one unit vector of the image to another, -pi .. pi.
template <class S>
S angle_to(S c, S s, S c2, S s2) {
  return atan2_of(c * s2 - s * c2, c * c2 + s * s2);
}

template <int Arms>
requires(Arms >= 2 && Arms <= 4) struct Junction {
  static constexpr bool kPositionInMap = true;
  static constexpr int kTangent = 3 + 2 * Arms;  // position, and two tilts of every arm
  static constexpr int kObservable = kTangent;   // a corner does not slide
  static constexpr double kSpread2 = 3;          // the fourth moment of a Gaussian (docs/math/features.md)
  static constexpr int kAcross = 2, kSenses = Arms, kPhases = 0, kColours = Arms;
  static constexpr int kEye = 2 + Arms;  // point px, angles
  static constexpr int residuals(int eyes) { return kEye * eyes; }

  // Two arms nearer than 15 degrees in an image, five deviations of their difference (METHOD 1.4), are not told apart.
  static constexpr float kMinApartCosine = 0.9659F;
  // sin(25 degrees): an arm nearer to the epipolar line has no direction in depth; no junction is born (METHOD 2.1).
  static constexpr float kMinPsiSine = 0.4226F;

  template <class S>
  struct State {
    Vector3<S> p;
    Quat<S> arm[Arms];  // local x is the direction; what is left of the frame only carries the tilts' axes along
  };
  template <class S>
  struct View {
    S x, y;
    S c[Arms], s[Arms];  // unit directions away from the point
    S sigma_px, sigma_angle;
  };

  template <class S>
  static State<S> retract(const State<S>& x, const S* d) {
    State<S> y;
    for (int i = 0; i < 3; ++i) y.p[i] = x.p[i] + d[i];
    for (int i = 0; i < Arms; ++i) y.arm[i] = accrete::retract(x.arm[i], S(0), d[3 + 2 * i], d[4 + 2 * i]);
    return y;
  }
  template <class S>
  static void local(const State<S>& from, const State<S>& to, S* d) {
    for (int i = 0; i < 3; ++i) d[i] = to.p[i] - from.p[i];
    for (int i = 0; i < Arms; ++i) {
      const Vector3<S> u = rotate_back<S>(rotation_matrix(from.arm[i]), rotation_matrix(to.arm[i]).col(0));
      const Tilt<S> tilt = tilt_to(u[0], u[1], u[2]);
      d[3 + 2 * i] = tilt.b;
      d[4 + 2 * i] = tilt.a;
    }
  }
  template <class S>
  static void settle(Symmetric<S, kTangent>&, const S*) {}  // tilts carry their own axes along
  template <class S>
  static State<S> moved(const State<S>& x, const Rigid<S>& motion) {
    State<S> y;
    y.p = motion * x.p;
    for (int i = 0; i < Arms; ++i) y.arm[i] = normalized(motion.q * x.arm[i]);
    return y;
  }

  // Refused: behind the camera; an arm that points at it, whose image is a point; two arms in one place; arms in
  // another cyclic order, which is the view from behind.
  template <class S>
  static Bool<S> look(const State<S>& x, const Camera<S>& camera, View<S>& view) {
    const Vector3<S> q = Rigid<S>{camera.R, {}, camera.t} * x.p;
    Bool<S> visible = q[2] > S(kMinDepth_m);
    const S scale = camera.focal / select(visible, q[2], S(kMinDepth_m));
    view.x = q[0] * scale;
    view.y = q[1] * scale;
    view.sigma_px = view.sigma_angle = S(0);
    for (int i = 0; i < Arms; ++i) {
      const Vector3<S> u = rotate<S>(camera.R, rotation_matrix(x.arm[i]).col(0)), n = cross(q, u);
      const S length2 = n[0] * n[0] + n[1] * n[1];
      const S k = inverse_sqrt(max_of(length2, S(1e-12F) * q[2] * q[2]));
      view.c[i] = n[1] * k;
      view.s[i] = -n[0] * k;
      visible = visible & (length2 > S(1e-6F) * q[2] * q[2]);  // as is_in_front (predict/residual_kernel.h)
    }
    return visible & is_ordered(view);
  }
  // Once round, and no two arms in one place.
  template <class S>
  static Bool<S> is_ordered(const View<S>& v) {
    Bool<S> good = S(0) == S(0);
    S sum = S(0);
    for (int i = 0; i < Arms; ++i) {
      const int k = (i + 1) % Arms;
      const S gap = angle_to(v.c[i], v.s[i], v.c[k], v.s[k]);
      sum += select(gap < S(0), gap + S(kTwoPi), gap);
      good = good & (v.c[i] * v.c[k] + v.s[i] * v.s[k] < S(kMinApartCosine));
    }
    return good & (sum < S(1.5F * kTwoPi));  // a sum of gaps is a whole number of turns
  }

  template <int Eyes, class S>
  static void difference(const View<S>* predicted, const View<S>* observed, S* r) {
    for (int e = 0; e < Eyes; ++e) {
      const View<S>&p = predicted[e], &o = observed[e];
      r[kEye * e] = o.x - p.x;
      r[kEye * e + 1] = o.y - p.y;
      for (int i = 0; i < Arms; ++i) r[kEye * e + 2 + i] = angle_to(p.c[i], p.s[i], o.c[i], o.s[i]);
    }
  }
  template <int Eyes, class S>
  static void noise(const View<S>* observed, Symmetric<S, kEye * Eyes>& R) {
    for (S& v : R.v) v = S(0);
    for (int m = 0; m < kEye * Eyes; ++m) {
      const View<S>& o = observed[m / kEye];
      R(m, m) = m % kEye < 2 ? o.sigma_px * o.sigma_px : o.sigma_angle * o.sigma_angle;
    }
  }
  template <class S>
  static void observable(const State<S>& from, const State<S>& to, S* d, S (*J)[kTangent]) {
    local(from, to, d);
    for (int i = 0; i < kTangent; ++i)
      for (int k = 0; k < kTangent; ++k) J[i][k] = S(i == k ? 1 : 0);
  }

  // The list of arms may begin with any of them.
  static View<float> described(const View<float>& v, int sense) {
    View<float> w = v;
    for (int i = 0; i < Arms; ++i) {
      w.c[i] = v.c[(i + sense) % Arms];
      w.s[i] = v.s[(i + sense) % Arms];
    }
    return w;
  }
  static std::array<float, 3 * Arms> described(const std::array<float, 3 * Arms>& a, int sense) {
    std::array<float, 3 * Arms> b{};
    for (std::size_t i = 0; i < b.size(); ++i) b[i] = a[(i + 3 * static_cast<std::size_t>(sense)) % b.size()];
    return b;
  }
  static bool near(const View<float>& predicted, const View<float>& observed) {
    float r[kEye];
    difference<1>(&predicted, &observed, r);
    bool near = std::fabs(r[0]) <= kMaxAcross && std::fabs(r[1]) <= kMaxAcross;
    for (int i = 2; i < kEye; ++i) near = near && std::fabs(r[i]) <= kMaxAngle;
    return near;
  }
  // Any arm may be any: Arms! orders of independent directions.
  static float log_chance(int eyes) {
    constexpr float kFactorial = Arms == 2 ? 2 : Arms == 3 ? 6 : 24;
    return static_cast<float>(eyes) * (log_of(kFactorial) - static_cast<float>(Arms) * log_of(kTwoPi));
  }

  template <class S>
  static void perturbed(const View<S>* views, const S* r, View<S>* out) {
    for (int e = 0; e < 2; ++e) {
      out[e] = views[e];
      out[e].x += r[kEye * e];
      out[e].y += r[kEye * e + 1];
      for (int i = 0; i < Arms; ++i) {
        const SineCosine<S> turn = sine_cosine(r[kEye * e + 2 + i]);
        out[e].c[i] = views[e].c[i] * turn.cosine - views[e].s[i] * turn.sine;
        out[e].s[i] = views[e].s[i] * turn.cosine + views[e].c[i] * turn.sine;
      }
    }
  }
  // The point from the disparity; every arm as the intersection of its two back-projected planes (METHOD 3.1).
  template <class S>
  static ReconstructOutcome reconstruct(const View<S>* views, const AlignedOptics& optics, State<S>& x) {
    const View<S>&l = views[0], &r = views[1];
    const S focal = S(optics.focal_px), baseline = S(optics.baseline_m), row = S(0.5F) * (l.y + r.y);
    const S depth = focal * baseline / (l.x - r.x);
    if (!is_finite(depth) || !is_finite(row * l.x)) return ReconstructOutcome::kDegenerate;
    if (!(depth > S(kMinDepth_m))) return ReconstructOutcome::kBehind;
    if (!is_ordered(l) || !is_ordered(r)) return ReconstructOutcome::kDegenerate;
    x.p = {l.x / focal * depth, row / focal * depth, depth};
    for (int i = 0; i < Arms; ++i) {
      if (!(abs_of(l.s[i]) > S(kMinPsiSine)) || !(abs_of(r.s[i]) > S(kMinPsiSine)) || !(l.s[i] * r.s[i] > S(0)))
        return ReconstructOutcome::kDegenerate;
      const Vector3<S> t =
          intersect<S>({l.x, row, l.c[i], l.s[i]}, {r.x, row, r.c[i], r.s[i]}, focal, baseline).tangent;
      const Tilt<S> tilt = tilt_to(t[0], t[1], t[2]);
      x.arm[i] = exp_rotation(S(0), tilt.b, tilt.a);
      if (!is_finite(x.arm[i].w)) return ReconstructOutcome::kDegenerate;
    }
    return ReconstructOutcome::kOk;
  }
};

}  // namespace feature
}  // namespace accrete::inline ACCRETE_ISA
