#include "pictures.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace accrete::vm {

Pictures::Pictures(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  hal::ImageReader reader;
  for (const auto& file : files) {
    hal::ImageHeader header;
    hal::ImageBuffer image;
    hal::Outcome read = reader.open(file, header);
    if (read.ok()) read = reader.decode(image);
    if (!read.ok()) throw std::runtime_error(read.message);
    if (!images_.empty() &&
        (image.width_px != width_px() || image.height_px != height_px() || image.format != images_[0].format))
      throw std::runtime_error(file.string() + " has another size or format than the first image");
    images_.push_back(image);
    if (header.format != hal::ImageFormat::kJpeg) continue;
    std::ifstream bytes(file, std::ios::binary);
    jpegs_.emplace_back(std::istreambuf_iterator<char>(bytes), std::istreambuf_iterator<char>());
  }
  if (images_.empty()) throw std::runtime_error(folder.string() + " has no images");
  if (images_[0].format == PixelFormat::kGrey8)
    formats_ = {Format::kGrey, Format::kYuyv};
  else
    formats_ = {Format::kBgr};
  if (jpegs_.size() == images_.size()) formats_.push_back(Format::kMjpg);
}

std::size_t Pictures::frame_bytes(Format format) const {
  const std::size_t pixels = static_cast<std::size_t>(width_px()) * static_cast<std::size_t>(height_px());
  if (format == Format::kGrey) return pixels;
  if (format == Format::kYuyv) return 2 * pixels;
  return 3 * pixels;  // a JPEG file is smaller
}

void Pictures::encode(std::size_t number, Format format, std::vector<std::uint8_t>& frame) const {
  const std::vector<std::uint8_t>& from = format == Format::kMjpg ? jpegs_[number] : images_[number].bytes;
  frame.assign(from.begin(), from.begin() + static_cast<std::ptrdiff_t>(std::min(from.size(), frame_bytes(format))));
  if (format == Format::kBgr) {
    for (std::size_t i = 0; i + 2 < frame.size(); i += 3) std::swap(frame[i], frame[i + 2]);
  } else if (format == Format::kYuyv) {
    const std::size_t pixels = frame_bytes(Format::kGrey);
    frame.resize(2 * pixels);
    for (std::size_t i = pixels; i-- > 0;) {
      frame[2 * i] = from[i];
      frame[2 * i + 1] = 128;
    }
  }
}

}  // namespace accrete::vm
