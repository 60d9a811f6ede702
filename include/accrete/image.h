// A borrowed view of one image, as cameras and decoders deliver it: 8 bits a channel, interleaved.
#pragma once

#include <cstddef>
#include <cstdint>

namespace accrete {

enum class PixelFormat : std::uint8_t { kGrey8, kRgb8, kBgr8 };  // the order of the channels in memory

[[nodiscard]] constexpr int channels(PixelFormat format) { return format == PixelFormat::kGrey8 ? 1 : 3; }  // 1 or 3

struct ImageView {
  const std::uint8_t* data = nullptr;
  int width_px = 0;
  int height_px = 0;
  std::ptrdiff_t stride_bytes = 0;  // from one row to the next, at least width_px * channels
  PixelFormat format = PixelFormat::kGrey8;

  [[nodiscard]] const std::uint8_t* row(int y) const { return data + y * stride_bytes; }
  // True when the view can be read at all: data there, size positive, stride wide enough.
  [[nodiscard]] bool valid() const {
    return data != nullptr && width_px > 0 && height_px > 0 &&
           stride_bytes >= static_cast<std::ptrdiff_t>(width_px) * channels(format);
  }
};

}  // namespace accrete
