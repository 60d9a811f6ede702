#include "numeric/oracle.h"

namespace accrete::oracle {

Matrix3d exp_so3(const Vector3d& w) {
  const double angle = w.norm();
  return angle < 1e-300 ? Matrix3d(Matrix3d::Identity()) : AngleAxisd(angle, w / angle).toRotationMatrix();
}

Edge moved(const Edge& x, const Vector6d& d) {
  Edge y = x;
  y.p += x.R * d.head<3>();
  y.R = x.R * exp_so3({0, d[4], d[5]}) * exp_so3({d[3], 0, 0});
  return y;
}

AlignedPose Pose::aligned() const {
  AlignedPose pose;
  for (int i = 0; i < 3; ++i) {
    pose.t[i] = static_cast<float>(t[i]);
    for (int j = 0; j < 3; ++j) pose.R[3 * i + j] = static_cast<float>(R(i, j));
  }
  return pose;
}

Image project(const Edge& s, const Pose& pose, const Optics& optics, double offset) {
  const Vector3d q = pose.R * s.p + pose.t - Vector3d(offset, 0, 0), t = pose.R * s.R.col(0);
  const double f = optics.focal;
  const Vector2d u(f / q.z() * (t.x() - q.x() / q.z() * t.z()), f / q.z() * (t.y() - q.y() / q.z() * t.z()));
  return {{f * q.x() / q.z(), f * q.y() / q.z()}, std::atan2(u.y(), u.x())};
}

Vector2d residual(const Edge& s, const Pose& pose, const Optics& optics, double offset, const LineElement& z) {
  const Image image = project(s, pose, optics, offset);
  const Vector2d normal(-std::sin(image.theta), std::cos(image.theta));
  return {normal.dot(Vector2d(z.x_px, z.y_px) - image.x), std::sin(std::atan2(double{z.s}, double{z.c}) - image.theta)};
}

VectorXd residuals(const Edge& s, const Pose& pose, const Optics& optics, const std::vector<Observation>& o) {
  VectorXd r(2 * static_cast<Eigen::Index>(o.size()));
  for (std::size_t i = 0; i < o.size(); ++i)
    r.segment<2>(2 * static_cast<Eigen::Index>(i)) = residual(s, pose, optics, o[i].offset, o[i].z);
  return r;
}

Moments unscented(const MatrixXd& P, const std::function<VectorXd(const VectorXd&)>& value) {
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

Moments unscented_of_edge(const Matrix6d& P, const std::function<VectorXd(const VectorXd&)>& value) {
  // Across, tilts, along, roll.
  const Eigen::PermutationMatrix<6> order(Eigen::Matrix<int, 6, 1>(1, 2, 4, 5, 0, 3));  // column k: component order[k]
  Moments m = unscented(order.transpose() * P * order, [&](const VectorXd& d) { return value(order * d); });
  m.cross = order * m.cross;
  return m;
}

Edge updated(const Edge& x, const Pose& pose, const Optics& optics, const std::vector<Observation>& o) {
  const Moments m = unscented_of_edge(x.P, [&](const VectorXd& d) { return residuals(moved(x, d), pose, optics, o); });
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
  // The frame has turned, and with it the axes of the position; about its tangent by the roll, and with it those of the
  // tilts.
  Matrix6d J = Matrix6d::Identity();
  J.topLeftCorner<3, 3>() = y.R.transpose() * x.R;
  J.bottomRightCorner<3, 3>() = exp_so3({-d[3], 0, 0});
  y.P = J * y.P * J.transpose();
  return y;
}

Matrix6d covariance_of(const Geometry& g) {
  Matrix6d P;
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = i; j < 6; ++j)
      P(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          P(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(i)) = g.covariance[packed_index(6, i, j)];
  return P;
}

Edge state_of(const Geometry& g) {
  Edge x;
  x.p = {g.position[0], g.position[1], g.position[2]};
  x.R = Eigen::Quaterniond(g.quaternion[3], g.quaternion[0], g.quaternion[1], g.quaternion[2])
            .normalized()
            .toRotationMatrix();
  x.P = covariance_of(g);
  return x;
}

Geometry record_of(const Edge& x) {
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

double smallest_scaled_eigenvalue(const MatrixXd& P) {
  if (!P.allFinite() || !(P.diagonal().minCoeff() > 0)) return -1;
  const VectorXd s = P.diagonal().cwiseSqrt().cwiseInverse();
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(s.asDiagonal() * P * s.asDiagonal()).eigenvalues()[0];
}

Eigen::Vector4d line_error(const Edge& truth, const Edge& estimate) {
  const Vector3d t = estimate.R.col(0), truth_t = truth.R.col(0);
  const Vector3d d = truth.p - estimate.p;
  const Vector3d offset = d - d.dot(t) / truth_t.dot(t) * truth_t;
  const Vector3d local = estimate.R.transpose() * truth_t;
  const double sine = std::hypot(local.y(), local.z());
  const double k = sine < 1e-12 ? 1 : std::atan2(sine, local.x()) / sine;
  return {offset.dot(estimate.R.col(1)), offset.dot(estimate.R.col(2)), -local.z() * k, local.y() * k};
}

Matrix4d line_covariance(const Edge& x) {
  Eigen::Matrix<double, 4, 6> J = Eigen::Matrix<double, 4, 6>::Zero();
  J(0, 1) = J(1, 2) = J(2, 4) = J(3, 5) = 1;
  return J * x.P * J.transpose();
}

}  // namespace accrete::oracle
