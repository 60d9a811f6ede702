// What the recorder asks of a file system; tests put a slow or a full one in its place.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string_view>

#include "accrete/hal/stereo_source.h"

namespace accrete::hal {

// All fail with kUnavailable and a sentence that names the file.
class Disk {
 public:
  virtual ~Disk() = default;
  Disk(const Disk&) = delete;
  Disk& operator=(const Disk&) = delete;

  virtual Outcome make_folder(const std::filesystem::path& folder) = 0;
  // Whole or not at all: under a hidden name first, which becomes the right one when every byte is there.
  virtual Outcome write_whole(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) = 0;
  // Adds to the end of a list; what was added by half is cut off again.
  virtual Outcome append(const std::filesystem::path& file, std::string_view text) = 0;
  // Returns when all of the above has reached the disk that holds `folder`.
  virtual Outcome sync(const std::filesystem::path& folder) = 0;

 protected:
  Disk() = default;
};

[[nodiscard]] std::unique_ptr<Disk> make_disk();

}  // namespace accrete::hal
