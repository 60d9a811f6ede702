#include "cli/score/appearance.h"

#include <array>
#include <cmath>
#include <numbers>

#include "cli/score/statistics.h"

namespace accrete::cli {
namespace {

using nlohmann::ordered_json;

constexpr double kComparable = 0.05;  // sides closer in brightness than this have no order

bool finite(const Vec3& v) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }
double brightness(const Vec3& v) { return (v[0] + v[1] + v[2]) / 3; }
int sign(double v) { return v > 0 ? 1 : v < 0 ? -1 : 0; }
bool same_direction(const Matched& m) { return dot(m.edge->tangent, m.segment->direction) > 0; }

// Colours seen by the truth and by the estimate, sides named along the primitive's own tangent.
struct Pair {
  Vec3 truth{}, estimate{};
};

// Least squares estimate = offset + gain * truth; the smallest such pair when the truth does not vary.
std::array<double, 2> offset_and_gain(const std::vector<Pair>& pairs, int channel) {
  double n = 0, st = 0, se = 0, stt = 0, ste = 0;
  for (const Pair& p : pairs) {
    const double t = p.truth[channel], e = p.estimate[channel];
    n += 1, st += t, se += e, stt += t * t, ste += t * e;
  }
  const double mean_t = st / n, mean_e = se / n, variance = stt / n - mean_t * mean_t;
  if (variance < 1e-14) {
    const double k = mean_e / (1 + mean_t * mean_t);
    return {k, k * mean_t};
  }
  const double gain = (ste / n - mean_t * mean_e) / variance;
  return {mean_e - gain * mean_t, gain};
}

double rms_error(const std::vector<Pair>& pairs, std::size_t begin, std::size_t end,
                 const std::array<std::array<double, 2>, 3>& fit) {
  std::vector<double> errors;
  for (std::size_t i = begin; i < end; ++i)
    for (int c = 0; c < 3; ++c) errors.push_back(pairs[i].estimate[c] - (fit[c][0] + fit[c][1] * pairs[i].truth[c]));
  return root_mean_square(errors);
}

}  // namespace

ordered_json score_colour(const std::vector<Matched>& matched, bool with_axes) {
  std::vector<Pair> left, right;
  double comparable = 0, agree = 0, with_y = 0, y_right = 0;
  for (const Matched& m : matched) {
    const Segment& s = *m.segment;
    const ScoredEdge& e = *m.edge;
    if (!finite(s.left) || !finite(s.right) || !finite(e.left) || !finite(e.right)) continue;
    const bool forward = same_direction(m);
    left.push_back({forward ? s.left : s.right, e.left});
    right.push_back({forward ? s.right : s.left, e.right});
    const double truth_step = brightness(right.back().truth - left.back().truth);
    if (std::abs(truth_step) > kComparable) {
      comparable += 1;
      agree += sign(truth_step) == sign(brightness(e.right - e.left)) ? 1 : 0;
    }
    const Vec3 y{e.rotation[1], e.rotation[4], e.rotation[7]};
    const double to_right = dot(cross(e.tangent, s.normal), y);
    if (std::isfinite(to_right)) {
      with_y += 1;
      y_right += to_right > 0 ? 1 : 0;
    }
  }
  const std::size_t n = left.size();
  if (n == 0) return {{"n", 0}};
  std::vector<Pair> all = left;
  all.insert(all.end(), right.begin(), right.end());
  constexpr std::array<std::array<double, 2>, 3> kRaw{{{0, 1}, {0, 1}, {0, 1}}};
  const std::array<std::array<double, 2>, 3> fit{offset_and_gain(all, 0), offset_and_gain(all, 1),
                                                 offset_and_gain(all, 2)};
  ordered_json out;
  out["n"] = n;
  out["side_assignment_correct"] = comparable > 0 ? ordered_json(agree / comparable) : ordered_json(nullptr);
  out["rms_left"] = rms_error(all, 0, n, kRaw);
  out["rms_right"] = rms_error(all, n, 2 * n, kRaw);
  out["rms_left_after_gain"] = rms_error(all, 0, n, fit);
  out["rms_right_after_gain"] = rms_error(all, n, 2 * n, fit);
  out["offset_gain_per_channel"] = fit;
  if (with_axes) out["local_y_points_right"] = with_y > 0 ? ordered_json(y_right / with_y) : ordered_json(nullptr);
  return out;
}

ordered_json score_phase(const std::vector<Matched>& matched, bool with_colours) {
  constexpr double kPi = std::numbers::pi;
  std::vector<double> deviations;
  double near_step = 0, comparable = 0, positive = 0;
  for (const Matched& m : matched) {
    if (!std::isfinite(m.edge->phase)) continue;
    const double turns = (m.edge->phase + kPi) / (2 * kPi);
    const double phase = (turns - std::floor(turns)) * 2 * kPi - kPi;
    deviations.push_back(std::abs(std::abs(phase) - kPi / 2));
    near_step += deviations.back() <= 0.5 ? 1 : 0;
    const double step = brightness(m.segment->right - m.segment->left) * (same_direction(m) ? 1 : -1);
    if (std::isfinite(step) && std::abs(step) > kComparable) {
      comparable += 1;
      positive += sign(phase) * sign(step) > 0 ? 1 : 0;
    }
  }
  if (deviations.empty()) return {{"n", 0}};
  ordered_json out;
  out["n"] = deviations.size();
  out["within_0.5rad_of_step"] = near_step / static_cast<double>(deviations.size());
  out["median_deviation_rad"] = median(deviations);
  if (with_colours && comparable > 0) out["positive_when_right_brighter"] = positive / comparable;
  return out;
}

}  // namespace accrete::cli
