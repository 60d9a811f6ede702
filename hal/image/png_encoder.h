// Images into PNG, fast and without loss, in memory that is used again.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "accrete/image.h"

namespace accrete::hal {

// Grey or RGB (kBgr8 is turned round), 8 bits. Preconditions: image.valid() and no side above kMaxImageSide_px. False:
// no memory, or this build leaves PNG out; `reason` says which.
[[nodiscard]] bool encode_png(const ImageView& image, std::vector<std::uint8_t>& file, std::string& reason);

}  // namespace accrete::hal
