// The filter of a textbook: sizes at run time, models as std::function, a matrix for every term of the formulas.
#pragma once

#include <Eigen/Dense>
#include <functional>
#include <vector>

namespace accrete::bench {

class DynamicUkf {
 public:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;
  using Function = std::function<Vector(const Vector&)>;

  Vector x;
  Matrix P;

  void predict(const Function& process, const Matrix& Q) {
    std::vector<Vector> points = draw();
    for (Vector& p : points) p = process(p);
    x = mean(points);
    P = covariance(points, x, points, x) + Q;
  }

  double update(const Function& measure, const Vector& seen, const Matrix& R) {
    const std::vector<Vector> points = draw();
    std::vector<Vector> images;
    for (const Vector& p : points) images.push_back(measure(p));
    const Vector z = mean(images);
    const Matrix S = covariance(images, z, images, z) + R;
    const Matrix C = covariance(points, x, images, z);
    const Matrix inverse = S.inverse();
    const Matrix K = C * inverse;
    const Vector innovation = seen - z;
    x = x + K * innovation;
    P = P - K * S * K.transpose();
    return innovation.dot(inverse * innovation);
  }

 private:
  [[nodiscard]] std::vector<Vector> draw() const {
    const Matrix L = P.llt().matrixL();
    const double spread = std::sqrt(static_cast<double>(x.size()));
    std::vector<Vector> points{x};
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      points.push_back(x + spread * L.col(i));
      points.push_back(x - spread * L.col(i));
    }
    return points;
  }
  // alpha = 1, kappa = 0, beta = 2: the first point counts 0 in the mean and 2 in the covariance.
  [[nodiscard]] Vector mean(const std::vector<Vector>& points) const {
    Vector sum = Vector::Zero(points[0].size());
    for (std::size_t i = 1; i < points.size(); ++i) sum += weight() * points[i];
    return sum;
  }
  [[nodiscard]] Matrix covariance(const std::vector<Vector>& a, const Vector& mean_a, const std::vector<Vector>& b,
                                  const Vector& mean_b) const {
    Matrix sum = Matrix::Zero(mean_a.size(), mean_b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
      sum += (i == 0 ? 2 : weight()) * (a[i] - mean_a) * (b[i] - mean_b).transpose();
    return sum;
  }
  [[nodiscard]] double weight() const { return 0.5 / static_cast<double>(x.size()); }
};

}  // namespace accrete::bench
