#include "cli/score/statistics.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>

namespace accrete::cli {

double percentile(std::vector<double> values, double percent) {
  std::sort(values.begin(), values.end());
  const double position = percent / 100 * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  const double s = position - static_cast<double>(below);
  return values[below] + s * (values[above] - values[below]);
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

double root_mean_square(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

nlohmann::ordered_json summarize(const std::vector<double>& values, double scale) {
  if (values.empty()) return {{"n", 0}, {"median", nullptr}, {"rms", nullptr}, {"p95", nullptr}};
  return {{"n", values.size()},
          {"median", median(values) * scale},
          {"rms", root_mean_square(values) * scale},
          {"p95", percentile(values, 95) * scale}};
}

double chi2_quantile(double probability, double degrees_of_freedom) {
  double low = -8, high = 8, z = 0;  // standard normal quantile by bisection
  for (int i = 0; i < 80; ++i) {
    z = 0.5 * (low + high);
    (0.5 * std::erfc(-z / std::sqrt(2.0)) < probability ? low : high) = z;
  }
  const double k = degrees_of_freedom;
  return k * std::pow(std::max(0.0, 1 - 2 / (9 * k) + z * std::sqrt(2 / (9 * k))), 3);
}

std::array<double, 2> bootstrap_mean_95(const std::vector<double>& values) {
  if (values.size() == 1) return {values[0], values[0]};
  std::mt19937 generator(1);
  const auto largest = static_cast<std::uint32_t>(values.size() - 1);
  const std::uint32_t mask = std::bit_ceil(largest + 1) - 1;
  std::vector<double> means(400);
  for (double& m : means) {
    double sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      std::uint32_t pick = 0;
      do pick = static_cast<std::uint32_t>(generator()) & mask;
      while (pick > largest);
      sum += values[pick];
    }
    m = sum / static_cast<double>(values.size());
  }
  return {percentile(means, 2.5), percentile(means, 97.5)};
}

}  // namespace accrete::cli
