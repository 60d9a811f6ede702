// The oriented edge as a kind of feature: what the lane kernels of predict/, filter/ and associate/ do, said once more
// in the terms of feature.h. A test holds them against each other; the pipeline runs the kernels.
#pragma once

#include <cmath>

#include "associate/candidates.h"
#include "feature/feature.h"
#include "filter/reconstructed_kernel.h"

namespace accrete::inline ACCRETE_ISA {
namespace feature {

struct Edge {
  static constexpr bool kPositionInMap = false;
  static constexpr int kTangent = 6;     // position along local x, y, z; roll, tilts about local y and z
  static constexpr int kObservable = 4;  // neither the slide along it nor the roll about it
  static constexpr double kSpread2 = 6;  // alpha = 1, kappa = 0 (METHOD 5.1)
  static constexpr int kAcross = 1, kSenses = 2, kPhases = 1, kColours = 2;
  static constexpr int residuals(int eyes) { return 2 * eyes; }  // offset px, sine of the angle

  template <class S>
  struct State {
    Vector3<S> p;
    Quat<S> q;  // local x is the tangent
  };
  template <class S>
  struct View {
    S x, y, c, s;
    S sigma_px, sigma_angle;
  };

  template <class S>
  static State<S> retract(const State<S>& x, const S* d) {
    return {x.p + rotate<S>(rotation_matrix(x.q), {d[0], d[1], d[2]}), accrete::retract(x.q, d[3], d[4], d[5])};
  }
  template <class S>
  static void local(const State<S>& from, const State<S>& to, S* d) {
    const Vector3<S> apart = rotate_back<S>(rotation_matrix(from.q), to.p - from.p);
    for (int i = 0; i < 3; ++i) d[i] = apart[i];
    const RotationBetween<S> turn = rotation_between(from.q, to.q);
    d[3] = turn.roll;
    d[4] = turn.b;
    d[5] = turn.a;
  }
  template <class S>
  static void settle(Symmetric<S, kTangent>& P, const S* d) {
    const HalfTurn<S> roll = half_turn(d[3]);
    turn_axes(P, turn_of(roll, d[4], d[5]), roll);
  }
  template <class S>
  static State<S> moved(const State<S>& x, const Rigid<S>& motion) {
    return {motion * x.p, normalized(motion.q * x.q)};
  }

  template <class S>
  static Bool<S> look(const State<S>& x, const Camera<S>& camera, View<S>& view) {
    const Vector3<S> t = rotate<S>(camera.R, rotation_matrix(x.q).col(0)), q = Rigid<S>{camera.R, {}, camera.t} * x.p;
    const Vector3<S> n = cross(q, t);  // the image of the line is n . (x, y, f) = 0 (docs/math/prediction.md)
    const S scale = camera.focal / select(abs_of(q[2]) > S(kMinDepth_m), q[2], S(kMinDepth_m));
    const S length2 = n[0] * n[0] + n[1] * n[1];
    const S k = inverse_sqrt(max_of(length2, S(1e-12F) * q[2] * q[2]));
    view = {q[0] * scale, q[1] * scale, n[1] * k, -n[0] * k, S(0), S(0)};
    return (q[2] > S(kMinDepth_m)) & (length2 > S(1e-6F) * q[2] * q[2]);  // as is_in_front
  }
  template <int Eyes, class S>
  static void difference(const View<S>* predicted, const View<S>* observed, S* r) {
    for (int e = 0; e < Eyes; ++e) {
      const View<S>&p = predicted[e], &o = observed[e];
      r[2 * e] = p.c * (o.y - p.y) - p.s * (o.x - p.x);
      r[2 * e + 1] = p.c * o.s - p.s * o.c;
    }
  }
  template <int Eyes, class S>
  static void noise(const View<S>* observed, Symmetric<S, 2 * Eyes>& R) {
    for (S& v : R.v) v = S(0);
    for (int e = 0; e < Eyes; ++e) {
      R(2 * e, 2 * e) = observed[e].sigma_px * observed[e].sigma_px;
      R(2 * e + 1, 2 * e + 1) = observed[e].sigma_angle * observed[e].sigma_angle;
    }
  }
  // Where the other line crosses the plane that is normal to this one at its point, and the tilts.
  template <class S>
  static void observable(const State<S>& from, const State<S>& to, S* d, S (*J)[kTangent]) {
    const Matrix3<S> own = rotation_matrix(from.q);
    const Vector3<S> t = rotate_back<S>(own, rotation_matrix(to.q).col(0));
    const Vector3<S> apart = rotate_back<S>(own, to.p - from.p);
    const Tilt<S> tilt = tilt_to(t[0], t[1], t[2]);
    const S reach = apart[0] / t[0];
    for (int i = 0; i < kObservable; ++i)
      for (int k = 0; k < kTangent; ++k) J[i][k] = S(0);
    for (int i = 0; i < 2; ++i) {
      d[i] = apart[i + 1] - reach * t[i + 1];
      J[i][i + 1] = S(1);
      J[i + 2][i + 4] = S(1);
    }
    d[2] = tilt.b;
    d[3] = tilt.a;
  }

  static View<float> described(const View<float>& v, int sense) {
    return sense == 0 ? v : View<float>{v.x, v.y, -v.c, -v.s, v.sigma_px, v.sigma_angle};
  }
  static std::array<float, 7> described(const std::array<float, 7>& a, int sense) {
    if (sense == 0) return a;
    return {-a[0], a[4], a[5], a[6], a[1], a[2], a[3]};  // reversed() of primitive.h
  }
  static bool near(const View<float>& predicted, const View<float>& observed) {
    const associate::Residual r = associate::residual(predicted.x, predicted.y, predicted.c, predicted.s,
                                                      {observed.x, observed.y, observed.c, observed.s, 0, 0});
    return !r.reversed && std::fabs(r.slide_px) <= associate::kSlideGate && std::fabs(r.n_px) <= kMaxAcross &&
           std::fabs(r.sine) <= kMaxSine;
  }
  static float log_chance(int eyes) { return -1.1447299F * static_cast<float>(eyes); }  // undirected: 1 / pi
};

template <>
struct RootOrder<Edge> {
  static constexpr int component(int k) { return k < 4 ? kSeen[k] : k == 4 ? kAlong : kRoll; }
};

}  // namespace feature
}  // namespace accrete::inline ACCRETE_ISA
