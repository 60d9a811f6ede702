#include "image/image_file.h"

#include <algorithm>

#include "text/file.h"
#include "text/sentence.h"

namespace accrete::hal {
namespace {

bool begins_with(FileBytes file, std::span<const std::uint8_t> magic) {
  return file.size() >= magic.size() && std::equal(magic.begin(), magic.end(), file.begin());
}

// By the first bytes, not by the name. False: none of ours.
bool recognise(FileBytes file, ImageFormat& format) {
  static constexpr std::uint8_t kPng[] = {0x89, 'P', 'N', 'G'}, kJpeg[] = {0xff, 0xd8, 0xff};
  static constexpr std::uint8_t kGrey[] = {'P', '5'}, kRgb[] = {'P', '6'};
  if (begins_with(file, kPng)) {
    format = ImageFormat::kPng;
  } else if (begins_with(file, kJpeg)) {
    format = ImageFormat::kJpeg;
  } else if (begins_with(file, kGrey) || begins_with(file, kRgb)) {
    format = ImageFormat::kPnm;
  } else {
    return false;
  }
  return true;
}

Outcome damaged(const std::filesystem::path& path, ImageFormat format, const std::string& reason) {
  return {Status::kDataLoss,
          path.string() + ": damaged " + to_string(format) + " (" + reason + "): copy it again from the source"};
}

}  // namespace

const char* to_string(ImageFormat format) {
  switch (format) {
    case ImageFormat::kPng:
      return "PNG";
    case ImageFormat::kJpeg:
      return "JPEG";
    case ImageFormat::kPnm:
      return "PGM/PPM";
  }
  return "image";
}

bool supported(ImageFormat format) {
  switch (format) {
    case ImageFormat::kPng:
      return ACCRETE_HAS_PNG != 0;
    case ImageFormat::kJpeg:
      return ACCRETE_HAS_JPEG != 0;
    case ImageFormat::kPnm:
      return true;
  }
  return false;
}

ImageView ImageBuffer::view() const {
  return {bytes.data(), width_px, height_px, static_cast<std::ptrdiff_t>(width_px) * channels(format), format};
}

Outcome ImageReader::open(const std::filesystem::path& path, ImageHeader& header) {
  path_ = path;
  header_ = {};
  if (Outcome o = read_bytes(path, kMaxImageBytes, file_); !o.ok()) return o;
  ImageFormat format{};
  if (!recognise(file_, format))
    return {Status::kUnsupported, path.string() + " is no PNG, JPEG, PGM (P5) or PPM (P6) image: convert it to one"};
  if (!supported(format))
    return {Status::kUnsupported, path.string() + " is a " + to_string(format) +
                                      ", which this build leaves out: configure with -DACCRETE_WITH_" +
                                      to_string(format) + "=ON, or convert it to PGM or PPM"};
  std::string reason;
  header = {};
  const bool ok = format == ImageFormat::kPng    ? read_png_header(file_, header, reason)
                  : format == ImageFormat::kJpeg ? read_jpeg_header(file_, header, reason)
                                                 : read_pnm_header(file_, header, reason);
  header.format = format;
  if (!ok) return damaged(path, format, reason);
  if (header.width_px > kMaxImageSide_px || header.height_px > kMaxImageSide_px)
    return {Status::kCapacityExceeded, path.string() + " has " + size_text(header.width_px, header.height_px) +
                                           " pixels; at most " + size_text(kMaxImageSide_px, kMaxImageSide_px) +
                                           " are read: scale it down"};
  header_ = header;
  return {};
}

Outcome ImageReader::decode(ImageBuffer& image) {
  if (header_.width_px == 0) return {Status::kUnavailable, "no image is open: call open() before decode()"};
  image.width_px = header_.width_px;
  image.height_px = header_.height_px;
  image.format = header_.decoded_format();
  image.bytes.resize(static_cast<std::size_t>(image.width_px) * image.height_px * channels(image.format));
  std::string reason;
  const bool ok = header_.format == ImageFormat::kPng    ? decode_png(file_, header_, image.bytes.data(), reason)
                  : header_.format == ImageFormat::kJpeg ? decode_jpeg(file_, header_, image.bytes.data(), reason)
                                                         : decode_pnm(file_, header_, image.bytes.data(), reason);
  return ok ? Outcome{} : damaged(path_, header_.format, reason);
}

}  // namespace accrete::hal
