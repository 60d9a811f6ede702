// JPEG by TurboJPEG: grey files stay grey, colour becomes RGB.
#include <turbojpeg.h>

#include "image/image_file.h"

namespace accrete::hal {
namespace {

struct Decompressor {
  tjhandle handle = tjInitDecompress();
  Decompressor() = default;
  ~Decompressor() {
    if (handle != nullptr) tjDestroy(handle);
  }
  // After a header that is none the library would take the next file for its continuation, and refuse that, too.
  void renew() {
    if (handle != nullptr) tjDestroy(handle);
    handle = tjInitDecompress();
  }
  Decompressor(const Decompressor&) = delete;
  Decompressor& operator=(const Decompressor&) = delete;
};

// One a thread: it holds the decoder's working memory over the frames.
Decompressor& own() {
  thread_local Decompressor d;
  return d;
}
tjhandle decompressor() { return own().handle; }

// A warning (a truncated file, a corrupt block) is an error here: half an image has wrong edges. Progressive files may
// ask for thousands of scans: limited where the library can.
#ifdef TJFLAG_LIMITSCANS
constexpr int kFlags = TJFLAG_ACCURATEDCT | TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS;
#else
constexpr int kFlags = TJFLAG_ACCURATEDCT | TJFLAG_STOPONWARNING;
#endif

}  // namespace

bool read_jpeg_header(FileBytes file, ImageHeader& header, std::string& reason) {
  int width = 0, height = 0, sampling = 0, colours = 0;
  if (decompressor() == nullptr ||
      tjDecompressHeader3(decompressor(), file.data(), file.size(), &width, &height, &sampling, &colours) != 0) {
    reason = tjGetErrorStr2(decompressor());
    own().renew();
    return false;
  }
  if (width <= 0 ||
      height <= 0) {  // a stream of tables alone, or one that ends before its size, is no error to the library
    reason = "truncated before the size";
    own().renew();
    return false;
  }
  if (colours == TJCS_CMYK || colours == TJCS_YCCK) {
    reason = "four inks (CMYK), which no camera delivers";
    return false;
  }
  header.width_px = width;
  header.height_px = height;
  header.channels = colours == TJCS_GRAY ? 1 : 3;
  header.bits = 8;
  return true;
}

bool decode_jpeg(FileBytes file, const ImageHeader& header, std::uint8_t* pixels, std::string& reason) {
  const int format = header.decoded_format() == PixelFormat::kGrey8 ? TJPF_GRAY : TJPF_RGB;
  if (tjDecompress2(decompressor(), file.data(), file.size(), pixels, header.width_px, 0, header.height_px, format,
                    kFlags) != 0) {
    reason = tjGetErrorStr2(decompressor());
    return false;
  }
  return true;
}

// The library keeps the text of the first warning, so that one at the very end means that nothing before it was wrong.
bool decode_camera_jpeg(FileBytes file, const ImageHeader& header, std::uint8_t* pixels, std::string& reason) {
  const int format = header.decoded_format() == PixelFormat::kGrey8 ? TJPF_GRAY : TJPF_RGB;
  if (tjDecompress2(decompressor(), file.data(), file.size(), pixels, header.width_px, 0, header.height_px, format,
                    kFlags & ~TJFLAG_STOPONWARNING) == 0)
    return true;
  reason = tjGetErrorStr2(decompressor());
  return tjGetErrorCode(decompressor()) == TJERR_WARNING &&
         reason.find("extraneous bytes before marker 0xd9") != std::string::npos;
}

}  // namespace accrete::hal
