#include "cli/run/units.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <span>
#include <string_view>
#include <utility>

#include "cli/failure.h"
#include "cli/text/number.h"

namespace accrete::cli {
namespace {

struct Unit {
  std::string_view name;
  double factor;
};
constexpr std::array<Unit, 4> kLengths{{{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}}};
constexpr std::array<Unit, 3> kAngles{{{"rad", 1}, {"mrad", 1e-3}, {"deg", std::numbers::pi / 180}}};
constexpr std::array<Unit, 4> kTimes{{{"s", 1}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}}};

[[noreturn]] void fail(std::string_view flag, std::string_view text, std::string_view expected) {
  throw Failure(ExitStatus::kUsage, fmt::format("{} {}: {}", flag, text, expected));
}

// A number followed by one of `units`; false when it is neither. `bare`: the factor without a unit, 0 forbids that.
bool parse_quantity(std::string_view text, std::span<const Unit> units, double bare, double& value) {
  text = trimmed(text);
  const auto end = std::min(text.find_first_not_of("0123456789.+-eE"), text.size());
  // An exponent without digits belongs to no number; "1e-3m" ends before the m.
  if (!parse_number(text.substr(0, end), value) || !std::isfinite(value)) return false;
  const std::string_view unit = trimmed(text.substr(end));
  double factor = unit.empty() ? bare : 0;
  for (const Unit& u : units)
    if (u.name == unit) factor = u.factor;
  value *= factor;
  return factor != 0;
}

bool split_at_colon(std::string_view text, std::string_view& left, std::string_view& right) {
  const auto colon = text.find(':');
  if (colon == std::string_view::npos || text.find(':', colon + 1) != std::string_view::npos) return false;
  left = trimmed(text.substr(0, colon));
  right = trimmed(text.substr(colon + 1));
  return true;
}

}  // namespace

DepthRange parse_depth_range(const std::string& text) {
  constexpr std::string_view kExpected =
      "needs NEAR:FAR in metres with 0 <= NEAR < FAR, e.g. 0.4:0.9, 400mm:900mm or 0.4:";
  std::string_view left, right;
  DepthRange range;
  if (!split_at_colon(text, left, right) || (left.empty() && right.empty())) fail("--depth-range", text, kExpected);
  if (!left.empty() && !parse_quantity(left, kLengths, 1, range.min_m)) fail("--depth-range", text, kExpected);
  if (!right.empty() && !parse_quantity(right, kLengths, 1, range.max_m)) fail("--depth-range", text, kExpected);
  if (range.min_m < 0 || (!right.empty() && range.max_m <= range.min_m)) fail("--depth-range", text, kExpected);
  return range;
}

PoseSigma parse_pose_sigma(const std::string& flag, const std::string& text) {
  constexpr std::string_view kExpected =
      "needs two standard deviations with units, LENGTH:ANGLE, both zero or both above it, e.g. 0.3mm:1mrad or "
      "0.001m:0.05deg";
  std::string_view left, right;
  PoseSigma sigma;
  if (!split_at_colon(text, left, right) || !parse_quantity(left, kLengths, 0, sigma.sigma_m) ||
      !parse_quantity(right, kAngles, 0, sigma.sigma_rad) || sigma.sigma_m < 0 || sigma.sigma_rad < 0 ||
      (sigma.sigma_m > 0) != (sigma.sigma_rad > 0))
    fail(flag, text, kExpected);
  return sigma;
}

FrameRange parse_frame_range(const std::string& text) {
  constexpr std::string_view kExpected =
      "needs FIRST:LAST, whole numbers from 0 with FIRST <= LAST, e.g. 12:50, 12: or :50";
  std::string_view left, right;
  FrameRange range;
  long long value = 0;
  if (!split_at_colon(text, left, right) || (left.empty() && right.empty())) fail("--frames", text, kExpected);
  if (!left.empty()) {
    if (!parse_number(left, value) || value < 0) fail("--frames", text, kExpected);
    range.first = static_cast<std::uint64_t>(value);
  }
  if (!right.empty()) {
    if (!parse_number(right, value) || value < 0) fail("--frames", text, kExpected);
    range.last = static_cast<std::uint64_t>(value);
  }
  if (range.first > range.last) fail("--frames", text, kExpected);
  return range;
}

std::int64_t parse_duration_ns(const std::string& flag, const std::string& text) {
  double seconds = 0;
  if (!parse_quantity(text, kTimes, 0, seconds) || seconds < 0 || seconds > 1e6)
    fail(flag, text, "needs a time with its unit, e.g. 50ms or 0.2s");
  return std::llround(seconds * 1e9);
}

ExcludedBox parse_excluded_box(const std::string& text) {
  constexpr std::string_view kExpected =
      "needs six numbers in metres, xmin,ymin,zmin,xmax,ymax,zmax, with each max above its min";
  std::array<double, 6> values{};
  std::string_view rest = text;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto comma = rest.find(',');
    if ((comma == std::string_view::npos) != (i == 5)) fail("--exclude-box", text, kExpected);
    if (!parse_number(rest.substr(0, comma), values[i]) || !std::isfinite(values[i]))
      fail("--exclude-box", text, kExpected);
    if (i < 5) rest.remove_prefix(comma + 1);
  }
  ExcludedBox box;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(values[i] < values[i + 3])) fail("--exclude-box", text, kExpected);
    box.min_m[i] = static_cast<float>(values[i]);
    box.max_m[i] = static_cast<float>(values[i + 3]);
  }
  return box;
}

}  // namespace accrete::cli
