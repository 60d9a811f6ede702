// Images from files into a buffer that the caller owns and uses again: PNG, JPEG, PGM and PPM, as 8-bit grey or RGB.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "accrete/hal/stereo_source.h"
#include "accrete/image.h"

namespace accrete::hal {

// The largest side that the core can be compiled for (limits.h); checked before anything of that size is allocated.
inline constexpr int kMaxImageSide_px = 8192;
// 8192 x 8192 RGB without compression, and some headers.
inline constexpr std::size_t kMaxImageBytes = std::size_t{208} << 20;

enum class ImageFormat : std::uint8_t { kPng, kJpeg, kPnm };

[[nodiscard]] const char* to_string(ImageFormat format);
// Whether this build can decode it (ACCRETE_WITH_PNG, ACCRETE_WITH_JPEG).
[[nodiscard]] bool supported(ImageFormat format);

// What the header says.
struct ImageHeader {
  ImageFormat format = ImageFormat::kPng;
  int width_px = 0;
  int height_px = 0;
  int channels = 0;  // as stored: 1 grey, 2 grey and alpha, 3 RGB or palette, 4 RGB and alpha
  int bits = 0;      // a channel

  [[nodiscard]] PixelFormat decoded_format() const { return channels <= 2 ? PixelFormat::kGrey8 : PixelFormat::kRgb8; }
};

struct ImageBuffer {
  std::vector<std::uint8_t> bytes;
  int width_px = 0;
  int height_px = 0;
  PixelFormat format = PixelFormat::kGrey8;

  [[nodiscard]] ImageView view() const;
};

// Reads headers and images; keeps the file's bytes, so that a replay allocates for its largest image only.
class ImageReader {
 public:
  // Opens `path` and reads the header. Status: those of read_bytes; kUnsupported (another format, or one that was left
  // out of this build), kDataLoss (the header is damaged), kCapacityExceeded (a side above kMaxImageSide_px).
  Outcome open(const std::filesystem::path& path, ImageHeader& header);
  // Decodes the image that was opened last. 16 bits become 8 by rounding (v / 257), alpha is dropped, a palette becomes
  // RGB, fewer than 8 bits are spread over 0..255. kDataLoss when it is truncated or damaged: no half images.
  Outcome decode(ImageBuffer& image);

 private:
  std::filesystem::path path_;
  std::vector<std::uint8_t> file_;
  ImageHeader header_;
};

// The decoders: `reason` says in a few words why it failed, without the file's name. False: damaged or truncated.
using FileBytes = std::span<const std::uint8_t>;
[[nodiscard]] bool read_png_header(FileBytes file, ImageHeader& header, std::string& reason);
[[nodiscard]] bool read_jpeg_header(FileBytes file, ImageHeader& header, std::string& reason);
[[nodiscard]] bool read_pnm_header(FileBytes file, ImageHeader& header, std::string& reason);
// Precondition: the header was read from the same bytes and `pixels` holds width * height * channels of its
// decoded_format().
[[nodiscard]] bool decode_png(FileBytes file, const ImageHeader& header, std::uint8_t* pixels, std::string& reason);
[[nodiscard]] bool decode_jpeg(FileBytes file, const ImageHeader& header, std::uint8_t* pixels, std::string& reason);
// As decode_jpeg, for images as cameras compress them: many add a few bytes before the end of each, which the library
// warns of and which do no harm.
[[nodiscard]] bool decode_camera_jpeg(FileBytes file, const ImageHeader& header, std::uint8_t* pixels,
                                      std::string& reason);
[[nodiscard]] bool decode_pnm(FileBytes file, const ImageHeader& header, std::uint8_t* pixels, std::string& reason);

}  // namespace accrete::hal
