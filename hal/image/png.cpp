// PNG by libpng's row interface. Its simplified one would take 16-bit images for linear light and change the values.
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>

#include "image/image_file.h"

namespace accrete::hal {
namespace {

// Ancillary chunks (text, profiles) may not grow beyond this when unpacked; images are bounded by their size.
constexpr png_alloc_size_t kMaxChunkBytes = 1U << 20;

struct Input {
  FileBytes file;
  std::size_t at = 0;
  char message[80] = "unknown";
};

void on_error(png_structp png, png_const_charp message) {
  auto* input = static_cast<Input*>(png_get_error_ptr(png));
  std::strncpy(input->message, message, sizeof input->message - 1);
  std::longjmp(png_jmpbuf(png), 1);
}
void on_warning(png_structp /*png*/, png_const_charp /*message*/) {}

void on_read(png_structp png, png_bytep out, std::size_t n) {
  auto* input = static_cast<Input*>(png_get_io_ptr(png));
  if (input->file.size() - input->at < n) png_error(png, "truncated");
  std::memcpy(out, input->file.data() + input->at, n);
  input->at += n;
}

struct Png {
  png_structp png = nullptr;
  png_infop info = nullptr;

  explicit Png(Input& input) {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &input, on_error, on_warning);
    if (png != nullptr) info = png_create_info_struct(png);
    if (info == nullptr) return;
    png_set_read_fn(png, &input, on_read);
    png_set_chunk_malloc_max(png, kMaxChunkBytes);
    png_set_user_limits(png, 1'000'000, 1'000'000);  // of the header alone; the caller checks before it allocates
  }
  ~Png() { png_destroy_read_struct(&png, &info, nullptr); }
  Png(const Png&) = delete;
  Png& operator=(const Png&) = delete;
};

// The functions below hold no object with a destructor: longjmp would skip it.

bool header_of(const Png& p, ImageHeader& header) {
  if (setjmp(png_jmpbuf(p.png))) return false;
  png_read_info(p.png, p.info);
  header.width_px = static_cast<int>(png_get_image_width(p.png, p.info));
  header.height_px = static_cast<int>(png_get_image_height(p.png, p.info));
  header.bits = png_get_bit_depth(p.png, p.info);
  const bool palette = png_get_color_type(p.png, p.info) == PNG_COLOR_TYPE_PALETTE;
  header.channels = palette ? 3 : png_get_channels(p.png, p.info);
  return true;
}

bool pixels_of(const Png& p, std::size_t row_bytes, int height, std::uint8_t* pixels, Input& input) {
  if (setjmp(png_jmpbuf(p.png))) return false;
  png_read_info(p.png, p.info);
  png_set_expand(p.png);  // palette to RGB, fewer bits to 8, transparency to alpha
  png_set_scale_16(p.png);
  png_set_strip_alpha(p.png);
  const int passes = png_set_interlace_handling(p.png);
  png_read_update_info(p.png, p.info);
  if (png_get_rowbytes(p.png, p.info) != row_bytes) {
    std::strncpy(input.message, "rows of another length than the header says", sizeof input.message - 1);
    return false;
  }
  for (int pass = 0; pass < passes; ++pass)
    for (int y = 0; y < height; ++y) png_read_row(p.png, pixels + static_cast<std::size_t>(y) * row_bytes, nullptr);
  png_read_end(p.png, nullptr);
  return true;
}

}  // namespace

bool read_png_header(FileBytes file, ImageHeader& header, std::string& reason) {
  Input input{file};
  const Png p(input);
  const bool ok = p.info != nullptr && header_of(p, header);
  if (!ok) reason = input.message;
  return ok;
}

bool decode_png(FileBytes file, const ImageHeader& header, std::uint8_t* pixels, std::string& reason) {
  Input input{file};
  const Png p(input);
  const std::size_t row_bytes = static_cast<std::size_t>(header.width_px) * channels(header.decoded_format());
  const bool ok = p.info != nullptr && pixels_of(p, row_bytes, header.height_px, pixels, input);
  if (!ok) reason = input.message;
  return ok;
}

}  // namespace accrete::hal
