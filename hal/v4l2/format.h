// The pixel formats of V4L2 that are understood, and what is negotiated with a device.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "camera/convert.h"

namespace accrete::hal::v4l2 {

using camera::ColourCode, camera::RawFormat, camera::RawImage, camera::RawPlane;

struct KnownFormat {
  std::uint32_t fourcc;
  const char* name;  // as a person writes it, without blanks at the end
  RawFormat raw;
  bool separate_planes;  // each plane is a buffer of its own (multiplanar devices)
};

// In the order in which one is chosen where nobody asked: colour before grey, no conversion before conversion, no
// compression before compression.
[[nodiscard]] std::span<const KnownFormat> known_formats();
[[nodiscard]] const KnownFormat* find_format(std::uint32_t fourcc);
[[nodiscard]] const KnownFormat* find_format(std::string_view name);
// Whether this build understands it: MJPG needs a JPEG decoder.
[[nodiscard]] bool understood(const KnownFormat& format);
// "YUYV"; bytes that are no letters become '?'.
[[nodiscard]] std::string fourcc_text(std::uint32_t fourcc);

// What a device agreed to.
struct NegotiatedFormat {
  const KnownFormat* known = nullptr;
  int width_px = 0, height_px = 0;
  int buffer_planes = 1;                      // memory planes of one buffer
  std::array<std::size_t, 3> stride_bytes{};  // of each of them
  ColourCode colour;
  double rate_hz = 0;  // 0: the driver does not say
};

}  // namespace accrete::hal::v4l2
