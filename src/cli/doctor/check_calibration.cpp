// What can be seen without matching anything: for which size of image the calibration is, and in which unit.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cli/doctor/diagnosis.h"

namespace accrete::cli {
namespace {

// A principal point lies near the middle of the image: within 17 % of half its size on the sane recordings
// (temple_ring's is 16 % below, its images are cut out of larger ones). Beyond 40 % it belongs to another image.
constexpr double kOffCentre = 0.4;
// The reader of calibrations has the same limit for files without a unit: rigs of more than 5 m are rare.
constexpr double kLongestBaselineM = 5;
// Shorter than the distance of the lenses of the smallest stereo endoscopes, 4 mm: metres that were scaled as
// millimetres.
constexpr double kShortestBaselineM = 1e-3;

// Principal point over the middle of the image, for x and y of both eyes.
std::array<double, 4> centring(const StereoRig& rig) {
  return {2 * (rig.left.cx_px + 0.5) / rig.left.width_px, 2 * (rig.left.cy_px + 0.5) / rig.left.height_px,
          2 * (rig.right.cx_px + 0.5) / rig.right.width_px, 2 * (rig.right.cy_px + 0.5) / rig.right.height_px};
}

void scale_intrinsics(Camera& camera, double s) {
  camera.fx_px *= s;
  camera.fy_px *= s;
  camera.cx_px = s * (camera.cx_px + 0.5) - 0.5;
  camera.cy_px = s * (camera.cy_px + 0.5) - 0.5;
}

void check_size(Patient& patient, Diagnosis& out) {
  StereoRig& rig = patient.rig;
  const auto centre = centring(rig);
  double worst = 0, low = 1e9, high = 0;
  for (const double c : centre) {
    worst = std::max(worst, std::abs(c - 1));
    low = std::min(low, c);
    high = std::max(high, c);
  }
  const bool stated = patient.calibrated_width_px > 0 && (patient.calibrated_width_px != rig.left.width_px ||
                                                          patient.calibrated_height_px != rig.left.height_px);
  const bool fault = stated || worst > kOffCentre;
  out.checks.push_back({"principal point off the middle", fmt::format("{:.0f} %", 100 * worst),
                        fmt::format("<= {:.0f} %", 100 * kOffCentre), fault ? Verdict::kFault : Verdict::kOk});
  if (patient.calibrated_width_px > 0)
    out.checks.push_back({"size of the images", fmt::format("{} x {}", rig.left.width_px, rig.left.height_px),
                          fmt::format("{} x {}", patient.calibrated_width_px, patient.calibrated_height_px),
                          stated ? Verdict::kFault : Verdict::kOk});
  if (!fault) return;
  // By how much: what the file states, otherwise what brings the principal points to the middle.
  double factor =
      stated ? static_cast<double>(rig.left.width_px) / patient.calibrated_width_px : 1 / std::sqrt(low * high);
  const double rounded = std::exp2(std::round(2 * std::log2(factor)) / 2);
  if (!stated && std::abs(rounded / factor - 1) < 0.2) factor = rounded;  // resolutions differ by 2 or by 1.4
  const bool scaled =
      stated ? std::abs(factor * patient.calibrated_height_px / rig.left.height_px - 1) < 0.02 : high / low < 1.5;
  DoctorFinding finding{"image_size", "", stated ? "certain" : "clear", ""};
  if (scaled) {
    finding.what = fmt::format(
        "The calibration is for images of about {:.0f} x {:.0f} pixels, these have {} x {}: its focal lengths and "
        "principal points are {:.3g} times what they should be.",
        rig.left.width_px / factor, rig.left.height_px / factor, rig.left.width_px, rig.left.height_px, 1 / factor);
    finding.advice = fmt::format(
        "Multiply fx, fy, cx and cy of both cameras (M1 and M2, or K, or P0 and P1) by {:.4g} and state the size of "
        "these images, or use images of the calibrated size. Distortion, R and T stay.",
        factor);
    scale_intrinsics(rig.left, factor);
    scale_intrinsics(rig.right, factor);
  } else {
    finding.certainty = "cannot tell more";
    finding.what = fmt::format(
        "The calibration is for other images: the principal points lie {:.0f} % of half the image off its middle, and "
        "one scale does not explain that.",
        100 * worst);
    finding.advice =
        "Were the images cut out of larger ones? Then subtract the corner of the cut from cx and cy (M1 and M2). "
        "Otherwise calibrate with images as they are recorded.";
  }
  out.findings.push_back(finding);
}

void check_unit(Patient& patient, Diagnosis& out) {
  const double baseline = patient.rig.baseline_m();
  const bool too_long = baseline > kLongestBaselineM, too_short = baseline < kShortestBaselineM;
  out.checks.push_back({"baseline", fmt::format("{:.4g} m", baseline),
                        fmt::format("{:g} .. {:g} m", kShortestBaselineM, kLongestBaselineM),
                        too_long || too_short ? Verdict::kFault : Verdict::kOk});
  if (!too_long && !too_short) return;
  const double factor = too_long ? 1e-3 : 1e3;
  out.findings.push_back(
      {"millimetres",
       fmt::format("The baseline is {:.4g} m. {}, it would be {:.4g} m.", baseline,
                   too_long ? "The calibration is in millimetres and is read as metres: divided by a thousand"
                            : "The calibration is in metres and is read as millimetres: times a thousand",
                   baseline * factor),
       "clear",
       too_long ? "Write 'units: mm' into the calibration, or divide T by 1000 (EuRoC: the last column of T_BS; KITTI: "
                  "the last column of P1)."
                : "Write 'units: m' into the calibration, or multiply T by 1000."});
  patient.rig.T_r_l.translation = factor * patient.rig.T_r_l.translation;
}

}  // namespace

void check_calibration(Patient& patient, Diagnosis& diagnosis) {
  check_size(patient, diagnosis);
  check_unit(patient, diagnosis);
}

}  // namespace accrete::cli
