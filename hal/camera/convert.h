// Images as cameras deliver them, made 8-bit grey or RGB. Pure functions: whatever a driver says about sizes and
// strides is checked against the bytes that are there.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "accrete/image.h"

namespace accrete::hal::camera {

enum class RawFormat : std::uint8_t {
  kGrey,  // 8 bits
  kY10,   // 16 bits, little-endian, the lowest 10 used
  kY12,
  kY16,
  kYuyv,  // Y0 U Y1 V
  kUyvy,  // U Y0 V Y1
  kNv12,  // Y, then U V at half the width and height
  kYu12,  // Y, then U, then V, likewise
  kRgb3,
  kBgr3,
  kY8i,   // left and right grey, pixel by pixel; width_px is that of one eye
  kJpeg,  // MJPG: the first plane holds a file
};

// How Y'CbCr becomes RGB. Cameras say it by quantization and ycbcr_enc.
struct ColourCode {
  bool bt709 = false;       // false: BT.601
  bool full_range = false;  // false: Y' 16 .. 235, Cb and Cr 16 .. 240
};

struct RawPlane {
  std::span<const std::uint8_t> bytes;
  std::size_t stride_bytes = 0;
};

struct RawImage {
  RawFormat format = RawFormat::kGrey;
  int width_px = 0, height_px = 0;
  ColourCode colour;
  std::array<RawPlane, 3> planes;
};

// Planes of formats that have several, and bytes of one row of plane `plane`.
[[nodiscard]] int plane_count(RawFormat format);
[[nodiscard]] std::size_t row_bytes(RawFormat format, int plane, int width_px);
[[nodiscard]] int plane_rows(RawFormat format, int plane, int height_px);

// The planes of an image that lies in one piece, `stride_bytes` being that of the first. Planes that do not fit into
// `bytes` are empty or short: check() says so.
[[nodiscard]] std::array<RawPlane, 3> split_planes(RawFormat format, int width_px, int height_px,
                                                   std::size_t stride_bytes, std::span<const std::uint8_t> bytes);

// Null, or why the image cannot be read without reading beyond its bytes.
[[nodiscard]] const char* check(const RawImage& image);

// What it becomes. JPEG: by its content, kRgb8 here.
[[nodiscard]] PixelFormat converted_format(RawFormat format);
// Whether the bytes are such an image already, so that a view of them will do.
[[nodiscard]] bool is_direct(RawFormat format);
// Precondition: is_direct and check() is null.
[[nodiscard]] ImageView direct_view(const RawImage& image);

// Packed rows of converted_format; kY8i: the left image, then the right one. Half-resolution colour is repeated, not
// interpolated. Not for kJpeg. Preconditions: check() is null, `pixels` holds width * height * channels (kY8i: * 2).
void convert(const RawImage& image, std::uint8_t* pixels);

}  // namespace accrete::hal::camera
