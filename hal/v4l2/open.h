// open_v4l2() and list_v4l2_devices() with a kernel of the caller's choice.
#pragma once

#include "accrete/hal/v4l2.h"
#include "v4l2/kernel.h"

namespace accrete::hal::v4l2 {

[[nodiscard]] Outcome open(Kernel& kernel, const LiveOptions& options, std::unique_ptr<LiveSource>& source);
[[nodiscard]] std::vector<V4l2Device> list(Kernel& kernel);

}  // namespace accrete::hal::v4l2
