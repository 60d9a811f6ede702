// Ways to misread poses, each as the reading that undoes it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/doctor/diagnosis.h"

namespace accrete::cli {

struct NamedReading {
  std::string fault;
  std::string what, advice;
  PoseReading reading;
};

[[nodiscard]] std::optional<PoseStep> as_given(const Sample& first, const Sample& second);
[[nodiscard]] std::vector<NamedReading> pose_readings(const Patient& patient);

}  // namespace accrete::cli
