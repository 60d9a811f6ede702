// Do the given poses move points to where the next frame shows them? If not: which misreading explains it.
#include <fmt/format.h>

#include <algorithm>

#include "cli/doctor/limits.h"
#include "cli/doctor/pose_readings.h"

namespace accrete::cli {
namespace {

void not_checked(Diagnosis& out, std::string why) {
  out.checks.push_back({"points moved by the poses", std::move(why), fmt::format("<= {:g} px", kMostPoseResidualPx),
                        Verdict::kNotChecked});
}

bool stands(const Diagnosis& d) {
  return std::none_of(d.findings.begin(), d.findings.end(), [](const DoctorFinding& f) {
    return f.fault == "late_camera" || f.fault == "rig_unknown" || f.fault == "too_few_points";
  });
}

}  // namespace

void check_poses(Patient& patient, Diagnosis& out) {
  if (!patient.has_poses) return not_checked(out, "there are no poses");
  if (!stands(out)) return not_checked(out, "the rig has to be right first");
  const Tracks tracks = track(*patient.samples, patient.view, patient.rig, patient.change, patient.mode);
  const PoseFit given = fit_poses(*patient.samples, tracks, patient.rig, as_given);
  if (given.steps < kFewestSteps)
    return not_checked(out, fmt::format("{} of {} steps between frames can be followed", given.steps, tracks.tried));
  const bool wrong = given.residual_px > kMostPoseResidualPx && given.residual_px > kMuchWorsePoses * given.flow_px;
  out.checks.push_back({"points moved by the poses",
                        fmt::format("{:.2f} px off, of {:.1f} px ({} steps; {:.2f} px by the images' own motion)",
                                    given.residual_px, given.flow_px, given.steps, given.own_px),
                        fmt::format("<= {:g} px", kMostPoseResidualPx), wrong ? Verdict::kFault : Verdict::kOk});
  if (!wrong) return;
  const std::vector<NamedReading> readings = pose_readings(patient);
  const NamedReading* best = nullptr;
  const double enough = std::min(kMostPoseResidualPx, kPosesExplained * given.residual_px);
  double least = 0;
  for (const NamedReading& reading : readings) {
    const PoseFit fit = fit_poses(*patient.samples, tracks, patient.rig, reading.reading);
    if (fit.steps < kFewestSteps || fit.residual_px > enough) continue;
    if (best != nullptr && fit.residual_px > 0.8 * least) continue;  // the likelier ones come first
    least = fit.residual_px;
    best = &reading;
  }
  const std::string figures =
      fmt::format(" As given, points come to lie {:.1f} px from where they are seen", given.residual_px);
  if (best != nullptr) {
    out.findings.push_back({best->fault, fmt::format("{}{}, with that undone {:.2f} px.", best->what, figures, least),
                            "clear", best->advice});
    return;
  }
  out.findings.push_back(
      {"poses_unknown",
       fmt::format("The poses do not fit the images.{}, and none of the known misreadings explains it.", figures),
       "cannot tell more",
       "Are they of these cameras (hand-eye calibration) and of these times? --pose-dir, --pose-frame, --motion and "
       "--poses say how they are read."});
}

}  // namespace accrete::cli
