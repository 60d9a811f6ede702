// Options of live cameras: what is wrong with them whatever brings the images, and what the calibration adds.
#pragma once

#include "accrete/hal/live_source.h"
#include "camera/eyes.h"

namespace accrete::hal::camera {

[[nodiscard]] Outcome check_options(const LiveOptions& options);

// `rig`: empty without a calibration. `eye`: the size that an eye shall have, 0: free. Status: kInvalidArgument where
// the size that is asked for is not the calibration's; those of the file.
[[nodiscard]] Outcome read_calibration(const LiveOptions& options, StereoRig& rig, Size& eye);

}  // namespace accrete::hal::camera
