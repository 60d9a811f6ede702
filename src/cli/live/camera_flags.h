// The flags of live cameras, for every command that opens them.
#pragma once

#include <string>

#include "accrete/hal/v4l2.h"

namespace CLI {
class App;
}

namespace accrete::cli {

class CameraFlags {
 public:
  void add(CLI::App& app);

  // Of "v4l2:LEFT" or "v4l2:LEFT,RIGHT"; calibration and rate come from the flags that recordings have, too. Throws
  // Failure(kUsage).
  [[nodiscard]] hal::LiveOptions options(const std::string& recording) const;

 private:
  hal::LiveOptions plain_;
  std::string size_, layout_, tolerance_, reconnect_;
  bool keep_automatic_ = false;
};

inline constexpr const char* kV4l2Prefix = "v4l2:";

// "640x480". Throws Failure(kUsage).
struct ImageSize {
  int width_px = 0, height_px = 0;
};
[[nodiscard]] ImageSize parse_size(const std::string& flag, const std::string& text);

}  // namespace accrete::cli
