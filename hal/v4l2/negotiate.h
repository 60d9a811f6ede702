// Format, size and rate of one device. A driver changes what it does not like without saying so: everything is read
// back.
#pragma once

#include <string>
#include <vector>

#include "accrete/hal/v4l2.h"
#include "v4l2/format.h"
#include "v4l2/names.h"

namespace accrete::hal::v4l2 {

struct FormatRequest {
  const KnownFormat* known = nullptr;  // null: what the device is set to
  int width_px = 0, height_px = 0;     // of the buffer; 0: what the device is set to
  double rate_hz = 0;                  // 0: what the device is set to
};

// `who` names the device in sentences. A size or a format that the driver replaces is refused, with those it has; a
// rate that it replaces is taken, with a notice. Status: kUnsupported, kUnavailable (busy), kNotFound (gone).
[[nodiscard]] Outcome negotiate(Kernel& kernel, int fd, const Capability& capability, const std::string& who,
                                const FormatRequest& request, NegotiatedFormat& format,
                                std::vector<std::string>& notices);

// Status of a call that failed with `error`.
[[nodiscard]] Status status_of(int error);

}  // namespace accrete::hal::v4l2
