// Stands in for jpeg.cpp in a build without TurboJPEG; supported() keeps callers away.
#include "image/image_file.h"

namespace accrete::hal {

bool read_jpeg_header(FileBytes /*file*/, ImageHeader& /*header*/, std::string& reason) {
  reason = "this build leaves JPEG out";
  return false;
}
bool decode_jpeg(FileBytes /*file*/, const ImageHeader& /*header*/, std::uint8_t* /*pixels*/, std::string& reason) {
  reason = "this build leaves JPEG out";
  return false;
}
bool decode_camera_jpeg(FileBytes file, const ImageHeader& header, std::uint8_t* pixels, std::string& reason) {
  return decode_jpeg(file, header, pixels, reason);
}

}  // namespace accrete::hal
