#include "camera/eyes.h"

#include "text/sentence.h"

namespace accrete::hal::camera {
namespace {

int columns(StereoLayout layout) {
  return layout == StereoLayout::kSideBySide || layout == StereoLayout::kSideBySideSwapped ? 2 : 1;
}
int rows(StereoLayout layout) { return layout == StereoLayout::kTopBottom ? 2 : 1; }

void resize(ImageBuffer& buffer, int width, int height, PixelFormat format) {
  buffer.width_px = width;
  buffer.height_px = height;
  buffer.format = format;
  buffer.bytes.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                      static_cast<std::size_t>(channels(format)));
}

}  // namespace

std::span<const Eye> eyes_of(StereoLayout layout) {
  static constexpr Eye kBoth[] = {Eye::kLeft, Eye::kRight};
  return std::span(kBoth, layout == StereoLayout::kTwoDevices ? 2 : 1);
}

Size buffer_size(StereoLayout layout, Size eye) {
  return {eye.width_px * columns(layout), eye.height_px * rows(layout)};
}

bool eye_size(StereoLayout layout, Size buffer, Size& eye) {
  eye = {buffer.width_px / columns(layout), buffer.height_px / rows(layout)};
  return buffer.width_px % columns(layout) == 0 && buffer.height_px % rows(layout) == 0 && eye.width_px > 0 &&
         eye.height_px > 0;
}

void split(StereoLayout layout, const ImageView& whole, ImageView& left, ImageView& right) {
  left = right = whole;
  left.width_px = right.width_px = whole.width_px / columns(layout);
  left.height_px = right.height_px = whole.height_px / rows(layout);
  if (layout == StereoLayout::kTopBottom)
    right.data = whole.row(right.height_px);
  else
    right.data += static_cast<std::ptrdiff_t>(right.width_px) * channels(whole.format);
  if (layout == StereoLayout::kSideBySideSwapped) std::swap(left, right);
}

Eyes::Made Eyes::view(const RawImage& raw, ImageBuffer& buffer, ImageView& image) {
  if (const char* wrong = check(raw)) {
    reason_ = wrong;
    return Made::kDamaged;
  }
  if (is_direct(raw.format)) {
    image = direct_view(raw);
    return Made::kViews;
  }
  if (raw.format == RawFormat::kJpeg) {
    ImageHeader header;
    const FileBytes file = raw.planes[0].bytes;
    if (!read_jpeg_header(file, header, reason_)) return Made::kDamaged;
    if (header.width_px != raw.width_px || header.height_px != raw.height_px) {
      reason_ = "a JPEG of " + size_text(header.width_px, header.height_px) + " pixels instead of " +
                size_text(raw.width_px, raw.height_px);
      return Made::kDamaged;
    }
    resize(buffer, raw.width_px, raw.height_px, header.decoded_format());
    if (!decode_camera_jpeg(file, header, buffer.bytes.data(), reason_)) return Made::kDamaged;
  } else {
    const int images = raw.format == RawFormat::kY8i ? 2 : 1;
    resize(buffer, raw.width_px, raw.height_px * images, converted_format(raw.format));
    convert(raw, buffer.bytes.data());
  }
  image = buffer.view();
  return Made::kCopies;
}

Eyes::Made Eyes::pair(const RawImage& left, const RawImage& right, StereoFrame& frame) {
  damaged_ = Eye::kLeft;
  const Made l = view(left, left_, frame.left);
  if (l == Made::kDamaged) return l;
  damaged_ = Eye::kRight;
  const Made r = view(right, right_, frame.right);
  return r == Made::kDamaged || r == Made::kViews ? r : l;
}

Eyes::Made Eyes::split_one(StereoLayout layout, const RawImage& raw, StereoFrame& frame) {
  ImageView whole;
  damaged_ = Eye::kLeft;
  const Made made = view(raw, left_, whole);
  if (made == Made::kDamaged) return made;
  if (layout == StereoLayout::kInterleaved)  // one above the other after the conversion
    split(StereoLayout::kTopBottom, whole, frame.left, frame.right);
  else
    split(layout, whole, frame.left, frame.right);
  return made;
}

}  // namespace accrete::hal::camera
