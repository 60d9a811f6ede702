// The uncertainty of a reconstruction against what random noise does, and against the closed forms and the table of
// METHOD 3.3 (f = 800 px, B = 0.12 m, sigma_n = 0.3 px, sigma_theta = 2 degrees; an edge in the image plane).
#include <gtest/gtest.h>

#include "numeric/dice.h"
#include "numeric/lane_bridge.h"
#include "stereo/reconstruct_kernel.h"

namespace accrete {
namespace {

using namespace oracle;

constexpr double kF = 800, kB = 0.12, kSigmaN = 0.3, kSigmaTheta = 2 * kDegree;

struct Case {
  double Z, psi_deg;
  double sigma_Z_mm, jacobian_deg, unscented_deg, monte_carlo_deg;
};
// METHOD 3.3, measured there. Its unscented and Monte Carlo columns are the sine of the angle out of the image plane.
const Case kTable[] = {{0.6, 90, 1.6, 14.1, 13.2, 13.2}, {0.6, 45, 2.2, 20.0, 17.6, 17.5},
                       {0.6, 20, 4.7, 41.4, 27.3, 28.5}, {1.0, 90, 4.4, 23.6, 19.8, 19.7},
                       {1.0, 45, 6.3, 33.3, 24.6, 25.1}, {1.0, 20, 12.9, 68.9, 32.1, 36.4}};

std::pair<Element<double>, Element<double>> pair_of(const Case& c) {
  const double s = std::sin(c.psi_deg * kDegree), k = std::cos(c.psi_deg * kDegree), d = kF * kB / c.Z;
  return {{0.5 * d, 0, k, s}, {-0.5 * d, 0, k, s}};
}
Edge reconstructed(const Case& c, double sigma_t = 1.15) {
  const auto [l, r] = pair_of(c);
  const Noise5<double> sigma = {sigma_t, kSigmaN, kSigmaTheta, kSigmaN, kSigmaTheta};
  LaneState<double> y;
  EXPECT_EQ(reconstruct<double>(l, r, sigma, kF, kB, 0.8727, 0.0175, y), ReconstructOutcome::kOk);
  return to_state(y);
}
// Standard deviation in degrees of the tilt that turns the tangent out of the image plane: that about b.
double out_of_plane_deg(const Edge& x) { return std::sqrt(x.P(4, 4)) / kDegree; }

// A tangent out of noise (e_t, e_n,l, e_theta,l, e_n,r, e_theta,r), in the own frame of `x`.
Vector3d noisy_tangent(const Case& c, const Edge& x, const VectorXd& e) {
  const auto [l, r] = pair_of(c);
  return x.R.transpose() *
         Vector3d(intersect<double>(moved(l, e[0], e[1], e[2]), moved(r, 0.0, e[3], e[4]), kF, kB).tangent);
}
double tilt_about_b(const Vector3d& t) {
  const double sine = std::hypot(t.y(), t.z());
  return sine < 1e-15 ? 0 : -t.z() * std::atan2(sine, t.x()) / sine;
}

TEST(ReconstructUncertainty, is_that_of_the_table) {
  const VectorXd sigma = (VectorXd(5) << 1.15, kSigmaN, kSigmaTheta, kSigmaN, kSigmaTheta).finished();
  for (const Case& c : kTable) {
    const Edge x = reconstructed(c);
    const Moments m = unscented(MatrixXd(sigma.array().square().matrix().asDiagonal()), [&](const VectorXd& e) {
      const Vector3d t = noisy_tangent(c, x, e);
      return VectorXd(Vector2d(t.z(), tilt_about_b(t)));
    });
    EXPECT_NEAR(std::sqrt(m.covariance(0, 0)) / kDegree, c.unscented_deg, 0.1) << c.Z << " " << c.psi_deg;
    EXPECT_NEAR(out_of_plane_deg(x), std::sqrt(m.covariance(1, 1)) / kDegree, 0.01) << c.Z << " " << c.psi_deg;
  }
}

TEST(ReconstructUncertainty, of_depth_is_the_closed_form) {
  for (const Case& c : kTable) {
    // Slide 0: it moves the point along an edge in the image plane, and so not in depth.
    const double sigma_Z = std::sqrt(reconstructed(c).P(2, 2));
    const double closed = c.Z * c.Z / (kF * kB) * std::sqrt(2 * kSigmaN * kSigmaN) / std::sin(c.psi_deg * kDegree);
    EXPECT_NEAR(sigma_Z, closed, 0.02 * closed);
    EXPECT_NEAR(1e3 * sigma_Z, c.sigma_Z_mm, 0.03 * c.sigma_Z_mm);
  }
}

// d(point, tangent) / d(noise), numerically, with the noise of the elements: what linear propagation would say.
TEST(ReconstructUncertainty, closed_forms_are_the_numerical_jacobian) {
  for (const Case& c : kTable) {
    const auto pair = pair_of(c);
    const Element<double>& l = pair.first;
    const Element<double>& r = pair.second;
    const EdgePoint<double> centre = intersect<double>(l, r, kF, kB);
    const double h = 1e-5;
    double variance_Z = 0, variance_slope = 0, variance_out = 0, variance_in = 0;
    for (int k = 0; k < 4; ++k) {
      const auto shifted = [&](double s) {
        const double n = k % 2 == 0 ? s : 0, a = k % 2 == 0 ? 0 : s;
        return k < 2 ? intersect<double>(moved(l, 0.0, n, a), r, kF, kB)
                     : intersect<double>(l, moved(r, 0.0, n, a), kF, kB);
      };
      const EdgePoint<double> p = shifted(h), m = shifted(-h);
      const double sigma = k % 2 == 0 ? kSigmaN : kSigmaTheta;
      const Vector3d dt = (p.tangent - m.tangent) / (2 * h) * sigma;
      variance_Z += std::pow((p.point[2] - m.point[2]) / (2 * h) * sigma, 2);
      variance_out += dt.z() * dt.z();
      variance_in += std::pow(dt.x() * -centre.tangent[1] + dt.y() * centre.tangent[0], 2);
      // Depth along an image row: the edge's depth per metre of Y is t_z / t_y.
      const double slope = (p.tangent[2] / p.tangent[1] - m.tangent[2] / m.tangent[1]) / (2 * h) * sigma;
      variance_slope += slope * slope;
    }
    const double s = std::sin(c.psi_deg * kDegree);
    EXPECT_NEAR(std::sqrt(variance_Z), c.Z * c.Z / (kF * kB) * std::sqrt(2.0) * kSigmaN / s,
                1e-3 * std::sqrt(variance_Z));
    EXPECT_NEAR(std::sqrt(variance_slope), c.Z / kB * std::sqrt(2.0) * kSigmaTheta / (s * s),
                0.01 * std::sqrt(variance_slope));
    EXPECT_NEAR(std::sqrt(variance_out), c.Z / kB * std::sqrt(2.0) * kSigmaTheta / s, 0.01 * std::sqrt(variance_out));
    EXPECT_NEAR(std::sqrt(variance_in), kSigmaTheta / std::sqrt(2.0), 0.2 * std::sqrt(variance_in));
    EXPECT_NEAR(std::sqrt(variance_out) / kDegree, c.jacobian_deg, 0.02 * c.jacobian_deg);
  }
}

// What the angle adds when the two points lie on different rows: the term Delta_s^2 sigma_theta^2.
TEST(ReconstructUncertainty, of_depth_grows_with_the_slide_between_the_points) {
  const Case c = {0.6, 60, 0, 0, 0, 0};
  auto [l, r] = pair_of(c);
  const double slide = 12;
  r = moved(r, slide, 0.0, 0.0);
  LaneState<double> y;
  ASSERT_EQ(reconstruct<double>(l, r, {0, kSigmaN, kSigmaTheta, kSigmaN, kSigmaTheta}, kF, kB, 0.8727, 0.0175, y),
            ReconstructOutcome::kOk);
  const double closed = c.Z * c.Z / (kF * kB) / std::sin(c.psi_deg * kDegree) *
                        std::sqrt(2 * kSigmaN * kSigmaN + std::pow(slide * kSigmaTheta, 2));
  EXPECT_NEAR(std::sqrt(y.P(2, 2)), closed, 0.02 * closed);
}

// 40,000 draws at 20 degrees, where the first order is wrong by a third to a half: the unscented transform is not.
TEST(ReconstructUncertainty, is_what_random_noise_does_at_20_degrees) {
  for (const Case& c : kTable) {
    if (c.psi_deg != 20) continue;
    Dice dice(1);
    const auto [l, r] = pair_of(c);
    const Edge x = reconstructed(c);
    const int draws = 40000;
    double sine2 = 0, tilt2 = 0;
    std::vector<double> depth;
    for (int k = 0; k < draws; ++k) {
      VectorXd e = dice.normals(5);
      e = (e.array() * (VectorXd(5) << 1.15, kSigmaN, kSigmaTheta, kSigmaN, kSigmaTheta).finished().array()).matrix();
      const Vector3d t = noisy_tangent(c, x, e);
      sine2 += t.z() * t.z() / draws;
      tilt2 += std::pow(tilt_about_b(t), 2) / draws;
      depth.push_back(intersect<double>(moved(l, e[0], e[1], e[2]), moved(r, 0.0, e[3], e[4]), kF, kB).point[2]);
    }
    EXPECT_NEAR(std::sqrt(sine2) / kDegree, c.monte_carlo_deg, 0.02 * c.monte_carlo_deg);
    const double monte_carlo = std::sqrt(tilt2) / kDegree;
    EXPECT_NEAR(out_of_plane_deg(x), monte_carlo, 0.08 * monte_carlo);
    EXPECT_LT(std::abs(out_of_plane_deg(x) - monte_carlo), 0.2 * std::abs(c.jacobian_deg - monte_carlo));
    // Depth, robustly: half of the distance between the quantiles of one sigma.
    std::sort(depth.begin(), depth.end());
    const double sigma_Z =
        0.5 * (depth[static_cast<std::size_t>(0.8413 * draws)] - depth[static_cast<std::size_t>(0.1587 * draws)]);
    EXPECT_NEAR(std::sqrt(x.P(2, 2)), sigma_Z, 0.05 * sigma_Z);
  }
}

}  // namespace
}  // namespace accrete
