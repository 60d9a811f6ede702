// Stands in for png_encoder.cpp in a build without libpng.
#include "image/png_encoder.h"

namespace accrete::hal {

bool encode_png(const ImageView& /*image*/, std::vector<std::uint8_t>& /*file*/, std::string& reason) {
  reason = "this build leaves PNG out: configure with -DACCRETE_WITH_PNG=ON";
  return false;
}

}  // namespace accrete::hal
