#include "v4l2/negotiate.h"

#include <linux/videodev2.h>

#include <cerrno>
#include <cmath>

#include "image/image_file.h"
#include "text/sentence.h"
#include "v4l2/enumerate.h"

namespace accrete::hal::v4l2 {
namespace {

// The two forms of v4l2_format in one.
struct Settings {
  std::uint32_t width = 0, height = 0, fourcc = 0, field = 0, colourspace = 0, encoding = 0, quantization = 0;
  unsigned planes = 1;
  std::array<std::uint32_t, 3> stride{};
};

Settings settings_of(const v4l2_format& raw, bool multiplanar) {
  Settings s;
  if (multiplanar) {
    const v4l2_pix_format_mplane& pix = raw.fmt.pix_mp;
    s = {pix.width, pix.height, pix.pixelformat, pix.field, pix.colorspace, pix.ycbcr_enc, pix.quantization, {}, {}};
    s.planes = pix.num_planes;
    for (std::size_t i = 0; i < s.stride.size() && i < pix.num_planes; ++i) s.stride[i] = pix.plane_fmt[i].bytesperline;
  } else {
    const v4l2_pix_format& pix = raw.fmt.pix;
    s = {pix.width, pix.height, pix.pixelformat, pix.field, pix.colorspace, pix.ycbcr_enc, pix.quantization, 1, {}};
    s.stride[0] = pix.bytesperline;
  }
  return s;
}

void apply(const FormatRequest& request, bool multiplanar, v4l2_format& raw) {
  const auto set = [&request](auto& pix) {
    if (request.width_px > 0) pix.width = static_cast<std::uint32_t>(request.width_px);
    if (request.height_px > 0) pix.height = static_cast<std::uint32_t>(request.height_px);
    if (request.known != nullptr) pix.pixelformat = request.known->fourcc;
    pix.field = V4L2_FIELD_NONE;
  };
  if (multiplanar) {
    set(raw.fmt.pix_mp);
    for (auto& plane : raw.fmt.pix_mp.plane_fmt) plane.bytesperline = 0;
  } else {
    set(raw.fmt.pix);
    raw.fmt.pix.bytesperline = 0;  // the driver's choice
  }
}

// What a device answers where it declares nothing, by the kernel's own rules.
ColourCode colour_of(const Settings& s) {
  std::uint32_t encoding = s.encoding, quantization = s.quantization;
  if (encoding == V4L2_YCBCR_ENC_DEFAULT) encoding = V4L2_MAP_YCBCR_ENC_DEFAULT(s.colourspace);
  if (quantization == V4L2_QUANTIZATION_DEFAULT)
    quantization = V4L2_MAP_QUANTIZATION_DEFAULT(false, s.colourspace, encoding);
  return {encoding == V4L2_YCBCR_ENC_709 || encoding == V4L2_YCBCR_ENC_XV709,
          quantization == V4L2_QUANTIZATION_FULL_RANGE};
}

Outcome unlike(Kernel& kernel, int fd, bool multiplanar, const std::string& who, const FormatRequest& request,
               const Settings& got) {
  const std::vector<V4l2Format> formats = enumerate_formats(kernel, fd, multiplanar, false);
  const std::string got_name = fourcc_text(got.fourcc);
  const std::string wanted_name = request.known != nullptr ? request.known->name : got_name;
  std::string text =
      who + " gives " + size_text(static_cast<int>(got.width & 0x7fffffff), static_cast<int>(got.height & 0x7fffffff)) +
      " " + got_name + " instead of " + size_text(request.width_px, request.height_px) + " " + wanted_name + "; ";
  if (got_name != wanted_name || formats.empty())
    text += "its formats are " + names_text(formats);
  else
    text += "its sizes in " + wanted_name + " are " + sizes_text(formats, wanted_name);
  return {Status::kUnsupported, text};
}

Outcome examine(const std::string& who, const Settings& s, NegotiatedFormat& format) {
  const auto refuse = [&who](const std::string& why) -> Outcome { return {Status::kUnsupported, who + " " + why}; };
  format.known = find_format(s.fourcc);
  if (format.known == nullptr || !understood(*format.known))
    return refuse("delivers " + fourcc_text(s.fourcc) +
                  ", which this build does not understand: choose another format");
  if (s.field != V4L2_FIELD_NONE && s.field != V4L2_FIELD_ANY)
    return refuse("delivers interlaced images, whose lines are of two moments: choose a progressive mode");
  if (s.width < 1 || s.height < 1 || s.width > 2U * kMaxImageSide_px || s.height > 2U * kMaxImageSide_px)
    return {Status::kCapacityExceeded, who + " delivers " + std::to_string(s.width) + "x" + std::to_string(s.height) +
                                           " pixels, an eye may have " + size_text(kMaxImageSide_px, kMaxImageSide_px)};
  format.width_px = static_cast<int>(s.width);
  format.height_px = static_cast<int>(s.height);
  const unsigned expected = format.known->separate_planes ? static_cast<unsigned>(plane_count(format.known->raw)) : 1;
  if (s.planes != expected)
    return refuse("delivers " + fourcc_text(s.fourcc) + " in " + count(s.planes, "plane") + " instead of " +
                  std::to_string(expected));
  format.buffer_planes = static_cast<int>(expected);
  for (std::size_t i = 0; i < expected; ++i) {
    const std::size_t row = row_bytes(format.known->raw, static_cast<int>(i), format.width_px);
    format.stride_bytes[i] = s.stride[i] == 0 || format.known->raw == RawFormat::kJpeg ? row : s.stride[i];
    if (format.stride_bytes[i] < row)
      return refuse("says that a row has " + count(s.stride[i], "byte") +
                    ", fewer than its pixels need: its driver "
                    "is broken in this format, choose another one");
  }
  format.colour = colour_of(s);
  return {};
}

// Never fails: what a driver makes of it is read back and reported.
void set_rate(Kernel& kernel, int fd, std::uint32_t type, const std::string& who, double wanted_hz,
              NegotiatedFormat& format, std::vector<std::string>& notices) {
  v4l2_streamparm raw{};
  raw.type = type;
  v4l2_fract& interval = raw.parm.capture.timeperframe;
  if (wanted_hz > 0) {
    // 29.97 Hz needs thousandths; whole rates are written as drivers have them in their tables.
    const bool whole = std::abs(wanted_hz - std::round(wanted_hz)) < 1e-9;
    interval.numerator = whole ? 1 : 1000;
    interval.denominator = static_cast<std::uint32_t>(std::round(wanted_hz * (whole ? 1 : 1000)));
  }
  const unsigned long request = wanted_hz > 0 ? VIDIOC_S_PARM : VIDIOC_G_PARM;
  if (ioctl_retrying(kernel, fd, request, &raw) < 0 || interval.numerator == 0 || interval.denominator == 0) {
    if (wanted_hz > 0) notices.push_back(who + " lets no rate be set: it delivers at its own");
    return;
  }
  format.rate_hz = static_cast<double>(interval.denominator) / interval.numerator;
  if (wanted_hz > 0 && std::abs(format.rate_hz - wanted_hz) > 0.01 * wanted_hz)
    notices.push_back(who + " delivers " + number(format.rate_hz, 4) + " Hz instead of " + number(wanted_hz, 4) +
                      ": another format or size may be faster (accrete devices)");
}

}  // namespace

Status status_of(int error) {
  switch (error) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return Status::kNotFound;
    case EINVAL:
    case ENOTTY:
    case EOPNOTSUPP:
      return Status::kUnsupported;
    default:
      return Status::kUnavailable;
  }
}

Outcome negotiate(Kernel& kernel, int fd, const Capability& capability, const std::string& who,
                  const FormatRequest& request, NegotiatedFormat& format, std::vector<std::string>& notices) {
  const auto failed = [&who](const char* what) -> Outcome {
    const int error = errno;
    return {status_of(error), who + ": its format cannot be " + what + ": " + error_text(error)};
  };
  format = {};
  v4l2_format raw{};
  raw.type = capability.multiplanar ? V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE : V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (ioctl_retrying(kernel, fd, VIDIOC_G_FMT, &raw) < 0) return failed("read");
  apply(request, capability.multiplanar, raw);
  if (ioctl_retrying(kernel, fd, VIDIOC_S_FMT, &raw) < 0) return failed("set");
  const Settings got = settings_of(raw, capability.multiplanar);
  if ((request.known != nullptr && got.fourcc != request.known->fourcc) ||
      (request.width_px > 0 && got.width != static_cast<std::uint32_t>(request.width_px)) ||
      (request.height_px > 0 && got.height != static_cast<std::uint32_t>(request.height_px)))
    return unlike(kernel, fd, capability.multiplanar, who, request, got);
  if (Outcome o = examine(who, got, format); !o.ok()) return o;
  set_rate(kernel, fd, raw.type, who, request.rate_hz, format, notices);
  return {};
}

}  // namespace accrete::hal::v4l2
