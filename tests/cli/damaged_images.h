// A recording that can be opened, and of which no frame can be used.
#pragma once

#include "cli/child.h"

namespace accrete::cli {

// Below `folder`; by its name there. Four frames of the synthetic scene whose images end after their headers.
inline std::string recording_of_damaged_images(const std::filesystem::path& folder) {
  EXPECT_EQ(run_program(folder, {"record", "synthetic:box-plain", "--frames", "0:3", "-q", "--out", "damaged"}).status,
            0);
  constexpr std::uintmax_t kHeader = 200;
  for (const char* eye : {"cam0", "cam1"})
    for (const auto& image : std::filesystem::directory_iterator(folder / "damaged/mav0" / eye / "data"))
      std::filesystem::resize_file(image, kHeader);
  return "damaged";
}

}  // namespace accrete::cli
