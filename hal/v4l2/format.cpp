#include "v4l2/format.h"

#include <linux/videodev2.h>

#include "image/image_file.h"

namespace accrete::hal::v4l2 {
namespace {

constexpr KnownFormat kKnown[] = {
    {V4L2_PIX_FMT_RGB24, "RGB3", RawFormat::kRgb3, false},  {V4L2_PIX_FMT_BGR24, "BGR3", RawFormat::kBgr3, false},
    {V4L2_PIX_FMT_YUYV, "YUYV", RawFormat::kYuyv, false},   {V4L2_PIX_FMT_UYVY, "UYVY", RawFormat::kUyvy, false},
    {V4L2_PIX_FMT_NV12, "NV12", RawFormat::kNv12, false},   {V4L2_PIX_FMT_NV12M, "NM12", RawFormat::kNv12, true},
    {V4L2_PIX_FMT_YUV420, "YU12", RawFormat::kYu12, false}, {V4L2_PIX_FMT_YUV420M, "YM12", RawFormat::kYu12, true},
    {V4L2_PIX_FMT_MJPEG, "MJPG", RawFormat::kJpeg, false},  {V4L2_PIX_FMT_JPEG, "JPEG", RawFormat::kJpeg, false},
    {V4L2_PIX_FMT_GREY, "GREY", RawFormat::kGrey, false},   {V4L2_PIX_FMT_Y16, "Y16", RawFormat::kY16, false},
    {V4L2_PIX_FMT_Y12, "Y12", RawFormat::kY12, false},      {V4L2_PIX_FMT_Y10, "Y10", RawFormat::kY10, false},
    {V4L2_PIX_FMT_Y8I, "Y8I", RawFormat::kY8i, false},
};

}  // namespace

std::span<const KnownFormat> known_formats() { return kKnown; }

const KnownFormat* find_format(std::uint32_t fourcc) {
  for (const KnownFormat& format : kKnown)
    if (format.fourcc == fourcc) return &format;
  return nullptr;
}

const KnownFormat* find_format(std::string_view name) {
  while (!name.empty() && name.back() == ' ') name.remove_suffix(1);
  for (const KnownFormat& format : kKnown)
    if (name == format.name) return &format;
  return nullptr;
}

bool understood(const KnownFormat& format) { return format.raw != RawFormat::kJpeg || supported(ImageFormat::kJpeg); }

std::string fourcc_text(std::uint32_t fourcc) {
  std::string text;
  for (int i = 0; i < 4; ++i) {
    const char c = static_cast<char>((fourcc >> (8 * i)) & 0x7f);
    text += c >= ' ' && c <= '~' ? c : '?';
  }
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return (fourcc >> 31) != 0 ? text + "-BE" : text;  // the kernel's mark of a big-endian variant
}

}  // namespace accrete::hal::v4l2
