// The few statistics of the scorer, defined as numpy defines them, so that both programs print the same numbers.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <vector>

namespace accrete::cli {

// Linear interpolation between order statistics; `percent` in 0..100. Precondition: not empty.
[[nodiscard]] double percentile(std::vector<double> values, double percent);
[[nodiscard]] inline double median(std::vector<double> values) { return percentile(std::move(values), 50); }
[[nodiscard]] double mean(const std::vector<double>& values);
[[nodiscard]] double root_mean_square(const std::vector<double>& values);

// {"n", "median", "rms", "p95"} of scale * values; null where there are none.
[[nodiscard]] nlohmann::ordered_json summarize(const std::vector<double>& values, double scale = 1);

// Quantile of the chi-square distribution by Wilson and Hilferty; better than 1 % for k >= 2 at the usual levels.
[[nodiscard]] double chi2_quantile(double probability, double degrees_of_freedom);

// The 2.5 and 97.5 percentiles of the mean over 400 resamples. The generator is Mersenne Twister with seed 1 and masked
// rejection: the draws of numpy's RandomState(1).randint.
[[nodiscard]] std::array<double, 2> bootstrap_mean_95(const std::vector<double>& values);

}  // namespace accrete::cli
