// Do both eyes see the same brightness, and does that stay so?
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/doctor/diagnosis.h"
#include "cli/doctor/limits.h"
#include "cli/score/statistics.h"

namespace accrete::cli {
namespace {

struct Gain {
  double frame = 0, stops = 0;
};

// Right over left, of the surroundings of points seen by both; a sample with fewer than eight says nothing.
std::vector<Gain> gains(const Patient& patient) {
  constexpr float kDark = 15, kBright = 240;  // beyond, a sensor clips or shows its offset
  constexpr std::size_t kFewest = 8;
  std::vector<std::vector<double>> of(patient.samples->list.size());
  for (const AlignedPair& p : patient.view.pairs)
    if (std::abs(p.rows()) <= kOnLinePx && std::min(p.brightness_left, p.brightness_right) > kDark &&
        std::max(p.brightness_left, p.brightness_right) < kBright)
      of[p.sample].push_back(std::log2(p.brightness_right / p.brightness_left));
  std::vector<Gain> out;
  for (std::size_t s = 0; s < of.size(); ++s)
    if (of[s].size() >= kFewest) out.push_back({static_cast<double>(patient.samples->list[s].number), median(of[s])});
  return out;
}

// Median of the slopes between all pairs (Theil and Sen), times the length: what it changes by in all.
double drift(const std::vector<Gain>& list) {
  std::vector<double> slopes;
  for (std::size_t i = 0; i < list.size(); ++i)
    for (std::size_t j = i + 1; j < list.size(); ++j)
      slopes.push_back((list[j].stops - list[i].stops) / (list[j].frame - list[i].frame));
  return slopes.empty() ? 0 : median(slopes) * (list.back().frame - list.front().frame);
}

}  // namespace

void check_exposure(const Patient& patient, Diagnosis& out) {
  const std::vector<Gain> list = gains(patient);
  if (list.empty()) {
    out.checks.push_back({"brightness, right over left", "no points to compare",
                          fmt::format("+-{:g} stops", kMostGainStops), Verdict::kNotChecked});
    return;
  }
  std::vector<double> stops;
  stops.reserve(list.size());
  for (const Gain& g : list) stops.push_back(g.stops);
  const double level = median(stops);
  constexpr std::size_t kFewestForDrift = 4;
  const double change = list.size() >= kFewestForDrift ? drift(list) : 0;
  const bool differs = std::abs(level) > kMostGainStops, drifts = std::abs(change) > kMostDriftStops;
  out.checks.push_back({"brightness, right over left", fmt::format("{:+.2f} stops", level),
                        fmt::format("+-{:g} stops", kMostGainStops), differs ? Verdict::kFault : Verdict::kOk});
  out.checks.push_back({"change of that over the recording",
                        list.size() >= kFewestForDrift ? fmt::format("{:+.2f} stops", change) : "too few frames",
                        fmt::format("+-{:g} stops", kMostDriftStops),
                        list.size() < kFewestForDrift ? Verdict::kNotChecked
                        : drifts                      ? Verdict::kFault
                                                      : Verdict::kOk});
  if (!differs && !drifts) return;
  const char* eye = patient.change.swap ? "left" : "right";
  std::string what;
  if (drifts)
    what = fmt::format("The {} image gets {} than the other in the course of the recording, by {:.0f} % in all.", eye,
                       change > 0 ? "brighter" : "darker", 100 * (std::exp2(std::abs(change)) - 1));
  if (differs)
    what += fmt::format("{}The {} image is {} than the other, by {:.0f} %.", what.empty() ? "" : " ", eye,
                        level > 0 ? "brighter" : "darker", 100 * (std::exp2(std::abs(level)) - 1));
  out.findings.push_back(
      {drifts ? "exposure_drift" : "exposure_difference", what, "clear",
       "Switch off automatic exposure, gain and white balance in both cameras after they have "
       "settled, and give both the same values. The colours of edges are matched between the eyes."});
}

}  // namespace accrete::cli
