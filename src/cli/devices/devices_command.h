// `accrete devices`: the cameras of this machine, by the names that stay.
#pragma once

#include <string>
#include <vector>

#include "accrete/hal/v4l2.h"
#include "cli/failure.h"

namespace accrete::cli {

struct DevicesOptions {
  bool json = false;
};

ExitStatus devices_command(const DevicesOptions& options);

// What it prints.
[[nodiscard]] std::string devices_text(const std::vector<hal::V4l2Device>& devices);
[[nodiscard]] std::string devices_json(const std::vector<hal::V4l2Device>& devices);

}  // namespace accrete::cli
