#include "peers/dynamic_ukf.h"
#include "peers/edge_model.h"
#include "peers/fixed_ukf.h"
#include "peers/peer.h"

namespace accrete::bench {
namespace {

template <class Model, class State>
PeerEstimate estimate_of(const Model& model, const State& x) {
  PeerEstimate e{};
  for (int k = 0; k < 3; ++k) {
    e.position[k] = static_cast<double>(x[k]);
    e.tangent[k] = static_cast<double>(model.R(k, 0));
  }
  return e;
}

template <class T>
class FixedEigen final : public Peer {
 public:
  explicit FixedEigen(const cli::BenchPool& pool) : pool_(pool), edges_(pool.size) {
    variances(pool, process_, noise_);
    restore();
  }
  [[nodiscard]] const char* name() const override {
    return sizeof(T) == 8 ? "Eigen, fixed size 13, double" : "Eigen, fixed size 13, float";
  }
  void restore() override {
    for (std::size_t i = 0; i < edges_.size(); ++i)
      born(pool_, i, edges_[i].model, edges_[i].filter.x, edges_[i].filter.P);
  }
  void frame(std::size_t number) override {
    const cli::BenchPool::Frame& f = pool_.frames[number % cli::BenchPool::kFrames];
    EdgeModel<T> shared;
    shared.set_step(f.step);
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      EdgeModel<T>& model = edges_[i].model;
      Filter& filter = edges_[i].filter;
      model.step_R = shared.step_R;
      model.step_t = shared.step_t;
      model.seen[0] = &f.left[i];
      model.seen[1] = &f.right[i];
      filter.predict([&](const auto& x, auto& out) { model.process(x, out); }, process_);
      model.R = model.step_R * model.R;
      Measurement z;
      observed(f.looks[i], z);
      far_ += filter.update([&](const auto& x, auto& out) { model.measure(x, out); }, z, noise_) > T(kPeerGate);
      model.absorb(filter.x);
    }
  }
  [[nodiscard]] PeerEstimate estimate(std::size_t i) const override {
    return estimate_of(edges_[i].model, edges_[i].filter.x);
  }
  [[nodiscard]] std::size_t bytes() const override { return sizeof(Edge); }

 private:
  using Filter = FixedUkf<T, 13, 11>;
  using Measurement = typename Filter::Measurement;
  struct Edge {
    EdgeModel<T> model;
    Filter filter;
  };
  const cli::BenchPool& pool_;
  std::vector<Edge> edges_;
  typename Filter::State process_;
  Measurement noise_;
  long far_ = 0;
};

class BlockEigen final : public Peer {
 public:
  explicit BlockEigen(const cli::BenchPool& pool) : pool_(pool), edges_(pool.size) {
    Vector13 process;
    Vector11 noise;
    variances(pool, process, noise);
    noise4_ = noise.head<4>();
    noise7_ = noise.tail<7>();
    process7_ = process.tail<7>();
    restore();
  }
  [[nodiscard]] const char* name() const override { return "Eigen, fixed size 6 + Kalman 7, double"; }
  void restore() override {
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      Vector13 x;
      Eigen::Matrix<double, 13, 13> P;
      born(pool_, i, edges_[i].model, x, P);
      edges_[i].pose.x = x.head<6>();
      edges_[i].pose.P = P.topLeftCorner<6, 6>();
      edges_[i].a = x.tail<7>();
      edges_[i].A = P.bottomRightCorner<7, 7>();
    }
  }
  void frame(std::size_t number) override {
    const cli::BenchPool::Frame& f = pool_.frames[number % cli::BenchPool::kFrames];
    EdgeModel<double> shared;
    shared.set_step(f.step);
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      Edge& e = edges_[i];
      e.model.step_R = shared.step_R;
      e.model.step_t = shared.step_t;
      e.model.seen[0] = &f.left[i];
      e.model.seen[1] = &f.right[i];
      e.pose.predict([&](const auto& x, auto& out) { e.model.process(x, out); }, Pose::State::Zero());
      e.model.R = e.model.step_R * e.model.R;
      Vector11 z;
      observed(f.looks[i], z);
      double d2 = e.pose.update([&](const auto& x, auto& out) { e.model.measure_pose(x, out); }, z.head<4>(), noise4_);
      e.model.absorb(e.pose.x);
      e.A.diagonal() += process7_;
      Matrix7 S = e.A;
      S.diagonal() += noise7_;
      const Eigen::LLT<Matrix7> llt(S);
      const Matrix7 Kt = llt.solve(e.A);
      const Vector7 innovation = z.tail<7>() - e.a;
      e.a.noalias() += Kt.transpose() * innovation;
      const Matrix7 before = e.A;
      e.A.noalias() -= Kt.transpose() * before;
      d2 += innovation.dot(llt.solve(innovation));
      far_ += d2 > kPeerGate;
    }
  }
  [[nodiscard]] PeerEstimate estimate(std::size_t i) const override {
    return estimate_of(edges_[i].model, edges_[i].pose.x);
  }
  [[nodiscard]] std::size_t bytes() const override { return sizeof(Edge); }

 private:
  using Pose = FixedUkf<double, 6, 4>;
  using Vector13 = Eigen::Matrix<double, 13, 1>;
  using Vector11 = Eigen::Matrix<double, 11, 1>;
  using Vector7 = Eigen::Matrix<double, 7, 1>;
  using Matrix7 = Eigen::Matrix<double, 7, 7>;
  struct Edge {
    EdgeModel<double> model;
    Pose pose;
    Vector7 a;
    Matrix7 A;
  };
  const cli::BenchPool& pool_;
  std::vector<Edge> edges_;
  Eigen::Vector4d noise4_;
  Vector7 noise7_, process7_;
  long far_ = 0;
};

class DynamicEigen final : public Peer {
 public:
  explicit DynamicEigen(const cli::BenchPool& pool) : pool_(pool), edges_(pool.size) {
    Eigen::VectorXd process(13), noise(11);
    variances(pool, process, noise);
    Q_ = process.asDiagonal();
    R_ = noise.asDiagonal();
    restore();
  }
  [[nodiscard]] const char* name() const override { return "Eigen, size at run time, double"; }
  void restore() override {
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      edges_[i].filter.x.resize(13);
      edges_[i].filter.P.resize(13, 13);
      born(pool_, i, edges_[i].model, edges_[i].filter.x, edges_[i].filter.P);
    }
  }
  void frame(std::size_t number) override {
    const cli::BenchPool::Frame& f = pool_.frames[number % cli::BenchPool::kFrames];
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      EdgeModel<double>& model = edges_[i].model;
      DynamicUkf& filter = edges_[i].filter;
      model.set_step(f.step);
      model.seen[0] = &f.left[i];
      model.seen[1] = &f.right[i];
      filter.predict(
          [&](const Eigen::VectorXd& x) {
            Eigen::VectorXd out;
            model.process(x, out);
            return out;
          },
          Q_);
      model.R = model.step_R * model.R;
      Eigen::VectorXd z(11);
      observed(f.looks[i], z);
      far_ += filter.update(
                  [&](const Eigen::VectorXd& x) {
                    Eigen::VectorXd out(11);
                    model.measure(x, out);
                    return out;
                  },
                  z, R_) > kPeerGate;
      model.absorb(filter.x);
    }
  }
  [[nodiscard]] PeerEstimate estimate(std::size_t i) const override {
    return estimate_of(edges_[i].model, edges_[i].filter.x);
  }
  [[nodiscard]] std::size_t bytes() const override { return sizeof(Edge); }

 private:
  struct Edge {
    EdgeModel<double> model;
    DynamicUkf filter;
  };
  const cli::BenchPool& pool_;
  std::vector<Edge> edges_;
  Eigen::MatrixXd Q_, R_;
  long far_ = 0;
};

}  // namespace

std::unique_ptr<Peer> fixed_eigen_double(const cli::BenchPool& pool) {
  return std::make_unique<FixedEigen<double>>(pool);
}
std::unique_ptr<Peer> fixed_eigen_float(const cli::BenchPool& pool) {
  return std::make_unique<FixedEigen<float>>(pool);
}
std::unique_ptr<Peer> block_eigen(const cli::BenchPool& pool) { return std::make_unique<BlockEigen>(pool); }
std::unique_ptr<Peer> dynamic_eigen(const cli::BenchPool& pool) { return std::make_unique<DynamicEigen>(pool); }

}  // namespace accrete::bench
