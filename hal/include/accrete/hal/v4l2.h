// Cameras by V4L2 (Linux): two, or one that delivers both images in one buffer.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "accrete/hal/live_source.h"

namespace accrete::hal {

// A camera is named by its node (/dev/video0, or 0), by a link or a link's name in /dev/v4l/by-id or /dev/v4l/by-path,
// or by its bus or its card as V4l2Device has them where only one device has it.
// On success `source` is configured: call start() next. On failure it is null. kUnsupported where there is no V4L2.
[[nodiscard]] Outcome open_v4l2(const LiveOptions& options, std::unique_ptr<LiveSource>& source);

struct V4l2Size {
  int width_px = 0, height_px = 0;
  int max_width_px = 0, max_height_px = 0;  // of a device that scales; otherwise the same
  std::vector<double> rates_hz;             // highest first; empty: the driver does not say
};

struct V4l2Format {
  std::string fourcc;
  std::string description;
  bool understood = false;  // by this build
  std::vector<V4l2Size> sizes;
};

struct V4l2Device {
  std::string node;  // /dev/video0
  std::string id;    // name in /dev/v4l/by-id, else in /dev/v4l/by-path, else empty
  std::string card, driver, bus;
  std::vector<V4l2Format> formats;
  std::string problem;  // why it could not be asked, otherwise empty
  // The layout that its sizes suggest: two images wide (or high) is no single camera.
  StereoLayout likely_layout = StereoLayout::kTwoDevices;
};

// The nodes that capture video, in the order of their numbers; those that only carry metadata are left out. Empty where
// there is no V4L2.
[[nodiscard]] std::vector<V4l2Device> list_v4l2_devices();

}  // namespace accrete::hal
