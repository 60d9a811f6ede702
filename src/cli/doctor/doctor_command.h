// accrete doctor: is the stereo rig sane? From a recording, in plain words.
#pragma once

#include "cli/doctor/diagnosis.h"
#include "cli/failure.h"
#include "cli/run/input.h"
#include "cli/run/options.h"

namespace accrete::cli {

struct DoctorOptions {
  RunOptions run;    // how to read the recording, and which part of it
  int samples = 40;  // frames that are looked at
  bool json = false;
};

// Looks at the frames of an input, whatever it comes from. Throws Failure(kInput).
[[nodiscard]] Diagnosis examine(Input& input, const DoctorOptions& options);

// kOk: nothing found. kFault: something is wrong with the rig.
[[nodiscard]] ExitStatus doctor_command(const DoctorOptions& options);

}  // namespace accrete::cli
