#include "numeric/dice.h"

namespace accrete::oracle {

VectorXd Dice::normals(Eigen::Index n) {
  VectorXd v(n);
  for (Eigen::Index i = 0; i < n; ++i) v[i] = normal();
  return v;
}

Matrix3d Dice::rotation() {
  return Eigen::Quaterniond(normal(), normal(), normal(), normal()).normalized().toRotationMatrix();
}

MatrixXd Dice::covariance(const VectorXd& sigma) {
  const Eigen::Index n = sigma.size();
  MatrixXd A(n, n + 2);
  for (Eigen::Index i = 0; i < A.size(); ++i) A.data()[i] = normal();
  MatrixXd C = A * A.transpose();
  const VectorXd scale = sigma.cwiseQuotient(C.diagonal().cwiseSqrt());
  return scale.asDiagonal() * C * scale.asDiagonal();
}

Edge Dice::edge(double sigma_m, double sigma_tilt, double sigma_roll) {
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

Pose Dice::pose(Edge& x) {
  Pose pose;
  pose.R = rotation();
  pose.t = 0.3 * normal3();
  const Matrix3d back = pose.R.transpose();
  x.p = back * (x.p - pose.t);
  x.R = back * x.R;
  return pose;
}

LineElement Dice::observe(const Edge& truth, const Pose& pose, const Optics& optics, double offset, double sigma_n,
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

}  // namespace accrete::oracle
