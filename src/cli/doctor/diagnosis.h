// What the doctor says: a table of checks, and what is wrong in plain words.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "accrete/camera.h"
#include "accrete/motion.h"
#include "cli/doctor/pose_evidence.h"
#include "cli/doctor/rig_evidence.h"
#include "cli/doctor/samples.h"

namespace accrete::cli {

enum class Verdict { kOk, kFault, kNotChecked };

struct DoctorCheck {
  std::string name;
  std::string measured;
  std::string limit;
  Verdict verdict = Verdict::kOk;
};

struct DoctorFinding {
  std::string fault;      // one word: docs/reference/program.md lists them
  std::string what;       // a sentence
  std::string certainty;  // "certain", "clear", "cannot tell more"
  std::string advice;     // which flag or line of a file to change
};

struct Diagnosis {
  std::vector<DoctorCheck> checks;
  std::vector<DoctorFinding> findings;

  [[nodiscard]] bool sane() const { return findings.empty(); }
  [[nodiscard]] bool names(const std::string& fault) const;
};

// Everything that is known of a rig, and its images. The checks change `rig` and `change` to what they found, so that
// one fault is not reported again by the checks after it.
struct Patient {
  const Samples* samples = nullptr;
  StereoRig rig;
  ImageChange change;
  MotionMode mode = MotionMode::kObjectMoves;
  bool has_poses = false;
  int calibrated_width_px = 0, calibrated_height_px = 0;  // 0: the calibration states none
  double frame_interval_s = 0;                            // 0: unknown

  std::vector<std::vector<Pair>> stereo;  // per sample, in pixels of the images as they lie on disk
  RigView view;                           // of these, under rig and change
  RigEvidence evidence;

  void look_again();  // after rig, change or stereo changed
};

// Each appends its lines to the table and its findings.
void check_calibration(Patient& patient, Diagnosis& diagnosis);  // size, principal point, length of the baseline
void check_geometry(Patient& patient, Diagnosis& diagnosis);     // rows, signs of disparities: the hypotheses
void check_timing(Patient& patient, Diagnosis& diagnosis);       // stamps, and rows that follow the motion
void check_exposure(const Patient& patient, Diagnosis& diagnosis);
void check_poses(Patient& patient, Diagnosis& diagnosis);

// All of them. `patient` has samples, rig, mode and what the recording states.
[[nodiscard]] Diagnosis diagnose(Patient& patient);

}  // namespace accrete::cli
