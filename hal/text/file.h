// Files from outside: read whole, bounded, and never anything that could block.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "accrete/hal/stereo_source.h"

namespace accrete::hal {

// A text file: 64 MB hold 200 Hz poses of 30 hours in KITTI's format.
inline constexpr std::size_t kMaxTextBytes = std::size_t{64} << 20;

// Can it be known whether `path` is there? kDataLoss, and why not: a folder above it without permission, a loop of
// links.
Outcome reachable(const std::filesystem::path& path);

// Reads a regular file into `bytes`, whose storage is used again. Status: kNotFound (not there, or no file),
// kCapacityExceeded (more than `max_bytes`), kDataLoss (cannot be read, or empty).
Outcome read_bytes(const std::filesystem::path& path, std::size_t max_bytes, std::vector<std::uint8_t>& bytes);

// Reads text as UTF-8 and drops a byte order mark. Status: as read_bytes, and kUnsupported (UTF-16).
Outcome read_text(const std::filesystem::path& path, std::string& text, std::size_t max_bytes = kMaxTextBytes);

}  // namespace accrete::hal
