// Where the results go: prepared and tried out before any work is done, each file written whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace accrete::cli {

class ResultFolder {
 public:
  // `out` empty: results/<UTC time>_<name>/ below the current folder. Makes the folder and writes a file into it as a
  // trial. Throws Failure(kOutput) with the reason.
  ResultFolder(const std::filesystem::path& out, std::string_view name);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  // Replaces `file` (may lie in a folder below, which is made) in one step: the content goes to a temporary name, which
  // is renamed when everything has been written. Throws Failure(kOutput); then the old file, if any, is still there.
  void write(const std::filesystem::path& file, std::string_view content) const;

  // results/latest -> this folder, where this chose the folder. Returns a warning, or nothing when that worked.
  [[nodiscard]] std::string link_latest() const;

 private:
  std::filesystem::path path_;
  bool chosen_here_ = false;
};

// Replaces `file` in one step; see ResultFolder::write. Of a link what it leads to; anything but a regular file, a
// device for one, is left alone. `advice` ends the message of a failure; without it that is to choose another --out.
void write_file(const std::filesystem::path& file, std::string_view content, std::string_view advice);
void write_file(const std::filesystem::path& file, std::string_view content);

// `text` with everything but letters, digits, dot, minus and underscore replaced: fit for a folder's name.
[[nodiscard]] std::string file_name_of(std::string_view text);

}  // namespace accrete::cli
