// Finite, and otherwise anything: covariances from 1e-12 to 1e6, nearly singular ones, points at the edge of the image,
// behind the cameras and at infinity, edges that point at a camera or along its epipolar lines.
#pragma once

#include "math/cholesky.h"
#include "math/record_state.h"
#include "numeric/dice.h"
#include "predict/predict.h"

namespace accrete::oracle {

class Wild : public Dice {
 public:
  using Dice::Dice;

  double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  bool one_in(unsigned n) { return index(n) == 0; }
  VectorXd sigmas(Eigen::Index n) {  // of variances 1e-12 .. 1e6
    VectorXd s(n);
    for (Eigen::Index i = 0; i < n; ++i) s[i] = std::sqrt(log_uniform(1e-12, 1e6));
    return s;
  }
  // Half of them nearly of rank one: correlations up to 1 - 1e-6.
  MatrixXd any_covariance(Eigen::Index n) {
    const VectorXd s = sigmas(n);
    MatrixXd C = covariance(s);
    if (one_in(2)) {
      VectorXd v = s;
      for (Eigen::Index i = 0; i < n; ++i) v[i] = one_in(2) ? v[i] : -v[i];
      const double part = log_uniform(1e-6, 1e-1);
      C = part * C + (1 - part) * v * v.transpose();
    }
    return C;
  }
  Vector3d any_point() {
    const double z = log_uniform(0.01, 100);
    switch (index(8)) {
      case 0:
        return {uniform(-2, 2) * z, uniform(-2, 2) * z, z};  // around and beyond the border of the image
      case 1:
        return {uniform(-1, 1) * z, uniform(-1, 1) * z, -z};
      case 2:
        return 1e-4 * normal3();  // at the left camera
      case 3:
        return {0.12 + 1e-4 * normal(), 1e-4 * normal(), log_uniform(1e-4, 1)};  // before the right one
      case 4:
        return log_uniform(1e3, 1e9) * normal3();
      case 5:
        return log_uniform(1e9, 1e38) * normal3().normalized();
      default:
        return {uniform(-0.3, 0.3) * z, uniform(-0.3, 0.3) * z, z};
    }
  }
  Edge any_edge() {
    Edge x;
    x.p = any_point();
    x.R = rotation();
    if (one_in(4)) {  // along the ray, along the epipolar line
      const Vector3d t =
          ((one_in(2) ? Vector3d(x.p.normalized()) : Vector3d(1, 0, 0)) + log_uniform(1e-9, 1) * normal3())
              .normalized();
      const Vector3d a = t.cross(normal3()).normalized();
      x.R << t, a.cross(t), a;
    }
    x.P = any_covariance(6);
    return x;
  }
  // A state as the store may hold it: float, and definite for float.
  Geometry any_geometry() {
    for (;;) {
      const Geometry g = record_of(any_edge());
      if (is_positive_definite(accrete::state_of<float>(g).P)) return g;
    }
  }
  LineElement any_element() {
    LineElement e;
    const double reach = one_in(4) ? log_uniform(1e3, 1e9) : 700;
    e.x_px = static_cast<float>(uniform(-reach, reach));
    e.y_px = static_cast<float>(uniform(-reach, reach));
    const double angle = one_in(4) ? 0.5 * 3.14159265358979 * index(4) + 1e-6 * normal() : uniform(-3.2, 3.2);
    e.c = static_cast<float>(std::cos(angle));
    e.s = static_cast<float>(std::sin(angle));
    e.sigma_n_px = static_cast<float>(std::sqrt(log_uniform(1e-12, 1e6)));
    e.sigma_theta = static_cast<float>(std::sqrt(log_uniform(1e-12, 1e6)));
    return e;
  }
  // What a camera would see of it, or anything.
  LineElement any_view(const Geometry& g, const Pose& pose, double offset) {
    const Edge x = oracle::state_of(g);
    const LineElement wild = any_element();
    if (one_in(3) || !((pose.R * x.p + pose.t).z() > 1e-3)) return wild;
    LineElement e = observe(x, pose, {}, offset, 0.5, 0.05, 2);
    const bool usable = std::fabs(e.x_px) < 1e9F && std::fabs(e.y_px) < 1e9F && std::isfinite(e.c);
    if (!usable) return wild;
    e.sigma_n_px = wild.sigma_n_px;
    e.sigma_theta = wild.sigma_theta;
    return e;
  }
  AppearanceState any_appearance() {
    for (;;) {
      AppearanceState a;
      a.mean = any_look();
      const MatrixXd P = any_covariance(7);
      Symmetric<float, 7> S;
      for (std::size_t i = 0; i < 7; ++i)
        for (std::size_t j = i; j < 7; ++j)
          S.v[packed_index(7, i, j)] = a.covariance[packed_index(7, i, j)] =
              static_cast<float>(P(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
      if (is_positive_definite(S)) return a;
    }
  }
  Appearance any_look() {
    Appearance a;
    a.phase = static_cast<float>(uniform(-3.14, 3.14));
    for (auto* side : {&a.left, &a.right})
      for (float& c : *side) c = static_cast<float>(uniform(0, 1));
    return a;
  }
};

// Symmetric it is by its storage; finite and positive definite in exact arithmetic?
inline bool is_covariance(const Geometry& g) { return smallest_scaled_eigenvalue(covariance_of(g)) > 0; }
inline bool is_covariance(const AppearanceState& a) {
  MatrixXd P(7, 7);
  for (std::size_t i = 0; i < 7; ++i)
    for (std::size_t j = 0; j < 7; ++j)
      P(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          a.covariance[packed_index(7, std::min(i, j), std::max(i, j))];
  return smallest_scaled_eigenvalue(P) > 0;
}
inline bool is_state(const Geometry& g) {
  double n = 0;
  for (const float q : g.quaternion) n += double{q} * q;
  bool finite = std::fabs(n - 1) < 1e-5;
  for (const float p : g.position) finite = finite && std::isfinite(p);
  return finite && is_covariance(g);
}
inline bool is_state(const AppearanceState& a) {
  bool finite = std::fabs(a.mean.phase) < 3.1416F;
  for (const auto* side : {&a.mean.left, &a.mean.right})
    for (const float c : *side) finite = finite && std::isfinite(c);
  return finite && is_covariance(a);
}

}  // namespace accrete::oracle
