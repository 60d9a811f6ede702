// Stands in for png.cpp in a build without libpng; supported() keeps callers away.
#include "image/image_file.h"

namespace accrete::hal {

bool read_png_header(FileBytes /*file*/, ImageHeader& /*header*/, std::string& reason) {
  reason = "this build leaves PNG out";
  return false;
}
bool decode_png(FileBytes /*file*/, const ImageHeader& /*header*/, std::uint8_t* /*pixels*/, std::string& reason) {
  reason = "this build leaves PNG out";
  return false;
}

}  // namespace accrete::hal
