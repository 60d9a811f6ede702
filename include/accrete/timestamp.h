// Time as integer nanoseconds. Never nanoseconds in a double: 1.4e18 has a spacing of 256 ns there.
// Own type rather than <chrono>: that header costs 0.4 s of compile time in every file that includes it.
#pragma once

#include <compare>
#include <cstdint>

namespace accrete {

struct Timestamp {  // of whichever clock the source has
  std::int64_t ns = 0;

  friend constexpr auto operator<=>(const Timestamp&, const Timestamp&) = default;
};

// The signed span from `b` to `a` in nanoseconds.
[[nodiscard]] constexpr std::int64_t operator-(Timestamp a, Timestamp b) { return a.ns - b.ns; }

[[nodiscard]] constexpr double to_seconds(std::int64_t span_ns) { return static_cast<double>(span_ns) * 1e-9; }  // in s

}  // namespace accrete
