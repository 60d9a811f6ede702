#include "predict/motion_noise.h"

#include <gtest/gtest.h>

#include "numeric/dice.h"
#include "predict/predict.h"

namespace accrete {
namespace {

using namespace oracle;

Matrix3d skew(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

PoseCovariance to_record(const MatrixXd& Q) {
  PoseCovariance c{};
  for (std::size_t i = 0; i < 36; ++i) c[i] = Q(static_cast<Eigen::Index>(i / 6), static_cast<Eigen::Index>(i % 6));
  return c;
}

Transform<Map, Left> camera_pose(Dice& dice, Matrix3d& R, Vector3d& t) {
  R = dice.rotation();
  t = dice.normal3();
  const Eigen::Quaterniond q(R);
  return {{q.x(), q.y(), q.z(), q.w()}, {t.x(), t.y(), t.z()}};
}

// METHOD 4.1, written out: P += D G Q Gt Dt, G at the point in the camera's frame.
Matrix6d expected_noise(const Edge& x, const Matrix3d& R_m_l, const Vector3d& t_m_l, const MatrixXd& Q) {
  const Vector3d in_camera = R_m_l.transpose() * (x.p - t_m_l);
  Matrix6d G = Matrix6d::Zero(), D = Matrix6d::Identity();
  G.topLeftCorner<3, 3>().setIdentity();
  G.topRightCorner<3, 3>() = -skew(in_camera);
  G.bottomRightCorner<3, 3>() = (R_m_l.transpose() * x.R).transpose();
  D.topLeftCorner<3, 3>() = x.R.transpose() * R_m_l;
  return D * G * Q * G.transpose() * D.transpose();
}

TEST(MotionNoise, is_the_closed_form_on_every_lane) {
  Dice dice(1);
  for (int round = 0; round < 10; ++round) {
    Matrix3d R;
    Vector3d t;
    const Transform<Map, Left> T = camera_pose(dice, R, t);
    const MatrixXd Q = dice.covariance((VectorXd(6) << 1e-2, 2e-2, 5e-3, 1e-2, 5e-3, 2e-2).finished());
    std::vector<GeometryBlock> blocks(2);
    for (std::size_t i = 0; i < 32; ++i) store(record_of(dice.edge()), blocks[i / 16], i % 16);
    const std::vector<GeometryBlock> before = blocks;
    add_incremental_motion_noise(blocks, T, to_record(Q));
    for (std::size_t i = 0; i < 32; ++i) {
      const Edge x = state_of(load(before[i / 16], i % 16)), y = state_of(load(blocks[i / 16], i % 16));
      const Matrix6d expected = x.P + expected_noise(x, R, t, Q);
      const Vector6d s = expected.diagonal().cwiseSqrt().cwiseInverse();
      EXPECT_LT((s.asDiagonal() * (y.P - expected) * s.asDiagonal()).norm(), 1e-4);
      EXPECT_EQ(y.p, x.p);
      EXPECT_EQ(y.R, x.R);
      EXPECT_GT(smallest_scaled_eigenvalue(y.P), 0);
    }
  }
}

// The formula itself: perturb the relative motion, and see where edges that stand still in the camera's frame go.
TEST(MotionNoise, is_what_an_error_of_the_increment_does) {
  Dice dice(2);
  Matrix3d R;
  Vector3d t;
  const Transform<Map, Left> T = camera_pose(dice, R, t);
  const Edge x = dice.edge();
  // The k-th error alone, as a covariance of rank one.
  for (int k = 0; k < 6; ++k) {
    MatrixXd Q = MatrixXd::Zero(6, 6);
    Q(k, k) = 1e-8;
    std::vector<GeometryBlock> blocks(1);
    store(record_of(x), blocks[0], 0);
    const Edge before = state_of(load(blocks[0], 0));
    const MotionNoise noise = motion_noise_in_map(T, to_record(Q));
    // Error of size 1e-4: X' = Exp(rho) X + tau in the camera's frame.
    Vector6d e = Vector6d::Zero();
    e[k] = 1e-4;
    const Vector3d in_camera = R.transpose() * (before.p - t);
    const Vector3d moved_point = R * (exp_so3(e.tail<3>()) * in_camera + e.head<3>()) + t;
    const Vector3d got(noise.translation[k][0], noise.translation[k][1], noise.translation[k][2]);
    const Vector3d turn(noise.rotation[k][0], noise.rotation[k][1], noise.rotation[k][2]);
    EXPECT_LT((got + turn.cross(before.p - t) - (moved_point - before.p)).norm(), 1e-7);
    EXPECT_LT((turn - R * e.tail<3>()).norm(), 1e-9);
  }
}

TEST(MotionNoise, of_a_semi_definite_covariance_is_complete) {
  Dice dice(3);
  const VectorXd direction = dice.normals(6);
  const MatrixXd Q = direction * direction.transpose();  // rank one, and its pivots are rounding after the first
  const MotionNoise noise = motion_noise_in_map(Transform<Map, Left>{}, to_record(Q));
  MatrixXd sum = MatrixXd::Zero(6, 6);
  for (const int k : {0, 1, 2, 3, 4, 5}) {
    VectorXd v(6);
    for (int i = 0; i < 3; ++i) {
      v[i] = noise.translation[k][i];
      v[3 + i] = noise.rotation[k][i];
    }
    sum += v * v.transpose();
  }
  EXPECT_LT((sum - Q).norm(), 1e-6 * Q.norm());
}

TEST(MotionNoise, of_an_exact_motion_is_nothing) {
  Dice dice(4);
  std::vector<GeometryBlock> blocks(1);
  for (std::size_t i = 0; i < 16; ++i) store(record_of(dice.edge()), blocks[0], i);
  const GeometryBlock before = blocks[0];
  add_incremental_motion_noise(blocks, Transform<Map, Left>{}, PoseCovariance{});
  for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(load(blocks[0], i).covariance, load(before, i).covariance);
}

}  // namespace
}  // namespace accrete
