// The uncertainty of a reconstruction against what random noise does, and against the closed forms and the table of
// METHOD 3.3 (f = 800 px, B = 0.12 m, sigma_n = 0.3 px, sigma_theta = 2 degrees; an edge in the image plane).
#include <gtest/gtest.h>

#include "numeric/lane_bridge.h"
#include "stereo/reconstruct_kernel.h"

namespace accrete {
namespace {

using namespace oracle;

constexpr double kF = 800, kB = 0.12, kSigmaN = 0.3, kSigmaTheta = 2 * kDegree;

struct Case {
  double Z, psi_deg;
  double sigma_Z_mm, jacobian_deg, unscented_deg, monte_carlo_deg, in_plane_deg;
};
// METHOD 3.3, measured there.
const Case kTable[] = {{0.6, 90, 1.6, 14.1, 13.2, 13.2, 1.4}, {0.6, 45, 2.2, 20.0, 17.6, 17.5, 1.6},
                       {0.6, 20, 4.7, 41.4, 27.3, 28.5, 1.9}, {1.0, 90, 4.4, 23.6, 19.8, 19.7, 1.4},
                       {1.0, 45, 6.3, 33.3, 24.6, 25.1, 1.5}, {1.0, 20, 12.9, 68.9, 32.1, 36.4, 1.6}};

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
// Standard deviation of the tilt out of the image plane and in it, in degrees. The image plane is that of local y (b);
// the tilt about b turns the tangent out of it, the tilt about a within it.
double out_of_plane_deg(const Edge& x) { return std::sqrt(x.P(4, 4)) / kDegree; }
double in_plane_deg(const Edge& x) { return std::sqrt(x.P(5, 5)) / kDegree; }

TEST(ReconstructUncertainty, is_that_of_the_table) {
  for (const Case& c : kTable) {
    const Edge x = reconstructed(c);
    EXPECT_NEAR(out_of_plane_deg(x), c.unscented_deg, 0.02 * c.unscented_deg) << c.Z << " " << c.psi_deg;
    EXPECT_NEAR(in_plane_deg(x), c.in_plane_deg, 0.15) << c.Z << " " << c.psi_deg;
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
    const auto [l, r] = pair_of(c);
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
  const Case c = {0.6, 60, 0, 0, 0, 0, 0};
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

// 40,000 draws at 20 degrees, where the first order is wrong by half: the unscented transform is not.
TEST(ReconstructUncertainty, is_what_random_noise_does_at_20_degrees) {
  for (const Case& c : kTable) {
    if (c.psi_deg != 20) continue;
    Dice dice(1);
    const auto [l, r] = pair_of(c);
    const Edge x = reconstructed(c);
    const int draws = 40000;
    double out2 = 0, in2 = 0;
    std::vector<double> depth;
    for (int k = 0; k < draws; ++k) {
      const EdgePoint<double> e =
          intersect<double>(moved(l, dice.uniform(-2, 2), kSigmaN * dice.normal(), kSigmaTheta * dice.normal()),
                            moved(r, 0.0, kSigmaN * dice.normal(), kSigmaTheta * dice.normal()), kF, kB);
      const Vector3d t = x.R.transpose() * Vector3d(e.tangent);
      const double angle = std::atan2(std::hypot(t.y(), t.z()), t.x()), scale = angle / std::hypot(t.y(), t.z());
      out2 += std::pow(t.z() * scale, 2) / draws;
      in2 += std::pow(t.y() * scale, 2) / draws;
      depth.push_back(e.point[2]);
    }
    const double monte_carlo = std::sqrt(out2) / kDegree;
    EXPECT_NEAR(monte_carlo, c.monte_carlo_deg, 0.03 * c.monte_carlo_deg);
    EXPECT_NEAR(out_of_plane_deg(x), monte_carlo, 0.13 * monte_carlo);
    EXPECT_LT(std::abs(out_of_plane_deg(x) - monte_carlo), 0.4 * std::abs(c.jacobian_deg - monte_carlo));
    // Depth, robustly: half of the distance between the quantiles of one sigma.
    std::sort(depth.begin(), depth.end());
    const double sigma_Z =
        0.5 * (depth[static_cast<std::size_t>(0.8413 * draws)] - depth[static_cast<std::size_t>(0.1587 * draws)]);
    EXPECT_NEAR(std::sqrt(x.P(2, 2)), sigma_Z, 0.05 * sigma_Z);
    RecordProperty("in_plane_deg", std::to_string(std::sqrt(in2) / kDegree));
  }
}

}  // namespace
}  // namespace accrete
