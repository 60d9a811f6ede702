// Pieces of the sentences that failures carry.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace accrete::hal {

// "FOLDER/poses.txt, line 3"
[[nodiscard]] std::string at_line(const std::filesystem::path& path, std::size_t line);
// Text from a file in quotes: at most 40 bytes of it, and nothing that a terminal would obey.
[[nodiscard]] std::string in_quotes(std::string_view text);
// Shortest decimal with up to `digits` significant ones.
[[nodiscard]] std::string number(double value, int digits = 6);
// "1 frame", "2 frames"
[[nodiscard]] std::string count(std::uint64_t n, std::string_view noun);
// "640x480"
[[nodiscard]] std::string size_text(int width, int height);

}  // namespace accrete::hal
