// OpenCV's unscented filter (contrib, module tracking): a state cannot be reset in it, so the rotation stays an error
// about the rotation at birth.
#include <opencv2/tracking/kalman_filters.hpp>

#include "peers/edge_model.h"
#include "peers/peer.h"

namespace accrete::bench {
namespace {

using State = Eigen::Matrix<double, 13, 1>;
using Measurement = Eigen::Matrix<double, 11, 1>;

class Model final : public cv::detail::tracking::UkfSystemModel {
 public:
  EdgeModel<double> edge;

  void stateConversionFunction(const cv::Mat& x, const cv::Mat&, const cv::Mat& noise, cv::Mat& out) override {
    const State in = column<const State>(x);
    State moved;
    edge.process(in, moved);
    column<State>(out) = moved + column<const State>(noise);
  }
  void measurementFunction(const cv::Mat& x, const cv::Mat& noise, cv::Mat& z) override {
    const State in = column<const State>(x);
    Measurement out;
    edge.measure(in, out);
    column<Measurement>(z) = out + column<const Measurement>(noise);
  }

 private:
  // What comes in are columns of row-major matrices.
  template <class Vector>
  static Eigen::Map<Vector, 0, Eigen::InnerStride<>> column(const cv::Mat& m) {
    return Eigen::Map<Vector, 0, Eigen::InnerStride<>>(const_cast<double*>(m.ptr<double>()),
                                                       Eigen::InnerStride<>(static_cast<Eigen::Index>(m.step1())));
  }
};

class OpenCv final : public Peer {
 public:
  explicit OpenCv(const cli::BenchPool& pool) : pool_(pool), edges_(pool.size) { restore(); }
  [[nodiscard]] const char* name() const override { return "OpenCV contrib, double"; }

  void restore() override {
    State process;
    Measurement noise;
    variances(pool_, process, noise);
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      edges_[i].model = cv::makePtr<Model>();
      cv::detail::tracking::UnscentedKalmanFilterParams params(13, 11, 0, 0, 0, edges_[i].model);
      State x;
      Eigen::Matrix<double, 13, 13> P;
      born(pool_, i, edges_[i].model->edge, x, P);
      Eigen::Map<State>(params.stateInit.ptr<double>()) = x;
      Eigen::Map<Eigen::Matrix<double, 13, 13>>(params.errorCovInit.ptr<double>()) = P;
      for (int k = 0; k < 13; ++k) params.processNoiseCov.at<double>(k, k) = process[k];
      for (int k = 0; k < 11; ++k) params.measurementNoiseCov.at<double>(k, k) = noise[k];
      params.alpha = 1;
      params.k = 0;
      params.beta = 2;
      edges_[i].filter = cv::detail::tracking::createUnscentedKalmanFilter(params);
    }
  }
  void frame(std::size_t number) override {
    const cli::BenchPool::Frame& f = pool_.frames[number % cli::BenchPool::kFrames];
    Measurement z;
    const cv::Mat seen(11, 1, CV_64F, z.data());
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      EdgeModel<double>& model = edges_[i].model->edge;
      model.set_step(f.step);
      model.seen[0] = &f.left[i];
      model.seen[1] = &f.right[i];
      edges_[i].filter->predict();
      model.R = model.step_R * model.R;
      observed(f.looks[i], z);
      edges_[i].filter->correct(seen);  // without a gate: it does not tell its innovation covariance
    }
  }
  [[nodiscard]] PeerEstimate estimate(std::size_t i) const override {
    const cv::Mat state = edges_[i].filter->getState();
    State x = Eigen::Map<const State>(state.ptr<double>());
    EdgeModel<double> model = edges_[i].model->edge;
    model.absorb(x);
    PeerEstimate e{};
    for (int k = 0; k < 3; ++k) {
      e.position[k] = x[k];
      e.tangent[k] = model.R(k, 0);
    }
    return e;
  }
  [[nodiscard]] std::size_t bytes() const override { return sizeof(Edge); }

 private:
  struct Edge {
    cv::Ptr<Model> model;
    cv::Ptr<cv::detail::tracking::UnscentedKalmanFilter> filter;
  };
  const cli::BenchPool& pool_;
  std::vector<Edge> edges_;
};

}  // namespace

std::unique_ptr<Peer> opencv(const cli::BenchPool& pool) {
  cv::setNumThreads(1);
  return std::make_unique<OpenCv>(pool);
}

}  // namespace accrete::bench
