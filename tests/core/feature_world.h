// Simulated junctions, patches and edges with known truth, and what cameras see of them: written from the geometry, in
// double, by projecting points. It shares nothing with src/feature but the records.
#pragma once

#include "feature/birth.h"
#include "feature/edge.h"
#include "feature/filter.h"
#include "feature/junction.h"
#include "feature/patch.h"
#include "numeric/dice.h"
#include "numeric/lane_bridge.h"

namespace accrete::test {

using feature::Edge;
using feature::Junction;
using feature::Patch;
using oracle::Dice;
using oracle::kDegree;
using oracle::Matrix3d;
using oracle::Optics;
using oracle::Pose;
using oracle::Vector2d;
using oracle::Vector3d;

// METHOD 1.4; and a shape that is known to 0.1 px over 20 px: 0.1 sqrt(12) / 20.
inline constexpr double kSigmaPx = 0.3, kSigmaAngle = 2 * kDegree, kSigmaAffine = 0.02;
// `noise` scales what is added, and the deviations that are stated; 0: an exact view with the usual deviations.
inline float stated(double sigma, double noise) { return static_cast<float>(noise > 0 ? noise * sigma : sigma); }

inline Vector2d image_of(const Vector3d& p, const Pose& pose, const Optics& optics, double offset) {
  const Vector3d q = pose.R * p + pose.t - Vector3d(offset, 0, 0);
  return optics.focal / q.z() * q.head<2>();
}
// How the image of p moves per metre along `direction`.
inline Vector2d image_slope(const Vector3d& p, const Vector3d& direction, const Pose& pose, const Optics& optics,
                            double offset) {
  constexpr double kStep = 1e-6;
  return (image_of(p + kStep * direction, pose, optics, offset) -
          image_of(p - kStep * direction, pose, optics, offset)) /
         (2 * kStep);
}

template <class S>
Quat<S> quat(const Matrix3d& R) {
  const Eigen::Quaterniond q(R);
  return {S(q.x()), S(q.y()), S(q.z()), S(q.w())};
}
// A rotation whose column `axis` is v.
inline Matrix3d with_axis(const Vector3d& v, int axis) {
  Matrix3d R;
  const Vector3d u = v.normalized(), o = u.unitOrthogonal();
  R.col(axis) = u;
  R.col((axis + 1) % 3) = o;
  R.col((axis + 2) % 3) = u.cross(o);
  return R;
}

// What is true, in double, and the views of it.
template <class F>
struct Truth;

template <int Arms>
struct Truth<Junction<Arms>> {
  using F = Junction<Arms>;
  Vector3d p;
  Vector3d arm[Arms];

  explicit Truth(Dice& dice) {
    p = {dice.uniform(-0.08, 0.08), dice.uniform(-0.06, 0.06), dice.uniform(0.65, 0.75)};
    constexpr double kAngle[3][4] = {{90, 270, 0, 0}, {57, 123, 270, 0}, {57, 123, 237, 303}};
    for (int i = 0; i < Arms; ++i) {
      const double spread = (Arms == 2 || (Arms == 3 && i == 2)) ? 35 : 8;
      const double a = (kAngle[Arms - 2][i] + dice.uniform(-spread, spread)) * kDegree;
      arm[i] = Vector3d(std::cos(a), std::sin(a), dice.uniform(-0.3, 0.3)).normalized();
    }
  }
  [[nodiscard]] typename F::template State<float> state() const {
    typename F::template State<float> x;
    x.p = p.cast<float>();
    for (int i = 0; i < Arms; ++i) x.arm[i] = quat<float>(with_axis(arm[i], 0));
    return x;
  }
  typename F::template View<float> observe(Dice& dice, const Pose& pose, const Optics& optics, double offset,
                                           double noise = 1) const {
    typename F::template View<float> v;
    const Vector2d x = image_of(p, pose, optics, offset);
    v.x = static_cast<float>(x.x() + noise * kSigmaPx * dice.normal());
    v.y = static_cast<float>(x.y() + noise * kSigmaPx * dice.normal());
    for (int i = 0; i < Arms; ++i) {
      const Vector2d u = image_slope(p, arm[i], pose, optics, offset);
      const double angle = std::atan2(u.y(), u.x()) + noise * kSigmaAngle * dice.normal();
      v.c[i] = static_cast<float>(std::cos(angle));
      v.s[i] = static_cast<float>(std::sin(angle));
    }
    v.sigma_px = stated(kSigmaPx, noise);
    v.sigma_angle = stated(kSigmaAngle, noise);
    return v;
  }
  // rad, root of the sum of squares over the arms.
  [[nodiscard]] double direction_error(const typename F::template State<float>& x) const {
    double sum = 0;
    for (int i = 0; i < Arms; ++i)
      sum +=
          std::pow(std::acos(std::min(1.0, rotation_matrix(x.arm[i]).col(0).template cast<double>().dot(arm[i]))), 2);
    return std::sqrt(sum / Arms);
  }
};

template <>
struct Truth<Patch> {
  using F = Patch;
  Vector3d p;
  Matrix3d R;  // the normal is the last column
  double size, stretch;

  explicit Truth(Dice& dice) {
    p = {dice.uniform(-0.08, 0.08), dice.uniform(-0.06, 0.06), dice.uniform(0.65, 0.75)};
    const Matrix3d tilt = oracle::exp_so3({dice.uniform(-0.4, 0.4), dice.uniform(-0.4, 0.4), 0});
    R = tilt * oracle::exp_so3({0, 0, dice.uniform(-3.1, 3.1)});
    size = dice.uniform(0.005, 0.02);
    stretch = dice.uniform(0.5, 2);
  }
  [[nodiscard]] F::State<float> state() const { return {p.cast<float>(), quat<float>(R)}; }
  F::View<float> observe(Dice& dice, const Pose& pose, const Optics& optics, double offset, double noise = 1) const {
    F::View<float> v;
    const Vector2d x = image_of(p, pose, optics, offset);
    v.x = static_cast<float>(x.x() + noise * kSigmaPx * dice.normal());
    v.y = static_cast<float>(x.y() + noise * kSigmaPx * dice.normal());
    Eigen::Matrix2d a, error;
    a << size * image_slope(p, R.col(0), pose, optics, offset),
        // The second axis of the shape is sheared on the surface: nobody knows what it really is.
        size * image_slope(p, stretch * R.col(1) + 0.3 * R.col(0), pose, optics, offset);
    for (double& e : error.reshaped()) e = noise * kSigmaAffine * dice.normal();
    a += error * a;
    for (int i = 0; i < 2; ++i)
      for (int k = 0; k < 2; ++k) v.a[i][k] = static_cast<float>(a(i, k));
    v.sigma_px = stated(kSigmaPx, noise);
    v.sigma_affine = stated(kSigmaAffine, noise);
    return v;
  }
  // Of the normal.
  [[nodiscard]] double direction_error(const F::State<float>& x) const {
    return std::acos(std::min(1.0, rotation_matrix(x.q).col(2).cast<double>().dot(R.col(2))));
  }
};

template <>
struct Truth<Edge> {
  using F = Edge;
  oracle::Edge edge;

  explicit Truth(Dice& dice) : edge(dice.edge()) {}
  [[nodiscard]] F::State<float> state() const { return {edge.p.cast<float>(), quat<float>(edge.R)}; }
  F::View<float> observe(Dice& dice, const Pose& pose, const Optics& optics, double offset, double noise = 1) const {
    const LineElement e =
        dice.observe(edge, pose, optics, offset, noise * kSigmaPx, noise * kSigmaAngle, noise * 2);  // slide px
    return {e.x_px, e.y_px, e.c, e.s, stated(kSigmaPx, noise), stated(kSigmaAngle, noise)};
  }
};

// The map turns by `turn_deg` in front of the cameras, about a point at 0.7 m; the first pose is the identity.
inline Pose turned_pose(double turn_deg) {
  Pose pose;
  pose.R = oracle::exp_so3(Vector3d(0.2, 1, 0.1).normalized() * turn_deg * kDegree);
  pose.t = Vector3d(0, 0, 0.7) - pose.R * Vector3d(0, 0, 0.7);
  return pose;
}

}  // namespace accrete::test
