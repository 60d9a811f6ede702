#include "cli/doctor/doctor_command.h"

#include <fmt/format.h>

#include "cli/doctor/doctor_report.h"
#include "cli/run/interrupt.h"
#include "cli/text/json_text.h"
#include "cli/text/print.h"

namespace accrete::cli {
namespace {

double frame_interval_s(const Samples& samples) {
  for (std::size_t i = 0; i + 1 < samples.list.size(); ++i)
    if (samples.list[i].has_next) return to_seconds(samples.list[i + 1].t_left - samples.list[i].t_left);
  return 0;
}

}  // namespace

Diagnosis examine(Input& input, const DoctorOptions& options) {
  const Samples samples = take_samples(*input.source, input.motion.get(), options.run.frames,
                                       static_cast<std::uint64_t>(options.samples), interrupted);
  if (samples.list.empty())
    throw Failure(ExitStatus::kInput,
                  "no frame of this recording can be looked at: " +
                      (samples.why_unreadable.empty() ? "none lies in the range that was asked for"
                                                      : "none is readable; the first one: " + samples.why_unreadable));
  Patient patient;
  patient.samples = &samples;
  patient.rig = input.source->rig();
  patient.mode = input.mode;
  patient.has_poses = input.motion != nullptr;
  if (input.info) {
    patient.calibrated_width_px = input.info->calibrated_width_px;
    patient.calibrated_height_px = input.info->calibrated_height_px;
  }
  patient.frame_interval_s = frame_interval_s(samples);
  return diagnose(patient);
}

ExitStatus doctor_command(const DoctorOptions& given) {
  DoctorOptions options = given;
  options.run.input.require_poses = !options.run.input.poses.empty();
  options.run.input.require_sane_rig = false;
  Input input = open_input(options.run);
  if (!options.json)
    for (const std::string& line : describe(input)) print("{}\n", line);
  flush_output();
  for (const std::string& warning : input.warnings) print_error("warning: {}\n", warning);
  const Diagnosis diagnosis = examine(input, options);
  if (interrupted()) return ExitStatus::kInterrupted;
  if (options.json) {
    print("{}", json_text(to_json(diagnosis)));
  } else {
    print("\n{}", to_text(diagnosis));
  }
  return diagnosis.sane() ? ExitStatus::kOk : ExitStatus::kFault;
}

}  // namespace accrete::cli
