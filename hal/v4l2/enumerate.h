// What a device says that it can do. Drivers are asked until they say no, but not for ever.
#pragma once

#include <string>
#include <vector>

#include "accrete/hal/v4l2.h"
#include "v4l2/kernel.h"

namespace accrete::hal::v4l2 {

// Empty where the driver does not say. Rates cost a call for each size.
[[nodiscard]] std::vector<V4l2Format> enumerate_formats(Kernel& kernel, int fd, bool multiplanar, bool with_rates);

// "YUYV, MJPG"
[[nodiscard]] std::string names_text(const std::vector<V4l2Format>& formats);
// "320x180, 640x360" of the format `fourcc`, at most twelve of them.
[[nodiscard]] std::string sizes_text(const std::vector<V4l2Format>& formats, const std::string& fourcc);

// The layout that sizes suggest: two images side by side are at least 2.2 times as wide as high (16:9 is 1.78, 21:9 is
// rare among cameras), above each other less than 1. Y8I says it by itself.
[[nodiscard]] StereoLayout likely_layout(const std::vector<V4l2Format>& formats);

}  // namespace accrete::hal::v4l2
