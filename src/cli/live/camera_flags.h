// The flags of live cameras, for every command that opens them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "accrete/hal/libcamera.h"

namespace CLI {
class App;
}

namespace accrete::cli {

class CameraFlags {
 public:
  void add(CLI::App& app);

  // Of "v4l2:LEFT", "v4l2:LEFT,RIGHT" or libcamera's likewise; calibration and rate come from the flags that recordings
  // have, too. Throws Failure(kUsage).
  [[nodiscard]] hal::LibcameraOptions options(const std::string& recording) const;

 private:
  hal::LibcameraOptions plain_;  // what V4L2 does not have is empty there
  std::string size_, layout_, tolerance_, reconnect_;
  std::vector<std::string> controls_;
  bool keep_automatic_ = false;
};

inline constexpr std::string_view kV4l2Prefix = "v4l2:", kLibcameraPrefix = "libcamera:";
// A recording that is none: "v4l2:..." or "libcamera:...".
[[nodiscard]] bool are_cameras(std::string_view recording);

// "640x480". Throws Failure(kUsage).
struct ImageSize {
  int width_px = 0, height_px = 0;
};
[[nodiscard]] ImageSize parse_size(const std::string& flag, const std::string& text);

}  // namespace accrete::cli
