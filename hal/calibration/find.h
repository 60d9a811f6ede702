// Which calibration belongs to a recording.
#pragma once

#include "calibration/calibration.h"
#include "replay/frame_list.h"

namespace accrete::hal {

// Reads `override_file` where it is not empty, otherwise what stands in the recording. Status: of the readers, and
// kNotFound with the names that were looked for.
Outcome find_calibration(const Layout& layout, const std::filesystem::path& override_file, Calibration& calibration);

}  // namespace accrete::hal
