// An unscented Kalman filter with sizes known to the compiler: alpha = 1, kappa = 0, beta = 2, sigma points drawn anew
// after the prediction.
#pragma once

#include <Eigen/Dense>

namespace accrete::bench {

template <class T, int N, int M>
class FixedUkf {
 public:
  using State = Eigen::Matrix<T, N, 1>;
  using Covariance = Eigen::Matrix<T, N, N>;
  using Measurement = Eigen::Matrix<T, M, 1>;

  State x;
  Covariance P;

  template <class Process>
  void predict(const Process& process, const State& variance) {
    draw();
    State column, moved;
    for (int i = 0; i <= 2 * N; ++i) {
      column = points_.col(i);
      process(column, moved);
      points_.col(i) = moved;
    }
    x.noalias() = kWeight * points_.template rightCols<2 * N>().rowwise().sum();
    points_.colwise() -= x;
    P.noalias() = kWeight * points_.template rightCols<2 * N>() * points_.template rightCols<2 * N>().transpose();
    P.noalias() += T(2) * points_.col(0) * points_.col(0).transpose();
    P.diagonal() += variance;
  }

  // The squared distance of the innovation.
  template <class Measure>
  T update(const Measure& measure, const Measurement& seen, const Measurement& variance) {
    draw();
    Eigen::Matrix<T, M, 2 * N + 1> images;
    State column;
    Measurement z;
    for (int i = 0; i <= 2 * N; ++i) {
      column = points_.col(i);
      measure(column, z);
      images.col(i) = z;
    }
    const Measurement mean = kWeight * images.template rightCols<2 * N>().rowwise().sum();
    images.colwise() -= mean;
    points_.colwise() -= x;
    Eigen::Matrix<T, M, M> S;
    S.noalias() = kWeight * images.template rightCols<2 * N>() * images.template rightCols<2 * N>().transpose();
    S.noalias() += T(2) * images.col(0) * images.col(0).transpose();
    S.diagonal() += variance;
    Eigen::Matrix<T, M, N> Ct;
    Ct.noalias() = kWeight * images.template rightCols<2 * N>() * points_.template rightCols<2 * N>().transpose();
    const Eigen::LLT<Eigen::Matrix<T, M, M>> llt(S);
    const Eigen::Matrix<T, M, N> Kt = llt.solve(Ct);
    const Measurement innovation = seen - mean;
    x.noalias() += Kt.transpose() * innovation;
    P.noalias() -= Kt.transpose() * Ct;
    return innovation.dot(llt.solve(innovation));
  }

 private:
  static constexpr T kWeight = T(0.5) / T(N);
  Eigen::Matrix<T, N, 2 * N + 1> points_;

  void draw() {
    const Covariance L = P.llt().matrixL();
    points_.colwise() = x;
    points_.template middleCols<N>(1) += std::sqrt(T(N)) * L;
    points_.template rightCols<N>() -= std::sqrt(T(N)) * L;
  }
};

}  // namespace accrete::bench
