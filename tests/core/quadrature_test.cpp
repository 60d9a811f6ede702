// The kernels, recomputed in double from what they should be, and the streamed filter against direct sums.
#include "extract/quadrature.h"

#include <gtest/gtest.h>

#include <array>
#include <complex>
#include <vector>

#include "core/picture.h"
#include "kernels/kernels.h"

namespace accrete::extract {
namespace {

using test::Picture;
using Kernel = std::array<std::array<double, kTaps>, kTaps>;  // [y][x]

constexpr double kPiD = 3.14159265358979323846;

double full(const float (&half)[5], int i, bool odd = false) {
  return odd && i < 0 ? -double{half[-i]} : double{half[i < 0 ? -i : i]};
}

// Riesz transform of exp(-2 pi^2 rho^2) - exp(-8 pi^2 rho^2), the difference of Gaussians of sigma 1 and 2 px, along x:
// F^-1 { -i xi_x / rho H }, over the frequencies that pixels can carry, by the midpoint rule.
Kernel riesz_x() {
  constexpr int n = 256;
  std::vector<std::array<double, kTaps>> rows(n);  // partial transforms along x, for every xi_y
  const auto xi = [](int k) { return (k + 0.5) / n - 0.5; };
  Kernel kernel{};
  for (int ky = 0; ky < n; ++ky) {
    for (int x = -kRadius; x <= kRadius; ++x) {
      double sum = 0;  // -i times the odd part of exp(2 pi i x xi) is a sine
      for (int kx = 0; kx < n; ++kx) {
        const double fx = xi(kx), fy = xi(ky), rho2 = fx * fx + fy * fy;
        const double h = std::exp(-2 * kPiD * kPiD * rho2) - std::exp(-8 * kPiD * kPiD * rho2);
        sum += fx / std::sqrt(rho2) * h * std::sin(2 * kPiD * x * fx);
      }
      rows[static_cast<std::size_t>(ky)][static_cast<std::size_t>(x + kRadius)] = sum / n;
    }
    for (int y = -kRadius; y <= kRadius; ++y)
      for (std::size_t x = 0; x < kTaps; ++x)
        kernel[static_cast<std::size_t>(y + kRadius)][x] +=
            rows[static_cast<std::size_t>(ky)][x] * std::cos(2 * kPiD * y * xi(ky)) / n;
  }
  return kernel;
}

double norm2(const Kernel& k) {
  double sum = 0;
  for (const auto& row : k)
    for (const double v : row) sum += v * v;
  return sum;
}

TEST(Quadrature, gaussians_are_sampled_and_sum_to_one) {
  for (int s = 1; s <= 2; ++s) {
    const auto& k = s == 1 ? kKernels.gauss1 : kKernels.gauss2;
    double sum = 0;
    for (int i = -kRadius; i <= kRadius; ++i) sum += std::exp(-0.5 * i * i / (s * s));
    double taps = 0;
    for (int i = -kRadius; i <= kRadius; ++i) {
      EXPECT_NEAR(full(k, i), std::exp(-0.5 * i * i / (s * s)) / sum, 3e-8);  // half a unit of float
      taps += full(k, i);
    }
    EXPECT_NEAR(taps, 1, 1e-7);
  }
}

TEST(Quadrature, even_kernel_sums_to_zero) {
  double sum = 0;
  for (int y = -kRadius; y <= kRadius; ++y)
    for (int x = -kRadius; x <= kRadius; ++x)
      sum += full(kKernels.gauss1, x) * full(kKernels.gauss1, y) - full(kKernels.gauss2, x) * full(kKernels.gauss2, y);
  EXPECT_NEAR(sum, 0, 2e-7);
}

TEST(Quadrature, odd_kernel_is_the_leading_singular_pair_of_the_riesz_transform) {
  const Kernel ideal = riesz_x();
  // Power iteration on K Kt: across[] along x, beside[] along y.
  std::array<double, kTaps> across{}, beside{};
  for (std::size_t i = 0; i < kTaps; ++i) across[i] = static_cast<double>(i) - kRadius;
  double singular = 0;
  for (int step = 0; step < 200; ++step) {
    double n = 0;
    for (std::size_t y = 0; y < kTaps; ++y) {
      beside[y] = 0;
      for (std::size_t x = 0; x < kTaps; ++x) beside[y] += ideal[y][x] * across[x];
      n += beside[y] * beside[y];
    }
    for (double& v : beside) v /= std::sqrt(n);
    n = 0;
    for (std::size_t x = 0; x < kTaps; ++x) {
      across[x] = 0;
      for (std::size_t y = 0; y < kTaps; ++y) across[x] += ideal[y][x] * beside[y];
      n += across[x] * across[x];
    }
    singular = std::sqrt(n);
    for (double& v : across) v /= singular;
  }
  const double sign = beside[kRadius] < 0 ? -1 : 1, root = std::sqrt(singular);
  for (int i = -kRadius; i <= kRadius; ++i) {
    const auto k = static_cast<std::size_t>(i + kRadius);
    EXPECT_NEAR(full(kKernels.smooth, i), sign * root * beside[k], 3e-6) << i;
    // Responses are correlations in the code, where the kernel stands mirrored.
    EXPECT_NEAR(full(kKernels.odd, -i, true), sign * root * across[k], 3e-6) << i;
  }
  // What rank 1 leaves out.
  EXPECT_NEAR(1 - singular * singular / norm2(ideal), 0.0024, 0.0001);
}

TEST(Quadrature, norms_are_those_of_the_kernels) {
  Kernel even{}, odd{};
  for (int y = -kRadius; y <= kRadius; ++y)
    for (int x = -kRadius; x <= kRadius; ++x) {
      const auto i = static_cast<std::size_t>(y + kRadius), j = static_cast<std::size_t>(x + kRadius);
      even[i][j] =
          full(kKernels.gauss1, x) * full(kKernels.gauss1, y) - full(kKernels.gauss2, x) * full(kKernels.gauss2, y);
      odd[i][j] = full(kKernels.odd, x, true) * full(kKernels.smooth, y);
    }
  EXPECT_NEAR(std::sqrt(norm2(even)), double{kEvenNorm}, 5e-5);
  EXPECT_NEAR(std::sqrt(norm2(odd)), double{kOddNorm}, 5e-5);
}

Picture random_picture(PixelFormat format, int width, int height, std::uint64_t seed) {
  test::Dice dice(seed);
  return test::paint(width, height, format, [&](double, double) {
    return test::Rgb{dice.uniform(0, 255), dice.uniform(0, 255), dice.uniform(0, 255)};
  });
}

// The triple by a direct double sum, with replicated borders.
std::array<double, 3> direct(const Picture& p, Channel channel, int x, int y) {
  double g1 = 0, g2 = 0, ox = 0, oy = 0;
  for (int dy = -kRadius; dy <= kRadius; ++dy)
    for (int dx = -kRadius; dx <= kRadius; ++dx) {
      const int px = std::clamp(x + dx, 0, p.width - 1), py = std::clamp(y + dy, 0, p.height - 1);
      const int n = channels(p.format);
      const std::uint8_t* s = p.view().row(py) + px * n;
      double v = s[0];
      if (n == 3) {
        const bool rgb = p.format == PixelFormat::kRgb8;
        const double r = s[rgb ? 0 : 2], g = s[1], b = s[rgb ? 2 : 0];
        v = channel == Channel::kLuma ? 0.299 * r + 0.587 * g + 0.114 * b : 0.5 * r - 0.5 * b;
      }
      g1 += full(kKernels.gauss1, dx) * full(kKernels.gauss1, dy) * v;
      g2 += full(kKernels.gauss2, dx) * full(kKernels.gauss2, dy) * v;
      ox += full(kKernels.odd, dx, true) * full(kKernels.smooth, dy) * v;
      oy += full(kKernels.smooth, dx) * full(kKernels.odd, dy, true) * v;
    }
  return {g1 - g2, ox, oy};
}

const RowKernels& best() { return accrete::kernels(InstructionSet::kBest).rows; }

void expect_direct_sums(const Picture& p, Channel channel, const RowKernels& kernels = best()) {
  std::vector<float> memory(quadrature_floats(static_cast<std::size_t>(p.width)));
  QuadratureFilter f(p.view(), channel, kernels, memory);
  int rows = 0;
  while (f.advance()) {
    const int y = f.newest();
    ASSERT_EQ(y, rows++);
    for (int x = 0; x < p.width; ++x) {
      const auto [even, odd_x, odd_y] = direct(p, channel, x, y);
      ASSERT_NEAR(f.even(y)[x], even, 2e-4) << x << ' ' << y;
      ASSERT_NEAR(f.odd_x(y)[x], odd_x, 2e-4) << x << ' ' << y;
      ASSERT_NEAR(f.odd_y(y)[x], odd_y, 2e-4) << x << ' ' << y;
      ASSERT_NEAR(f.energy(y)[x], even * even + odd_x * odd_x + odd_y * odd_y, 0.1) << x << ' ' << y;
    }
  }
  EXPECT_EQ(rows, p.height);
  EXPECT_FALSE(f.advance());
}

TEST(Quadrature, streamed_responses_are_the_direct_sums_in_every_format_and_instruction_set) {
  for (const InstructionSet set : {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    if (!is_available(set)) continue;
    SCOPED_TRACE(name(set));
    const RowKernels& rows = accrete::kernels(set).rows;
    for (const PixelFormat format : {PixelFormat::kGrey8, PixelFormat::kRgb8, PixelFormat::kBgr8}) {
      const Picture p = random_picture(format, 53, 37, 7);
      expect_direct_sums(p, Channel::kLuma, rows);
      if (format != PixelFormat::kGrey8) expect_direct_sums(p, Channel::kChroma, rows);
    }
  }
}

TEST(Quadrature, images_smaller_than_the_kernel_replicate_their_borders) {
  for (const auto& [w, h] : {std::pair{1, 1}, {3, 2}, {2, 9}, {9, 1}})
    expect_direct_sums(random_picture(PixelFormat::kGrey8, w, h, 8), Channel::kLuma);
}

TEST(Quadrature, of_one_pixel_later_is_the_streamed_response) {
  const Picture p = random_picture(PixelFormat::kGrey8, 40, 30, 9);
  for (int y = kRadius; y < 30 - kRadius; ++y)
    for (int x = kRadius; x < 40 - kRadius; ++x) {
      const Triple t = quadrature_at(p.data.data(), p.width, x, y);
      const auto [even, odd_x, odd_y] = direct(p, Channel::kLuma, x, y);
      ASSERT_NEAR(t.even, even, 2e-4);
      ASSERT_NEAR(t.odd_x, odd_x, 2e-4);
      ASSERT_NEAR(t.odd_y, odd_y, 2e-4);
    }
}

TEST(Quadrature, a_flat_image_has_no_response) {
  for (const double v : {0.0, 1.0, 128.0, 255.0}) {
    const Picture p = test::paint_grey(40, 30, [&](double, double) { return v; });
    std::vector<float> memory(quadrature_floats(40));
    QuadratureFilter f(p.view(), Channel::kLuma, best(), memory);
    while (f.advance())
      for (int x = 0; x < 40; ++x) ASSERT_LT(f.energy(f.newest())[x], 1e-7F);
  }
}

// Verdicts and rounding are exact: the same of every instruction set, and as a plain reading of the rule says.
TEST(Rows, maxima_and_grey_levels_are_the_same_of_every_instruction_set) {
  test::Dice dice(11);
  constexpr int kAround = 1;
  std::array<std::vector<float>, 6> v;
  for (auto& row : v) row.resize(kChunk + 2 * kAround);
  for (int trial = 0; trial < 500; ++trial) {
    for (auto& row : v)
      for (float& x : row) x = static_cast<float>(static_cast<int>(dice.uniform(0, 6)));  // ties are frequent
    const MaximaRows rows{v[0].data(), v[1].data(), v[2].data(), v[3].data(), v[4].data(), v[5].data()};
    std::vector<float> grey(77);
    for (float& g : grey) g = static_cast<float>(dice.uniform(0, 255.49));
    for (const InstructionSet set : {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512}) {
      if (!is_available(set)) continue;
      SCOPED_TRACE(name(set));
      std::array<std::int32_t, kChunk> keep{};
      accrete::kernels(set).rows.find_maxima(rows, kAround, 2.0F, 0.5F, keep.data());
      for (std::size_t i = 0; i < kChunk; ++i) {
        const std::size_t x = i + kAround;
        const float e = v[1][x], xx = v[3][x] * v[3][x], yy = v[4][x] * v[4][x];
        bool along_x = xx > yy;
        if (xx == yy) along_x = v[1][x - 1] + v[1][x + 1] <= v[0][x] + v[2][x];
        const float before = along_x ? v[1][x - 1] : v[0][x], after = along_x ? v[1][x + 1] : v[2][x];
        ASSERT_EQ(keep[i] != 0, e > 2 && e > before && e >= after && v[5][x] * 0.5F <= e) << i;
      }
      std::vector<std::uint8_t> bytes(grey.size());
      accrete::kernels(set).rows.round_to_bytes(grey.data(), static_cast<int>(grey.size()), bytes.data());
      for (std::size_t i = 0; i < grey.size(); ++i)
        ASSERT_EQ(bytes[i], static_cast<std::uint8_t>(std::floor(grey[i] + 0.5F))) << grey[i];
    }
  }
}

}  // namespace
}  // namespace accrete::extract
