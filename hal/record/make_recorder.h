// The recorder on a disk of the caller's: tests put a slow or a full one there.
#pragma once

#include <memory>

#include "accrete/hal/recorder.h"
#include "record/disk.h"

namespace accrete::hal {

Outcome make_recorder(std::unique_ptr<Disk> disk, const std::filesystem::path& folder, const StereoRig& rig,
                      MotionSource* motion, const RecorderSettings& settings, std::unique_ptr<Recorder>& recorder);

}  // namespace accrete::hal
