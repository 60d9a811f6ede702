// Do the images agree with the rig? If not: which single change makes them agree.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/doctor/hypotheses.h"
#include "cli/doctor/lag.h"
#include "cli/doctor/limits.h"
#include "cli/doctor/pose_readings.h"

namespace accrete::cli {
namespace {

bool sound(const RigEvidence& e) {
  return e.score >= kLeastScore && e.median_abs_rows_px <= kMostRowsPx && std::abs(e.median_rows_px) <= kMostOffsetPx &&
         e.negative <= kMostNegative;
}

void tabulate(const Patient& patient, Diagnosis& out) {
  const RigEvidence& e = patient.evidence;
  const auto frames = std::max<std::size_t>(1, patient.samples->list.size());
  const auto line = [&out](const char* name, std::string measured, std::string limit, bool ok) {
    out.checks.push_back({name, std::move(measured), std::move(limit), ok ? Verdict::kOk : Verdict::kFault});
  };
  const double per_frame = static_cast<double>(e.pairs) / static_cast<double>(frames);
  line("points found in both images, a frame", fmt::format("{:.0f}", per_frame), fmt::format(">= {:g}", kFewestPairs),
       per_frame >= kFewestPairs);
  line("of them on their epipolar line, in front", fmt::format("{:.2f}", e.score), fmt::format(">= {:g}", kLeastScore),
       e.score >= kLeastScore);
  line("row difference after rectification",
       fmt::format("{:.2f} px, 90 % below {:.2f} px", e.median_abs_rows_px, e.p90_abs_rows_px),
       fmt::format("<= {:g} px", kMostRowsPx), e.median_abs_rows_px <= kMostRowsPx);
  line("vertical offset", fmt::format("{:+.2f} px", e.median_rows_px), fmt::format("+-{:g} px", kMostOffsetPx),
       std::abs(e.median_rows_px) <= kMostOffsetPx);
  line("negative disparities", fmt::format("{:.1f} %", 100 * e.negative), fmt::format("<= {:g} %", 100 * kMostNegative),
       e.negative <= kMostNegative);
}

// Residual of the given poses when the rig is as the hypothesis says; empty where nothing can be tracked.
std::optional<double> residual_of_poses(const Patient& patient, const Hypothesis& h,
                                        const std::vector<std::vector<Pair>>& stereo) {
  if (!patient.has_poses) return std::nullopt;
  const RigView view = look(stereo, h.rig, h.change);
  const Tracks tracks = track(*patient.samples, view, h.rig, h.change, patient.mode);
  const PoseFit fit = fit_poses(*patient.samples, tracks, h.rig, as_given);
  if (fit.steps < kFewestSteps) return std::nullopt;
  return fit.residual_px;
}

// Lenses bend both images almost alike: what is wrong with them hides in rows that agree, but not as well as they
// could.
void check_lens(Patient& patient, Diagnosis& out) {
  const RigEvidence& given = patient.evidence;
  Hypothesis best;
  for (Hypothesis& h : lens_hypotheses(patient.rig, patient.stereo)) {
    h.evidence = weigh(look(patient.stereo, h.rig, h.change));
    // The simpler ones come first: a fitted number must explain more.
    if (h.evidence.score > best.evidence.score + (best.fault.empty() ? 0 : 0.5 * kSameScore)) best = std::move(h);
  }
  const RigEvidence& other = best.evidence;
  const bool wrong = other.score >= given.score + kBetterLensScore &&
                     other.median_abs_rows_px <= kBetterLensRows * given.median_abs_rows_px;
  out.checks.push_back({"the same with another lens distortion",
                        fmt::format("{:.2f} px, score {:.2f}", other.median_abs_rows_px, other.score),
                        fmt::format("> {:.2f} px or < {:.2f}", kBetterLensRows * given.median_abs_rows_px,
                                    given.score + kBetterLensScore),
                        wrong ? Verdict::kFault : Verdict::kOk});
  if (!wrong) return;
  out.findings.push_back({best.fault,
                          fmt::format("{} Rows then differ by {:.2f} px instead of {:.2f} px.", best.what,
                                      other.median_abs_rows_px, given.median_abs_rows_px),
                          "clear", best.advice});
  patient.rig = best.rig;
  patient.look_again();
}

struct Search {
  Patient& patient;
  Diagnosis& out;
  std::vector<Hypothesis> list;
  std::vector<std::vector<Pair>> mirrored[2][2];  // by columns, rows; made when needed

  const std::vector<std::vector<Pair>>& pairs_for(const ImageChange& change) {
    if (!change.relative_columns() && !change.relative_rows()) return patient.stereo;
    auto& pairs = mirrored[change.relative_columns() ? 1 : 0][change.relative_rows() ? 1 : 0];
    if (pairs.empty()) pairs = pair_mirrored(*patient.samples, change.relative_columns(), change.relative_rows());
    return pairs;
  }

  void run() {
    list = image_hypotheses(patient.rig);
    for (Hypothesis& h : rig_hypotheses(patient.rig, patient.view, patient.stereo)) list.push_back(std::move(h));
    // Pairs are found anew in mirrored images only while nothing else explains the evidence.
    for (const auto& [columns, rows] :
         {std::pair{false, false}, std::pair{true, false}, std::pair{true, true}, std::pair{false, true}}) {
      std::vector<Hypothesis*> here;
      for (Hypothesis& h : list)
        if (h.change.relative_columns() == columns && h.change.relative_rows() == rows) here.push_back(&h);
      if (try_these(here)) return;
    }
    unknown();
  }

  // False: none of them explains it.
  bool try_these(const std::vector<Hypothesis*>& some) {
    const double frames = static_cast<double>(patient.samples->list.size());
    double best = 0;
    for (Hypothesis* h : some) {
      h->evidence = weigh(look(pairs_for(h->change), h->rig, h->change));
      if (usable(*h, frames)) best = std::max(best, h->evidence.score);
    }
    std::vector<const Hypothesis*> equal;
    // What has a fitted number must explain more; what explains as much without one is preferred.
    for (const bool fitted : {false, true})
      if (equal.empty())
        for (const Hypothesis* h : some)
          if (usable(*h, frames) && h->fitted == fitted && h->evidence.score >= best - kSameScore) equal.push_back(h);
    if (equal.empty()) return false;
    prefer(equal);
    accept(*equal.front(), equal);
    return true;
  }

  [[nodiscard]] bool usable(const Hypothesis& h, double frames) const {
    return sound(h.evidence) && static_cast<double>(h.evidence.pairs) >= kFewestPairs * frames &&
           h.evidence.score >= patient.evidence.score + kClearlyBetter;
  }

  // Where images and rig cannot tell them apart, the given poses may.
  void prefer(std::vector<const Hypothesis*>& equal) {
    if (equal.size() < 2) return;
    std::vector<std::pair<double, const Hypothesis*>> by_residual;
    for (const Hypothesis* h : equal) {
      const auto residual = residual_of_poses(patient, *h, pairs_for(h->change));
      if (!residual) return order_by_plausibility(equal);
      by_residual.emplace_back(*residual, h);
    }
    const double least = std::min_element(by_residual.begin(), by_residual.end())->first;
    equal.clear();
    for (const auto& [residual, h] : by_residual)
      if (least > kMostPoseResidualPx || residual <= std::max(2 * least, 0.5)) equal.push_back(h);
    order_by_plausibility(equal);
  }

  // A file with a negative baseline is the fault itself; otherwise the images are more often confused than the file.
  void order_by_plausibility(std::vector<const Hypothesis*>& equal) const {
    const bool negative = patient.rig.T_r_l.inverse().translation[0] < 0;
    std::stable_sort(equal.begin(), equal.end(), [negative](const Hypothesis* a, const Hypothesis* b) {
      const auto rank = [negative](const Hypothesis& h) { return negative == h.change.none() ? 0 : 1; };
      return rank(*a) < rank(*b);
    });
  }

  void accept(const Hypothesis& h, const std::vector<const Hypothesis*>& equal) {
    DoctorFinding finding{h.fault, h.what, "clear", h.advice};
    finding.what += fmt::format(" With that undone, {:.0f} % of the points lie on their lines instead of {:.0f} %{}.",
                                100 * h.evidence.on_line * (1 - h.evidence.negative),
                                100 * patient.evidence.on_line * (1 - patient.evidence.negative),
                                h.fitted ? " (one number was fitted)" : "");
    std::string others;
    for (const Hypothesis* other : equal)
      if (other != &h) others += fmt::format("{}{} ({})", others.empty() ? "" : "; ", other->fault, other->what);
    if (!others.empty()) {
      finding.certainty = "one of several";
      finding.advice += " Or, the same to images and rig: " + others;
    }
    out.findings.push_back(std::move(finding));
    if (h.change.relative_columns() || h.change.relative_rows()) patient.stereo = pairs_for(h.change);
    patient.rig = h.rig;
    patient.change = h.change;
    patient.look_again();
  }

  void unknown() {
    const RigEvidence& e = patient.evidence;
    if (static_cast<double>(e.pairs) < kFewestPairs * static_cast<double>(patient.samples->list.size())) {
      out.findings.push_back(
          {"too_few_points",
           fmt::format("Left and right image have hardly anything in common: {:.1f} points a frame are found in both.",
                       static_cast<double>(e.pairs) / static_cast<double>(patient.samples->list.size())),
           "cannot tell more",
           "Do both cameras see the same scene, in focus, neither dark nor overexposed, and in one orientation? Is "
           "there texture? Are the images of one recording?"});
      return;
    }
    out.findings.push_back(
        {"rig_unknown",
         fmt::format("Images and calibration do not agree (score {:.2f}, rows differ by {:.2f} px, {:.0f} % of the "
                     "disparities are negative), and none of the known faults alone explains it.",
                     e.score, e.median_abs_rows_px, 100 * e.negative),
         "cannot tell more",
         "Is the calibration of these cameras, at this resolution and focus? Calibrate again if in doubt."});
  }
};

}  // namespace

void check_geometry(Patient& patient, Diagnosis& diagnosis) {
  tabulate(patient, diagnosis);
  const bool enough =
      static_cast<double>(patient.evidence.pairs) >= kFewestPairs * static_cast<double>(patient.samples->list.size());
  if (enough && sound(patient.evidence)) {
    check_lens(patient, diagnosis);
    // Images and file agree, and the file says that the left camera is on the right.
    if (patient.rig.T_r_l.inverse().translation[0] < 0)
      diagnosis.findings.push_back(
          {"swapped_eyes",
           "Left and right are exchanged in the images and in the calibration alike: the camera that is called left "
           "is on the right.",
           "clear",
           "Exchange the two folders of images, exchange M1 with M2 and D1 with D2, and write R transposed for R and "
           "-R^T T for T. Poses of the left camera are then those of the right one (--pose-frame right)."});
    return;
  }
  // One eye late: rows that follow the motion are no fault of the geometry.
  if (enough && patient.evidence.negative <= kMostNegative && lag_of(patient).clear()) return;
  Search{patient, diagnosis, {}, {}}.run();
}

}  // namespace accrete::cli
