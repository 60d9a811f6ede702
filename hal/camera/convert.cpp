#include "camera/convert.h"

#include <algorithm>

#include "image/image_file.h"

namespace accrete::hal::camera {
namespace {

// Y'CbCr to R'G'B' in 1 / 65536: ITU-R BT.601 and BT.709 with their own luma weights Kr and Kb,
//   R = Y + 2 (1 - Kr) Cr, B = Y + 2 (1 - Kb) Cb, G = Y - 2 Kr (1 - Kr) / Kg Cr - 2 Kb (1 - Kb) / Kg Cb,
// Y and C scaled by 255 / 219 and 255 / 224 where the range is limited.
struct Matrix {
  std::int32_t y, rv, gu, gv, bu, y_offset;
};

constexpr std::int32_t fixed(double value) {
  return static_cast<std::int32_t>(value * 65536 + 0.5);  // NOLINT(bugprone-incorrect-roundings): constexpr
}

constexpr Matrix matrix_of(double kr, double kb, bool full) {
  const double kg = 1 - kr - kb;
  const double y = full ? 1.0 : 255.0 / 219.0, c = full ? 1.0 : 255.0 / 224.0;
  return {fixed(y),
          fixed(c * 2 * (1 - kr)),
          fixed(c * 2 * kb * (1 - kb) / kg),
          fixed(c * 2 * kr * (1 - kr) / kg),
          fixed(c * 2 * (1 - kb)),
          full ? 0 : 16};
}

constexpr Matrix kMatrices[4] = {matrix_of(0.299, 0.114, false), matrix_of(0.299, 0.114, true),
                                 matrix_of(0.2126, 0.0722, false), matrix_of(0.2126, 0.0722, true)};

std::uint8_t byte_of(std::int32_t value) { return static_cast<std::uint8_t>(std::clamp(value >> 16, 0, 255)); }

void put_rgb(const Matrix& m, int y, int u, int v, std::uint8_t* rgb) {
  const std::int32_t luma = (y - m.y_offset) * m.y + 32768;  // rounds
  const std::int32_t cb = u - 128, cr = v - 128;
  rgb[0] = byte_of(luma + m.rv * cr);
  rgb[1] = byte_of(luma - m.gu * cb - m.gv * cr);
  rgb[2] = byte_of(luma + m.bu * cb);
}

const std::uint8_t* row_of(const RawImage& image, int plane, int y) {
  const RawPlane& p = image.planes[static_cast<std::size_t>(plane)];
  return p.bytes.data() + static_cast<std::size_t>(y) * p.stride_bytes;
}

// One row of 16-bit values of `bits`; what a driver leaves above them saturates.
void put_wide(const std::uint8_t* in, int width, unsigned bits, std::uint8_t* out) {
  const std::uint32_t max = (1U << bits) - 1;
  for (int x = 0; x < width; ++x) {
    const std::uint32_t v = std::min<std::uint32_t>(static_cast<std::uint32_t>(in[2 * x] | in[2 * x + 1] << 8), max);
    out[x] = static_cast<std::uint8_t>((v * 510 + max) / (2 * max));  // v * 255 / max, rounded
  }
}

void put_packed(const std::uint8_t* in, int width, bool luma_first, const Matrix& m, std::uint8_t* out) {
  const int y = luma_first ? 0 : 1, u = 1 - y;
  for (int x = 0; x < width; ++x) {
    const std::uint8_t* pair = in + 4 * (x / 2);
    put_rgb(m, pair[y + 2 * (x % 2)], pair[u], pair[u + 2], out + 3 * x);
  }
}

void put_planar(const std::uint8_t* luma, const std::uint8_t* u, const std::uint8_t* v, int step, int width,
                const Matrix& m, std::uint8_t* out) {
  for (int x = 0; x < width; ++x) put_rgb(m, luma[x], u[step * (x / 2)], v[step * (x / 2)], out + 3 * x);
}

void put_row(const RawImage& image, int y, const Matrix& m, std::uint8_t* out) {
  const std::uint8_t* in = row_of(image, 0, y);
  switch (image.format) {
    case RawFormat::kGrey:
      std::copy_n(in, image.width_px, out);
      return;
    case RawFormat::kRgb3:
    case RawFormat::kBgr3:
      std::copy_n(in, 3 * static_cast<std::size_t>(image.width_px), out);
      return;
    case RawFormat::kY10:
      return put_wide(in, image.width_px, 10, out);
    case RawFormat::kY12:
      return put_wide(in, image.width_px, 12, out);
    case RawFormat::kY16:
      return put_wide(in, image.width_px, 16, out);
    case RawFormat::kYuyv:
      return put_packed(in, image.width_px, true, m, out);
    case RawFormat::kUyvy:
      return put_packed(in, image.width_px, false, m, out);
    case RawFormat::kNv12: {
      const std::uint8_t* chroma = row_of(image, 1, y / 2);
      return put_planar(in, chroma, chroma + 1, 2, image.width_px, m, out);
    }
    case RawFormat::kYu12:
      return put_planar(in, row_of(image, 1, y / 2), row_of(image, 2, y / 2), 1, image.width_px, m, out);
    case RawFormat::kY8i: {
      std::uint8_t* right = out + static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.height_px);
      for (int x = 0; x < image.width_px; ++x) {
        out[x] = in[2 * x];
        right[x] = in[2 * x + 1];
      }
      return;
    }
    case RawFormat::kJpeg:
      return;
  }
}

}  // namespace

int plane_count(RawFormat format) { return format == RawFormat::kNv12 ? 2 : format == RawFormat::kYu12 ? 3 : 1; }

std::size_t row_bytes(RawFormat format, int plane, int width_px) {
  const auto width = static_cast<std::size_t>(std::max(width_px, 0));
  const std::size_t half = (width + 1) / 2;
  switch (format) {
    case RawFormat::kGrey:
      return width;
    case RawFormat::kY10:
    case RawFormat::kY12:
    case RawFormat::kY16:
    case RawFormat::kY8i:
      return 2 * width;
    case RawFormat::kYuyv:
    case RawFormat::kUyvy:
      return 4 * half;
    case RawFormat::kNv12:
      return plane == 0 ? width : 2 * half;
    case RawFormat::kYu12:
      return plane == 0 ? width : half;
    case RawFormat::kRgb3:
    case RawFormat::kBgr3:
      return 3 * width;
    case RawFormat::kJpeg:
      return 0;
  }
  return 0;
}

int plane_rows(RawFormat format, int plane, int height_px) {
  if (format == RawFormat::kJpeg) return 0;
  return plane == 0 ? height_px : (height_px + 1) / 2;
}

std::array<RawPlane, 3> split_planes(RawFormat format, int width_px, int height_px, std::size_t stride_bytes,
                                     std::span<const std::uint8_t> bytes) {
  std::array<RawPlane, 3> planes;
  std::size_t begin = 0;
  for (int i = 0; i < plane_count(format); ++i) {
    RawPlane& plane = planes[static_cast<std::size_t>(i)];
    // V4L2: the strides of the other planes follow from that of the first.
    plane.stride_bytes = i == 0 || format == RawFormat::kNv12 ? stride_bytes : (stride_bytes + 1) / 2;
    plane.bytes = bytes.subspan(std::min(begin, bytes.size()));
    const auto rows = static_cast<std::size_t>(std::max(plane_rows(format, i, height_px), 0));
    if (i + 1 == plane_count(format) || rows == 0) break;
    // A product beyond the bytes would only say again that they are too few; dividing cannot overflow.
    begin = plane.stride_bytes > bytes.size() / rows ? bytes.size() : begin + plane.stride_bytes * rows;
  }
  if (row_bytes(format, 0, width_px) > stride_bytes) planes[0].stride_bytes = 0;  // check() refuses it
  return planes;
}

const char* check(const RawImage& image) {
  if (image.width_px < 1 || image.height_px < 1 || image.width_px > 2 * kMaxImageSide_px ||
      image.height_px > 2 * kMaxImageSide_px)
    return "its size is out of range";
  if (image.format == RawFormat::kJpeg) return image.planes[0].bytes.empty() ? "it is empty" : nullptr;
  for (int i = 0; i < plane_count(image.format); ++i) {
    const RawPlane& plane = image.planes[static_cast<std::size_t>(i)];
    const std::size_t row = row_bytes(image.format, i, image.width_px);
    const auto rows = static_cast<std::size_t>(plane_rows(image.format, i, image.height_px));
    if (plane.bytes.size() < row) return "it is too short";
    if (rows == 1) continue;
    if (plane.stride_bytes < row) return "its rows overlap";
    if (plane.stride_bytes > (plane.bytes.size() - row) / (rows - 1)) return "it is too short";
  }
  return nullptr;
}

PixelFormat converted_format(RawFormat format) {
  switch (format) {
    case RawFormat::kGrey:
    case RawFormat::kY10:
    case RawFormat::kY12:
    case RawFormat::kY16:
    case RawFormat::kY8i:
      return PixelFormat::kGrey8;
    case RawFormat::kBgr3:
      return PixelFormat::kBgr8;
    default:
      return PixelFormat::kRgb8;
  }
}

bool is_direct(RawFormat format) {
  return format == RawFormat::kGrey || format == RawFormat::kRgb3 || format == RawFormat::kBgr3;
}

ImageView direct_view(const RawImage& image) {
  const RawPlane& plane = image.planes[0];
  const std::size_t row = row_bytes(image.format, 0, image.width_px);
  return {plane.bytes.data(), image.width_px, image.height_px,
          static_cast<std::ptrdiff_t>(std::max(plane.stride_bytes, row)), converted_format(image.format)};
}

void convert(const RawImage& image, std::uint8_t* pixels) {
  const Matrix& m = kMatrices[(image.colour.bt709 ? 2 : 0) + (image.colour.full_range ? 1 : 0)];
  const std::size_t row =
      static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(channels(converted_format(image.format)));
  for (int y = 0; y < image.height_px; ++y) put_row(image, y, m, pixels + static_cast<std::size_t>(y) * row);
}

}  // namespace accrete::hal::camera
