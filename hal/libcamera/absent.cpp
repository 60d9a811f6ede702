// Stands in for the back-end where there is no libcamera.
#include "accrete/hal/libcamera.h"

namespace accrete::hal {

Outcome open_libcamera(const LibcameraOptions& /*options*/, std::unique_ptr<LiveSource>& source) {
  source.reset();
  return {Status::kUnsupported,
          "this build has no libcamera: install libcamera-dev (0.0.3 or newer) and build again with "
          "-DACCRETE_WITH_LIBCAMERA=ON"};
}

std::string libcamera_version() { return {}; }
std::vector<LibcameraCamera> list_libcamera_cameras() { return {}; }

}  // namespace accrete::hal
