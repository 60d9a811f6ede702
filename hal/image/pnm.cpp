// Netpbm's binary grey (P5) and colour (P6) maps: 8 or 16 bits, the more significant byte first.
#include <cctype>

#include "image/image_file.h"

namespace accrete::hal {
namespace {

struct Header {
  int width = 0, height = 0, maximum = 0;
  std::size_t pixels_at = 0;
};

// Blanks and comments, then a decimal number of at most `limit`.
bool read_number(FileBytes file, std::size_t& at, int limit, int& value) {
  while (at < file.size() && (std::isspace(file[at]) != 0 || file[at] == '#')) {
    if (file[at] == '#')
      while (at < file.size() && file[at] != '\n') ++at;
    else
      ++at;
  }
  const std::size_t begin = at;
  value = 0;
  for (; at < file.size() && std::isdigit(file[at]) != 0; ++at) {
    value = 10 * value + (file[at] - '0');
    if (value > limit) return false;
  }
  return at > begin;
}

bool read(FileBytes file, Header& h, std::string& reason) {
  std::size_t at = 2;
  if (!read_number(file, at, 1'000'000, h.width) || !read_number(file, at, 1'000'000, h.height) || h.width == 0 ||
      h.height == 0) {
    reason = "no width and height in the header";
    return false;
  }
  if (!read_number(file, at, 65535, h.maximum) || h.maximum == 0) {
    reason = "the largest value must lie in 1 .. 65535";
    return false;
  }
  if (at >= file.size() || std::isspace(file[at]) == 0) {  // exactly one blank before the pixels
    reason = "no blank after the header";
    return false;
  }
  h.pixels_at = at + 1;
  return true;
}

}  // namespace

bool read_pnm_header(FileBytes file, ImageHeader& header, std::string& reason) {
  Header h;
  if (!read(file, h, reason)) return false;
  header.width_px = h.width;
  header.height_px = h.height;
  header.channels = file[1] == '6' ? 3 : 1;
  header.bits = h.maximum > 255 ? 16 : 8;
  return true;
}

bool decode_pnm(FileBytes file, const ImageHeader& header, std::uint8_t* pixels, std::string& reason) {
  Header h;
  if (!read(file, h, reason)) return false;
  const std::size_t values = static_cast<std::size_t>(h.width) * h.height * header.channels;
  const std::size_t bytes = values * (header.bits / 8);
  if (file.size() - h.pixels_at < bytes) {
    reason = "truncated: " + std::to_string(file.size() - h.pixels_at) + " of " + std::to_string(bytes) +
             " bytes of pixels are there";
    return false;
  }
  const std::uint8_t* in = file.data() + h.pixels_at;
  const std::uint32_t maximum = h.maximum, half = maximum / 2;
  if (header.bits == 16) {
    for (std::size_t i = 0; i < values; ++i) {
      const std::uint32_t v = std::uint32_t{in[2 * i]} << 8 | in[2 * i + 1];
      pixels[i] = static_cast<std::uint8_t>(v >= maximum ? 255 : (v * 255 + half) / maximum);
    }
  } else {
    for (std::size_t i = 0; i < values; ++i)
      pixels[i] = static_cast<std::uint8_t>(in[i] >= maximum ? 255 : (in[i] * 255U + half) / maximum);
  }
  return true;
}

}  // namespace accrete::hal
