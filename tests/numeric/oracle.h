// The filter again, written from METHOD in double with plain Eigen: slow, obvious, and sharing nothing with the kernels
// but the formulas. Compiled once, in oracle.cpp: what Eigen makes of it would take half a minute in every test.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <functional>
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
  Matrix6d P;  // of errors in the own frame: position, roll, tilts about y and z
};

Matrix3d exp_so3(const Vector3d& w);

// p [+] d = p + R dp, R [+] d = R Exp(0, b, a) Exp(roll, 0, 0).
Edge moved(const Edge& x, const Vector6d& d);

struct Pose {
  Matrix3d R = Matrix3d::Identity();
  Vector3d t = Vector3d::Zero();

  [[nodiscard]] AlignedPose aligned() const;
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
Image project(const Edge& s, const Pose& pose, const Optics& optics, double offset);

// e_n and sin e_theta of METHOD 5.2 (A): the observed element against the line of `s`, with its own normal.
Vector2d residual(const Edge& s, const Pose& pose, const Optics& optics, double offset, const LineElement& z);

struct Observation {
  double offset;
  LineElement z;
};

VectorXd residuals(const Edge& s, const Pose& pose, const Optics& optics, const std::vector<Observation>& o);

// Sigma points with alpha = 1, kappa = 0, beta = 2 for any function of an error of n dimensions, by the root in the
// order of the components.
struct Moments {
  VectorXd mean;
  MatrixXd covariance;  // of the values
  MatrixXd cross;       // cov(error, value)
};
Moments unscented(const MatrixXd& P, const std::function<VectorXd(const VectorXd&)>& value);

// The same for the six errors of an edge, by the root in the order of the filter (docs/math/prediction.md), and with
// all 13 points.
Moments unscented_of_edge(const Matrix6d& P, const std::function<VectorXd(const VectorXd&)>& value);

// METHOD 5.3, in its plainest form.
Edge updated(const Edge& x, const Pose& pose, const Optics& optics, const std::vector<Observation>& o);

// Records.
Matrix6d covariance_of(const Geometry& g);
Edge state_of(const Geometry& g);
Geometry record_of(const Edge& x);

// The smallest eigenvalue of the covariance scaled to a unit diagonal; not finite or not positive: not a covariance.
double smallest_scaled_eigenvalue(const MatrixXd& P);

// The truth minus the estimate in the four observable degrees of freedom: offset of the line where it crosses the plane
// normal to the estimated tangent at the estimated point, and tilt.
Eigen::Vector4d line_error(const Edge& truth, const Edge& estimate);
Matrix4d line_covariance(const Edge& x);

}  // namespace accrete::oracle
