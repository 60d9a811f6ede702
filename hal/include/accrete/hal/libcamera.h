// Cameras by libcamera (0.0.3 and newer): two that are paired by the time of their exposure, or one that delivers both
// images. What a Raspberry Pi and other boards with camera connectors need.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "accrete/hal/live_source.h"

namespace accrete::hal {

// A control by libcamera's name for it: {"ExposureTime", "8000"}, {"AeEnable", "false"}, {"ColourGains", "1.8,1.5"}.
struct LibcameraControl {
  std::string name, value;
};

struct LibcameraOptions : LiveOptions {
  // Set in both cameras, from the first image on. What is named here is not locked after the warm-up.
  std::vector<LibcameraControl> controls;
};

// A camera is named by its id, by its model where only one has it, or by its number in list_libcamera_cameras().
// `format` takes libcamera's names and those of V4L2 (R8 or GREY); kInterleaved is kUnsupported.
// On success `source` is configured: call start() next. On failure it is null. kUnsupported where this build has no
// libcamera. libcamera allows one camera manager in a process: sources share it.
[[nodiscard]] Outcome open_libcamera(const LibcameraOptions& options, std::unique_ptr<LiveSource>& source);

struct LibcameraFormat {
  std::string name;                // libcamera's
  bool understood = false;         // by this build
  std::vector<std::string> sizes;  // "640x480"
};

struct LibcameraCamera {
  std::string id, model;
  std::vector<LibcameraFormat> formats;
  std::vector<std::string> controls;  // "ExposureTime [100..66000]"
  std::string problem;                // why it could not be asked, otherwise empty
};

// Of this build, empty: none. "0.0.3"
[[nodiscard]] std::string libcamera_version();
// Cameras in libcamera's order. Empty where there are none, or no libcamera.
[[nodiscard]] std::vector<LibcameraCamera> list_libcamera_cameras();

}  // namespace accrete::hal
