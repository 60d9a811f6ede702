// The number of a frame and its eye, written into its pixels: whatever way an image takes, it tells where it comes
// from.
#pragma once

#include <cstdint>
#include <optional>

#include "accrete/image.h"

namespace accrete::vm {

// 12 bits of number, one of eye, and all of them inverted, as squares of 8 pixels along the upper border: solid squares
// of this size survive JPEG, too. Images are at least 26 * 8 pixels wide.
inline constexpr int kSquare_px = 8, kNumberBits = 12, kBits = kNumberBits + 1;
inline constexpr int kStrip_px = 2 * kBits * kSquare_px;

struct FrameNumber {
  int number = 0;
  bool right = false;

  friend bool operator==(const FrameNumber&, const FrameNumber&) = default;
};

// `pixels` has `channels` bytes a pixel and no gaps between its rows.
inline void stamp(FrameNumber frame, std::uint8_t* pixels, int width_px, int channels) {
  const int word = frame.number | (frame.right ? 1 << kNumberBits : 0);
  for (int y = 0; y < kSquare_px; ++y)
    for (int x = 0; x < kStrip_px; ++x) {
      const int bit = x / kSquare_px;
      const bool set = ((word >> (bit % kBits)) & 1) != (bit < kBits ? 0 : 1);
      for (int c = 0; c < channels; ++c) pixels[(y * width_px + x) * channels + c] = set ? 224 : 32;
    }
}

// Nothing: these pixels carry no number (or half of one).
inline std::optional<FrameNumber> read_number(const ImageView& image) {
  if (!image.valid() || image.width_px < kStrip_px || image.height_px < kSquare_px) return std::nullopt;
  int word = 0, inverse = 0;
  for (int bit = 0; bit < 2 * kBits; ++bit) {
    const int x = bit * kSquare_px + kSquare_px / 2;
    const bool set = image.row(kSquare_px / 2)[x * channels(image.format)] >= 128;
    (bit < kBits ? word : inverse) |= (set ? 1 : 0) << (bit % kBits);
  }
  if ((word ^ inverse) != (1 << kBits) - 1) return std::nullopt;
  return FrameNumber{word & ((1 << kNumberBits) - 1), word >> kNumberBits != 0};
}

}  // namespace accrete::vm
