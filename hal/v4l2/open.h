// open_v4l2() and list_v4l2_devices() with a kernel of the caller's choice.
#pragma once

#include "accrete/hal/v4l2.h"
#include "v4l2/kernel.h"

namespace accrete::hal::v4l2 {

[[nodiscard]] Outcome open(Kernel& kernel, const V4l2Options& options, std::unique_ptr<V4l2Source>& source);
[[nodiscard]] std::vector<V4l2Device> list(Kernel& kernel);

}  // namespace accrete::hal::v4l2
