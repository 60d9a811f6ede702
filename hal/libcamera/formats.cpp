#include "image/image_file.h"
#include "libcamera/cameras.h"

namespace accrete::hal::libcam {
namespace {

using camera::RawFormat;

// libcamera names packed colours by their place in a little-endian word: RGB888 has blue first in memory.
constexpr KnownFormat kKnown[] = {
    {"BGR888", "RGB3", RawFormat::kRgb3}, {"RGB888", "BGR3", RawFormat::kBgr3}, {"YUYV", "YUYV", RawFormat::kYuyv},
    {"UYVY", "UYVY", RawFormat::kUyvy},   {"NV12", "NV12", RawFormat::kNv12},   {"YUV420", "YU12", RawFormat::kYu12},
    {"MJPEG", "MJPG", RawFormat::kJpeg},  {"R8", "GREY", RawFormat::kGrey},     {"R16", "Y16", RawFormat::kY16},
    {"R12", "Y12", RawFormat::kY12},      {"R10", "Y10", RawFormat::kY10},
};

}  // namespace

std::span<const KnownFormat> known_formats() { return kKnown; }

const KnownFormat* find_format(std::string_view name) {
  for (const KnownFormat& format : kKnown)
    if (name == format.name || name == format.v4l2) return &format;
  return nullptr;
}

bool understood(const KnownFormat& format) { return format.raw != RawFormat::kJpeg || supported(ImageFormat::kJpeg); }

}  // namespace accrete::hal::libcam
