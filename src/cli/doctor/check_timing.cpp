// Do both eyes look at the same time? By their stamps, and by rows that follow the motion.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/doctor/lag.h"
#include "cli/doctor/limits.h"
#include "cli/score/statistics.h"

namespace accrete::cli {
namespace {

void check_stamps(const Patient& patient, Diagnosis& out) {
  std::vector<double> skews;
  for (const Sample& s : patient.samples->list) skews.push_back(std::abs(to_seconds(s.t_right - s.t_left)));
  if (skews.empty() || !(patient.frame_interval_s > 0)) return;
  const double skew = percentile(skews, 90), limit = kMostSkew * patient.frame_interval_s;
  out.checks.push_back({"stamps of left and right apart", fmt::format("{:.2f} ms", 1e3 * skew),
                        fmt::format("<= {:.2f} ms", 1e3 * limit), skew <= limit ? Verdict::kOk : Verdict::kFault});
  if (skew > limit)
    out.findings.push_back(
        {"unsynchronised",
         fmt::format("The stamps of left and right image lie {:.1f} ms apart, of {:.1f} ms between two frames.",
                     1e3 * skew, 1e3 * patient.frame_interval_s),
         "certain", "Trigger both cameras together, or pair images by their stamps."});
}

}  // namespace

void check_timing(Patient& patient, Diagnosis& diagnosis) {
  check_stamps(patient, diagnosis);
  const Lag lag = lag_of(patient);
  if (lag.points < kFewestLagPoints) {
    diagnosis.checks.push_back({"one eye later than the other", "too little moves up or down",
                                fmt::format("+-{:g} frames", kMostLagFrames), Verdict::kNotChecked});
    return;
  }
  const bool late = lag.clear();
  diagnosis.checks.push_back({"one eye later than the other",
                              fmt::format("{:+.2f} frames", lag.gain <= kLagGain ? lag.frames : 0.0),
                              fmt::format("+-{:g} frames", kMostLagFrames), late ? Verdict::kFault : Verdict::kOk});
  if (!late) return;
  const bool right = lag.frames > 0;  // the image of that name
  diagnosis.findings.push_back(
      {"late_camera",
       fmt::format("The {} camera is late by {:.1f} frames: the row differences of {} moving points follow their "
                   "vertical motion (median {:.1f} px a frame), and shrink to {:.0f} % without that lag.",
                   right ? "right" : "left", std::abs(lag.frames), lag.points, lag.row_motion_px, 100 * lag.gain),
       "clear",
       fmt::format("Trigger both cameras together. In this recording, pair every {} image with the {} image of the "
                   "frame after it: shift the {} file names by one.",
                   right ? "left" : "right", right ? "right" : "left", right ? "right" : "left")});
}

}  // namespace accrete::cli
