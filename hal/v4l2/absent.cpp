// Stands in for the back-end where there is no V4L2.
#include "accrete/hal/v4l2.h"

namespace accrete::hal {

Outcome open_v4l2(const LiveOptions& /*options*/, std::unique_ptr<LiveSource>& source) {
  source.reset();
  return {Status::kUnsupported, "this build has no V4L2: it needs Linux (and ACCRETE_WITH_V4L2=ON)"};
}

std::vector<V4l2Device> list_v4l2_devices() { return {}; }

}  // namespace accrete::hal
