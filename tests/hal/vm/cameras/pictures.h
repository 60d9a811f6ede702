// The images of a plain recording as a camera's frames, in each format that shows them without loss.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "image/image_file.h"

namespace accrete::vm {

enum class Format : std::uint8_t {
  kGrey,  // GREY, for grey images
  kYuyv,  // YUYV, for grey images: chroma 128
  kBgr,   // BGR3, for colour
  kMjpg,  // MJPG, for JPEG files: their own bytes
};

class Pictures {
 public:
  // Reads every image of a folder, sorted by name. Throws std::runtime_error.
  explicit Pictures(const std::filesystem::path& folder);

  [[nodiscard]] std::size_t size() const { return images_.size(); }
  [[nodiscard]] int width_px() const { return images_[0].width_px; }
  [[nodiscard]] int height_px() const { return images_[0].height_px; }
  [[nodiscard]] const std::vector<Format>& formats() const { return formats_; }
  // The largest frame of a format.
  [[nodiscard]] std::size_t frame_bytes(Format format) const;
  void encode(std::size_t number, Format format, std::vector<std::uint8_t>& frame) const;

 private:
  std::vector<hal::ImageBuffer> images_;
  std::vector<std::vector<std::uint8_t>> jpegs_;  // empty where the files are none
  std::vector<Format> formats_;
};

}  // namespace accrete::vm
