// Random numbers that are the same on every machine and compiler, addressed by a counter: the order of calls is free.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace accrete::hal::synthetic {

// The finaliser of splitmix64 (Steele, Lea, Flood 2014): every bit of the input reaches every bit of the output.
[[nodiscard]] constexpr std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

class Random {
 public:
  explicit constexpr Random(std::uint64_t seed, std::uint64_t stream = 0) : state_(mix(mix(seed) ^ stream)) {}

  constexpr std::uint64_t bits() { return mix(state_++); }
  constexpr double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1p-53);
  }
  constexpr std::size_t below(std::size_t n) { return static_cast<std::size_t>(bits() % n); }

 private:
  std::uint64_t state_;
};

// Standard normal by lookup: the medians of 4096 slices of equal probability. 12 random bits give one sample; the tails
// end at 3.7 sigma.
class NormalTable {
 public:
  static constexpr std::size_t kBits = 12;

  NormalTable() {
    for (std::size_t i = 0; i < value_.size(); ++i) {
      const double p = (static_cast<double>(i) + 0.5) / static_cast<double>(value_.size());
      double low = -8, high = 8;  // bisection: simple, and only done once
      for (int step = 0; step < 60; ++step) {
        const double middle = 0.5 * (low + high);
        (0.5 * std::erfc(-middle / std::sqrt(2.0)) < p ? low : high) = middle;
      }
      value_[i] = static_cast<float>(0.5 * (low + high));
    }
  }
  [[nodiscard]] float operator()(std::uint64_t bits) const {
    return value_[static_cast<std::size_t>(bits) & (value_.size() - 1)];
  }

 private:
  std::array<float, std::size_t{1} << kBits> value_{};
};

}  // namespace accrete::hal::synthetic
