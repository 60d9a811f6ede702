#include <exception>

#include "libcamera/source.h"

namespace accrete::hal {

Outcome open_libcamera(const LibcameraOptions& options, std::unique_ptr<LiveSource>& source) {
  source.reset();
  try {
    auto live = std::make_unique<libcam::Source>(libcam::make_cameras(), options);
    if (Outcome o = live->configure(); !o.ok()) return o;
    source = std::move(live);
    return {};
  } catch (const std::exception& e) {  // out of memory, or a library that plays tricks
    return {Status::kUnavailable, std::string("the cameras cannot be opened: ") + e.what()};
  }
}

std::string libcamera_version() { return libcam::version(); }

std::vector<LibcameraCamera> list_libcamera_cameras() {
  const std::unique_ptr<libcam::Cameras> cameras = libcam::make_cameras();
  if (!cameras->start().ok()) return {};
  std::vector<LibcameraCamera> all = cameras->list();
  cameras->stop();
  return all;
}

}  // namespace accrete::hal
