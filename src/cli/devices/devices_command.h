// `accrete devices`: the cameras of this machine, by the names that stay.
#pragma once

#include <string>
#include <vector>

#include "accrete/hal/libcamera.h"
#include "accrete/hal/v4l2.h"
#include "cli/failure.h"

namespace accrete::cli {

struct DevicesOptions {
  bool json = false;
};

ExitStatus devices_command(const DevicesOptions& options);

struct Devices {
  std::vector<hal::V4l2Device> v4l2;
  std::vector<hal::LibcameraCamera> libcamera;
};

// What it prints.
[[nodiscard]] std::string devices_text(const Devices& devices);
[[nodiscard]] std::string devices_json(const Devices& devices);

}  // namespace accrete::cli
