// Reading a whole text file, with a sentence when that fails.
#pragma once

#include <filesystem>
#include <string>

namespace accrete::cli {

// Throws Failure(kInput): missing, a folder, unreadable, or larger than 256 MiB (no truth or result is that large: a
// device or a wrong file, which must not fill the memory).
[[nodiscard]] std::string read_text_file(const std::filesystem::path& path);

}  // namespace accrete::cli
