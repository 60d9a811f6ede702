// The process and the measurement of an edge, written once for all peers, as a user of a general filter would.
#pragma once

#include <Eigen/Dense>

#include "cli/bench/pool.h"

namespace accrete::bench {

// The rotation of the state is an error about `R`, which is turned with the cameras and holds the estimate's rotation:
// R_true = R Exp(0, b, a) Exp(roll, 0, 0).
template <class T>
struct EdgeModel {
  using Vector3 = Eigen::Matrix<T, 3, 1>;
  using Matrix3 = Eigen::Matrix<T, 3, 3>;

  Matrix3 R;
  Matrix3 step_R;  // of the motion since the frame before
  Vector3 step_t;
  T focal, baseline;
  const LineElement* seen[2];

  void set_step(const Transform<Map, Map>& step) {
    const Mat3 m = to_matrix(step.rotation);
    for (int i = 0; i < 3; ++i) {
      step_t[i] = static_cast<T>(step.translation[static_cast<std::size_t>(i)]);
      for (int j = 0; j < 3; ++j) step_R(i, j) = static_cast<T>(m[static_cast<std::size_t>(3 * i + j)]);
    }
  }

  template <class State>
  void process(const State& x, State& out) const {
    out = x;
    out.template head<3>() = step_R * x.template head<3>() + step_t;
  }

  // The appearance observes itself.
  template <class State, class Measurement>
  void measure(const State& x, Measurement& z) const {
    measure_pose(x, z);
    z.template tail<7>() = x.template tail<7>();
  }

  // Minus the residuals of both images, whose measured values are zero.
  template <class State, class Measurement>
  void measure_pose(const State& x, Measurement& z) const {
    const T b = x[4], a = x[5], angle2 = a * a + b * b, angle = std::sqrt(angle2);
    const T k = angle2 > T(1e-12) ? std::sin(angle) / angle : T(1);
    const Vector3 t = R * Vector3(std::cos(angle), k * a, -k * b);
    for (int e = 0; e < 2; ++e) {
      const LineElement& o = *seen[e];
      const T qx = x[0] - T(e) * baseline, qy = x[1], over = T(1) / x[2];
      const T u = qx * over, v = qy * over;
      T dx = t[0] - u * t[2], dy = t[1] - v * t[2];
      const T norm = T(1) / std::sqrt(dx * dx + dy * dy);
      dx *= norm;
      dy *= norm;
      z[2 * e] = dy * (T(o.x_px) - focal * u) - dx * (T(o.y_px) - focal * v);
      z[2 * e + 1] = dy * T(o.c) - dx * T(o.s);
    }
  }

  // The estimate's rotation error becomes part of R.
  template <class State>
  void absorb(State& x) {
    const T b = x[4], a = x[5], angle = std::sqrt(a * a + b * b);
    if (angle > T(1e-9)) R = R * Eigen::AngleAxis<T>(angle, Vector3(0, b, a) / angle);
    R = R * Eigen::AngleAxis<T>(x[3], Vector3::UnitX());
    x.template segment<3>(3).setZero();
  }
};

template <class T, class State, class Covariance>
void born(const cli::BenchPool& pool, std::size_t i, EdgeModel<T>& model, State& x, Covariance& P) {
  const Geometry g = load(pool.geometry[i / kBlockLanes], i % kBlockLanes);
  const AppearanceState a = load(pool.appearance[i / kBlockLanes], i % kBlockLanes);
  model.R = Eigen::Quaternion<T>(T(g.quaternion[3]), T(g.quaternion[0]), T(g.quaternion[1]), T(g.quaternion[2]))
                .normalized()
                .toRotationMatrix();
  model.focal = T(pool.optics.focal_px);
  model.baseline = T(pool.optics.baseline_m);
  x.setZero();
  P.setZero();
  for (int k = 0; k < 3; ++k) x[k] = T(g.position[static_cast<std::size_t>(k)]);
  x[6] = T(a.mean.phase);
  for (int k = 0; k < 3; ++k) {
    x[7 + k] = T(a.mean.left[static_cast<std::size_t>(k)]);
    x[10 + k] = T(a.mean.right[static_cast<std::size_t>(k)]);
  }
  for (std::size_t r = 0; r < 7; ++r)
    for (std::size_t c = r; c < 7; ++c) {
      const auto row = static_cast<Eigen::Index>(r), column = static_cast<Eigen::Index>(c);
      if (c < 6) P(row, column) = P(column, row) = T(g.covariance[packed_index(6, r, c)]);
      P(6 + row, 6 + column) = P(6 + column, 6 + row) = T(a.covariance[packed_index(7, r, c)]);
    }
  // Their position is that of the map, and so are its errors; ours are in the own frame.
  const Eigen::Matrix<T, 3, 3> own = P.template topLeftCorner<3, 3>();
  P.template topLeftCorner<3, 3>() = model.R * own * model.R.transpose();
}

// What is observed, and the variances of process and observation; the same for all primitives of a pool.
template <class Measurement>
void observed(const Appearance& look, Measurement& z) {
  using T = typename Measurement::Scalar;
  z.template head<4>().setZero();
  z[4] = T(look.phase);
  for (int k = 0; k < 3; ++k) {
    z[5 + k] = T(look.left[static_cast<std::size_t>(k)]);
    z[8 + k] = T(look.right[static_cast<std::size_t>(k)]);
  }
}
template <class State, class Measurement>
void variances(const cli::BenchPool& pool, State& process, Measurement& noise) {
  using T = typename State::Scalar;
  process.setZero();
  process[6] = T(pool.q_phase[0]);
  process.template tail<6>().setConstant(T(pool.q_colour[0]));
  const LineElement& e = pool.frames[0].left[0];
  const T n = T(e.sigma_n_px), theta = T(e.sigma_theta), phase = T(pool.sigma_phase[0]), c = T(pool.sigma_colour[0]);
  noise.template head<4>() << n * n, theta * theta, n * n, theta * theta;
  noise[4] = phase * phase;
  noise.template tail<6>().setConstant(c * c);
}

inline constexpr double kPeerGate =
    31.26;  // 11 degrees of freedom, 99.9 %; the peers compute it and update all the same

}  // namespace accrete::bench
