#include "v4l2/enumerate.h"

#include <linux/videodev2.h>

#include <algorithm>

#include "text/sentence.h"
#include "v4l2/format.h"

namespace accrete::hal::v4l2 {
namespace {

// Twice what the most talkative driver has (vivid: about 80 formats). A driver that goes on is not believed.
constexpr unsigned kMaxFormats = 160, kMaxSizes = 64, kMaxRates = 32;

std::vector<double> rates_of(Kernel& kernel, int fd, std::uint32_t fourcc, const V4l2Size& size) {
  std::vector<double> rates;
  for (unsigned i = 0; i < kMaxRates; ++i) {
    v4l2_frmivalenum raw{};
    raw.index = i;
    raw.pixel_format = fourcc;
    raw.width = static_cast<std::uint32_t>(size.width_px);
    raw.height = static_cast<std::uint32_t>(size.height_px);
    if (ioctl_retrying(kernel, fd, VIDIOC_ENUM_FRAMEINTERVALS, &raw) < 0) break;
    const bool discrete = raw.type == V4L2_FRMIVAL_TYPE_DISCRETE;
    // The shortest interval is the highest rate.
    const v4l2_fract interval = discrete ? raw.discrete : raw.stepwise.min;
    if (interval.numerator > 0) rates.push_back(static_cast<double>(interval.denominator) / interval.numerator);
    if (!discrete) break;
  }
  std::sort(rates.begin(), rates.end(), std::greater<>());
  return rates;
}

int pixels_of(std::uint32_t value) { return static_cast<int>(std::min<std::uint32_t>(value, 1U << 20)); }

std::vector<V4l2Size> sizes_of(Kernel& kernel, int fd, std::uint32_t fourcc, bool with_rates) {
  std::vector<V4l2Size> sizes;
  for (unsigned i = 0; i < kMaxSizes; ++i) {
    v4l2_frmsizeenum raw{};
    raw.index = i;
    raw.pixel_format = fourcc;
    if (ioctl_retrying(kernel, fd, VIDIOC_ENUM_FRAMESIZES, &raw) < 0) break;
    V4l2Size size;
    const bool discrete = raw.type == V4L2_FRMSIZE_TYPE_DISCRETE;
    size.width_px = pixels_of(discrete ? raw.discrete.width : raw.stepwise.min_width);
    size.height_px = pixels_of(discrete ? raw.discrete.height : raw.stepwise.min_height);
    size.max_width_px = discrete ? size.width_px : pixels_of(raw.stepwise.max_width);
    size.max_height_px = discrete ? size.height_px : pixels_of(raw.stepwise.max_height);
    if (with_rates) size.rates_hz = rates_of(kernel, fd, fourcc, size);
    sizes.push_back(std::move(size));
    if (!discrete) break;
  }
  return sizes;
}

std::string printable(const __u8 (&text)[32]) {
  std::string out;
  for (std::size_t i = 0; i < sizeof text && text[i] != 0; ++i)
    out += text[i] >= ' ' && text[i] <= '~' ? static_cast<char>(text[i]) : '?';
  return out;
}

}  // namespace

std::vector<V4l2Format> enumerate_formats(Kernel& kernel, int fd, bool multiplanar, bool with_rates) {
  std::vector<V4l2Format> formats;
  for (unsigned i = 0; i < kMaxFormats; ++i) {
    v4l2_fmtdesc raw{};
    raw.index = i;
    raw.type = multiplanar ? V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE : V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (ioctl_retrying(kernel, fd, VIDIOC_ENUM_FMT, &raw) < 0) break;
    V4l2Format format;
    format.fourcc = fourcc_text(raw.pixelformat);
    format.description = printable(raw.description);
    const KnownFormat* known = find_format(raw.pixelformat);
    format.understood = known != nullptr && understood(*known);
    format.sizes = sizes_of(kernel, fd, raw.pixelformat, with_rates && format.understood);
    formats.push_back(std::move(format));
  }
  return formats;
}

std::string names_text(const std::vector<V4l2Format>& formats) {
  std::string text;
  for (const V4l2Format& format : formats)
    if (format.understood) text += (text.empty() ? "" : ", ") + format.fourcc;
  return text.empty() ? "none that is understood" : text;
}

std::string sizes_text(const std::vector<V4l2Format>& formats, const std::string& fourcc) {
  std::string text;
  for (const V4l2Format& format : formats) {
    if (format.fourcc != fourcc) continue;
    constexpr std::size_t kMaxShown = 12;
    for (std::size_t i = 0; i < std::min(format.sizes.size(), kMaxShown); ++i) {
      const V4l2Size& size = format.sizes[i];
      text += (text.empty() ? "" : ", ") + size_text(size.width_px, size.height_px);
      if (size.max_width_px != size.width_px || size.max_height_px != size.height_px)
        text += " to " + size_text(size.max_width_px, size.max_height_px);
    }
    if (format.sizes.size() > kMaxShown) text += ", ...";
  }
  return text;
}

StereoLayout likely_layout(const std::vector<V4l2Format>& formats) {
  bool wide = false, high = false, any = false;
  for (const V4l2Format& format : formats) {
    if (format.fourcc == "Y8I") return StereoLayout::kInterleaved;
    for (const V4l2Size& size : format.sizes) {
      if (size.max_width_px != size.width_px) continue;  // a device that scales says nothing
      const double aspect = static_cast<double>(size.width_px) / std::max(size.height_px, 1);
      wide = any ? wide && aspect >= 2.2 : aspect >= 2.2;
      high = any ? high && aspect < 1 : aspect < 1;
      any = true;
    }
  }
  return wide ? StereoLayout::kSideBySide : high ? StereoLayout::kTopBottom : StereoLayout::kTwoDevices;
}

}  // namespace accrete::hal::v4l2
