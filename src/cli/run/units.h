// Flags that carry units, ranges and boxes. Each throws Failure(kUsage) with the flag's name and an example.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>

#include "accrete/params.h"

namespace accrete::cli {

// "0.4:0.9", "400mm:", ":2m": metres unless it says otherwise; an open end is 0 (no limit).
struct DepthRange {
  double min_m = 0, max_m = 0;
};
[[nodiscard]] DepthRange parse_depth_range(const std::string& text);

// "0.3mm:1mrad", "0.0003m:0.06deg": both units must be there, a bare number could be anything.
struct PoseSigma {
  double sigma_m = 0, sigma_rad = 0;
};
[[nodiscard]] PoseSigma parse_pose_sigma(const std::string& flag, const std::string& text);

// "12:50", "12:", ":50": first and last frame of the recording, both used, counted from 0.
struct FrameRange {
  std::uint64_t first = 0, last = std::numeric_limits<std::uint64_t>::max();

  [[nodiscard]] bool contains(std::uint64_t frame) const { return frame >= first && frame <= last; }
  [[nodiscard]] bool limited() const { return first > 0 || last != std::numeric_limits<std::uint64_t>::max(); }
};
[[nodiscard]] FrameRange parse_frame_range(const std::string& text);

// "50ms", "0.05s".
[[nodiscard]] std::int64_t parse_duration_ns(const std::string& flag, const std::string& text);

// "xmin,ymin,zmin,xmax,ymax,zmax" in metres, in the map frame.
[[nodiscard]] ExcludedBox parse_excluded_box(const std::string& text);

}  // namespace accrete::cli
