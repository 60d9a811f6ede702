// The filter again, written from METHOD in double with plain Eigen: slow, obvious, and sharing nothing with the kernels
// but the formulas.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <random>
#include <vector>

#include "accrete/primitive.h"
#include "math/aligned.h"

namespace accrete::oracle {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

inline constexpr double kDegree = 0.017453292519943295;

struct Edge {
  Vector3d p;
  Matrix3d R;
  Matrix6d P;
};

inline Matrix3d exp_so3(const Vector3d& w) {
  const double angle = w.norm();
  return angle < 1e-300 ? Matrix3d(Matrix3d::Identity()) : AngleAxisd(angle, w / angle).toRotationMatrix();
}

// R [+] d = R Exp(0, b, a) Exp(roll, 0, 0); position added.
inline Edge moved(const Edge& x, const Vector6d& d) {
  Edge y = x;
  y.p += d.head<3>();
  y.R = x.R * exp_so3({0, d[4], d[5]}) * exp_so3({d[3], 0, 0});
  return y;
}

struct Pose {
  Matrix3d R = Matrix3d::Identity();
  Vector3d t = Vector3d::Zero();

  [[nodiscard]] AlignedPose aligned() const {
    AlignedPose pose;
    for (int i = 0; i < 3; ++i) {
      pose.t[i] = static_cast<float>(t[i]);
      for (int j = 0; j < 3; ++j) pose.R[3 * i + j] = static_cast<float>(R(i, j));
    }
    return pose;
  }
};

struct Optics {
  double focal = 800, baseline = 0.12;

  [[nodiscard]] AlignedOptics aligned() const { return {static_cast<float>(focal), static_cast<float>(baseline)}; }
};

// Image of the primitive in the camera at (offset, 0, 0): point and angle.
struct Image {
  Vector2d x;
  double theta;
};
inline Image project(const Edge& s, const Pose& pose, const Optics& optics, double offset) {
  const Vector3d q = pose.R * s.p + pose.t - Vector3d(offset, 0, 0), t = pose.R * s.R.col(0);
  const double f = optics.focal;
  const Vector2d u(f / q.z() * (t.x() - q.x() / q.z() * t.z()), f / q.z() * (t.y() - q.y() / q.z() * t.z()));
  return {{f * q.x() / q.z(), f * q.y() / q.z()}, std::atan2(u.y(), u.x())};
}

// e_n and sin e_theta of METHOD 5.2 (A): the observed element against the line of `s`, with its own normal.
inline Vector2d residual(const Edge& s, const Pose& pose, const Optics& optics, double offset, const LineElement& z) {
  const Image image = project(s, pose, optics, offset);
  const Vector2d normal(-std::sin(image.theta), std::cos(image.theta));
  return {normal.dot(Vector2d(z.x_px, z.y_px) - image.x), std::sin(std::atan2(double{z.s}, double{z.c}) - image.theta)};
}

struct Observation {
  double offset;
  LineElement z;
};

inline VectorXd residuals(const Edge& s, const Pose& pose, const Optics& optics, const std::vector<Observation>& o) {
  VectorXd r(2 * static_cast<Eigen::Index>(o.size()));
  for (std::size_t i = 0; i < o.size(); ++i)
    r.segment<2>(2 * static_cast<Eigen::Index>(i)) = residual(s, pose, optics, o[i].offset, o[i].z);
  return r;
}

// Sigma points with alpha = 1, kappa = 0, beta = 2 for any function of an error of n dimensions.
struct Moments {
  VectorXd mean;
  MatrixXd covariance;  // of the values
  MatrixXd cross;       // cov(error, value)
};
template <class F>
Moments unscented(const MatrixXd& P, F value) {
  const Eigen::Index n = P.rows();
  const MatrixXd L = P.llt().matrixL();
  const double spread = std::sqrt(static_cast<double>(n)), w = 0.5 / static_cast<double>(n);
  const VectorXd centre = value(VectorXd(VectorXd::Zero(n)));
  std::vector<VectorXd> errors, values;
  Moments out;
  out.mean = VectorXd::Zero(centre.size());
  for (Eigen::Index k = 0; k < n; ++k)
    for (const double sign : {1.0, -1.0}) {
      errors.emplace_back(sign * spread * L.col(k));
      values.emplace_back(value(errors.back()));
      out.mean += w * values.back();
    }
  out.covariance = 2.0 * (centre - out.mean) * (centre - out.mean).transpose();
  out.cross = MatrixXd::Zero(n, centre.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    out.covariance += w * (values[i] - out.mean) * (values[i] - out.mean).transpose();
    out.cross += w * errors[i] * (values[i] - out.mean).transpose();
  }
  return out;
}

// METHOD 5.3, in its plainest form.
inline Edge updated(const Edge& x, const Pose& pose, const Optics& optics, const std::vector<Observation>& o) {
  const Moments m = unscented(x.P, [&](const VectorXd& d) { return residuals(moved(x, d), pose, optics, o); });
  MatrixXd S = m.covariance;
  for (std::size_t i = 0; i < o.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(2 * i);
    S(k, k) += std::pow(double{o[i].z.sigma_n_px}, 2);
    S(k + 1, k + 1) += std::pow(double{o[i].z.sigma_theta}, 2);
  }
  const MatrixXd K = -m.cross * S.inverse();
  const Vector6d d = K * m.mean;
  Edge y = moved(x, d);
  y.P = x.P - K * S * K.transpose();
  // Retracted by a roll, the frame has turned about its tangent, and with it the axes of the tilts.
  Matrix6d J = Matrix6d::Identity();
  J.bottomRightCorner<3, 3>() = exp_so3({-d[3], 0, 0});
  y.P = J * y.P * J.transpose();
  return y;
}

// Records.
inline Matrix6d covariance_of(const Geometry& g) {
  Matrix6d P;
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = i; j < 6; ++j)
      P(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          P(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(i)) = g.covariance[packed_index(6, i, j)];
  return P;
}
inline Edge state_of(const Geometry& g) {
  Edge x;
  x.p = {g.position[0], g.position[1], g.position[2]};
  x.R = Eigen::Quaterniond(g.quaternion[3], g.quaternion[0], g.quaternion[1], g.quaternion[2])
            .normalized()
            .toRotationMatrix();
  x.P = covariance_of(g);
  return x;
}
inline Geometry record_of(const Edge& x) {
  Geometry g;
  const Eigen::Quaterniond q(x.R);
  g.quaternion = {static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z()),
                  static_cast<float>(q.w())};
  for (std::size_t i = 0; i < 3; ++i) g.position[i] = static_cast<float>(x.p[static_cast<Eigen::Index>(i)]);
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = i; j < 6; ++j)
      g.covariance[packed_index(6, i, j)] =
          static_cast<float>(x.P(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
  return g;
}

// Random things.
class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  double normal() { return normal_(engine_); }
  Vector3d normal3() { return {normal(), normal(), normal()}; }
  VectorXd normals(Eigen::Index n) {
    VectorXd v(n);
    for (Eigen::Index i = 0; i < n; ++i) v[i] = normal();
    return v;
  }
  Matrix3d rotation() {
    return Eigen::Quaterniond(normal(), normal(), normal(), normal()).normalized().toRotationMatrix();
  }
  // Positive definite with the given standard deviations and random correlations.
  MatrixXd covariance(const VectorXd& sigma) {
    const Eigen::Index n = sigma.size();
    MatrixXd A(n, n + 2);
    for (Eigen::Index i = 0; i < A.size(); ++i) A.data()[i] = normal();
    MatrixXd C = A * A.transpose();
    const VectorXd scale = sigma.cwiseQuotient(C.diagonal().cwiseSqrt());
    return scale.asDiagonal() * C * scale.asDiagonal();
  }
  // An edge in front of the cameras, seen at more than `psi` from the epipolar line.
  Edge edge(double sigma_m = 2e-3, double sigma_tilt = 0.1, double sigma_roll = 0.8) {
    Edge x;
    x.p = {uniform(-0.15, 0.15), uniform(-0.1, 0.1), uniform(0.5, 0.9)};
    const double angle = uniform(0.6, 2.5);
    const Vector3d t = Vector3d(std::cos(angle), std::sin(angle), uniform(-0.5, 0.5)).normalized();
    const Vector3d a = (x.p - x.p.dot(t) * t).normalized();
    x.R << t, a.cross(t), a;
    Vector6d sigma;
    sigma << sigma_m, sigma_m, sigma_m, sigma_roll, sigma_tilt, sigma_tilt;
    x.P = covariance(sigma);
    return x;
  }
  // Turns and shifts the map; the edge stays where the cameras see it.
  Pose pose(Edge& x) {
    Pose pose;
    pose.R = rotation();
    pose.t = 0.3 * normal3();
    const Matrix3d back = pose.R.transpose();
    x.p = back * (x.p - pose.t);
    x.R = back * x.R;
    Matrix6d F = Matrix6d::Identity();
    F.topLeftCorner<3, 3>() = back;
    x.P = F * x.P * F.transpose();
    return pose;
  }
  // What a camera sees of `truth`: noise across the edge and in angle, a slide along it.
  LineElement observe(const Edge& truth, const Pose& pose, const Optics& optics, double offset, double sigma_n,
                      double sigma_theta, double slide) {
    const Image image = project(truth, pose, optics, offset);
    const Vector2d u(std::cos(image.theta), std::sin(image.theta)), n(-u.y(), u.x());
    const Vector2d x = image.x + sigma_n * normal() * n + uniform(-slide, slide) * u;
    const double theta = image.theta + sigma_theta * normal();
    LineElement e;
    e.x_px = static_cast<float>(x.x());
    e.y_px = static_cast<float>(x.y());
    e.c = static_cast<float>(std::cos(theta));
    e.s = static_cast<float>(std::sin(theta));
    e.sigma_n_px = static_cast<float>(sigma_n);
    e.sigma_theta = static_cast<float>(sigma_theta);
    return e;
  }
  unsigned index(unsigned n) { return std::uniform_int_distribution<unsigned>(0, n - 1)(engine_); }
  std::mt19937& engine() { return engine_; }

 private:
  std::mt19937 engine_;
  std::normal_distribution<double> normal_;
};

// The smallest eigenvalue of the covariance scaled to a unit diagonal; not finite or not positive: not a covariance.
inline double smallest_scaled_eigenvalue(const MatrixXd& P) {
  if (!P.allFinite() || !(P.diagonal().minCoeff() > 0)) return -1;
  const VectorXd s = P.diagonal().cwiseSqrt().cwiseInverse();
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(s.asDiagonal() * P * s.asDiagonal()).eigenvalues()[0];
}

// The truth minus the estimate in the four observable degrees of freedom: offset of the line where it crosses the plane
// normal to the estimated tangent at the estimated point, and tilt.
inline Eigen::Vector4d line_error(const Edge& truth, const Edge& estimate) {
  const Vector3d t = estimate.R.col(0), truth_t = truth.R.col(0);
  const Vector3d d = truth.p - estimate.p;
  const Vector3d offset = d - d.dot(t) / truth_t.dot(t) * truth_t;
  const Vector3d local = estimate.R.transpose() * truth_t;
  const double sine = std::hypot(local.y(), local.z());
  const double k = sine < 1e-12 ? 1 : std::atan2(sine, local.x()) / sine;
  return {offset.dot(estimate.R.col(1)), offset.dot(estimate.R.col(2)), -local.z() * k, local.y() * k};
}
inline Matrix4d line_covariance(const Edge& x) {
  Eigen::Matrix<double, 4, 6> J = Eigen::Matrix<double, 4, 6>::Zero();
  J.block<1, 3>(0, 0) = x.R.col(1).transpose();
  J.block<1, 3>(1, 0) = x.R.col(2).transpose();
  J(2, 4) = J(3, 5) = 1;
  return J * x.P * J.transpose();
}

}  // namespace accrete::oracle
