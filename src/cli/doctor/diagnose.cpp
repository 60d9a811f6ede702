#include <algorithm>

#include "cli/doctor/diagnosis.h"

namespace accrete::cli {

bool Diagnosis::names(const std::string& fault) const {
  return std::any_of(findings.begin(), findings.end(), [&](const DoctorFinding& f) { return f.fault == fault; });
}

void Patient::look_again() {
  view = look(stereo, rig, change);
  evidence = weigh(view);
}

Diagnosis diagnose(Patient& patient) {
  Diagnosis diagnosis;
  for (const Sample& sample : patient.samples->list) patient.stereo.push_back(sample.stereo);
  check_calibration(patient, diagnosis);
  patient.look_again();
  check_geometry(patient, diagnosis);
  check_timing(patient, diagnosis);
  check_exposure(patient, diagnosis);
  check_poses(patient, diagnosis);
  return diagnosis;
}

}  // namespace accrete::cli
