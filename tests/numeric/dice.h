// Random edges, poses and observations of them.
#pragma once

#include <random>

#include "numeric/oracle.h"

namespace accrete::oracle {

class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  double normal() { return normal_(engine_); }
  Vector3d normal3() { return {normal(), normal(), normal()}; }
  VectorXd normals(Eigen::Index n);
  Matrix3d rotation();
  // Positive definite with the given standard deviations and random correlations.
  MatrixXd covariance(const VectorXd& sigma);
  // An edge in front of the cameras, seen at more than `psi` from the epipolar line.
  Edge edge(double sigma_m = 2e-3, double sigma_tilt = 0.1, double sigma_roll = 0.8);
  // Turns and shifts the map; the edge stays where the cameras see it.
  Pose pose(Edge& x);
  // What a camera sees of `truth`: noise across the edge and in angle, a slide along it.
  LineElement observe(const Edge& truth, const Pose& pose, const Optics& optics, double offset, double sigma_n,
                      double sigma_theta, double slide);
  unsigned index(unsigned n) { return std::uniform_int_distribution<unsigned>(0, n - 1)(engine_); }
  std::mt19937& engine() { return engine_; }

 private:
  std::mt19937 engine_;
  std::normal_distribution<double> normal_;
};

}  // namespace accrete::oracle
