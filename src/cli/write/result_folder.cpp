#include "cli/write/result_folder.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>

#include "cli/failure.h"

namespace accrete::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kOtherFolder = "; choose another folder with --out";

[[noreturn]] void fail(const fs::path& path, std::string_view why, std::string_view advice = kOtherFolder) {
  throw Failure(ExitStatus::kOutput, fmt::format("{}: cannot be written: {}{}", path.string(), why, advice));
}

fs::path temporary_name(const fs::path& file) { return file.string() + fmt::format(".tmp-{}", ::getpid()); }

// A folder that did not exist before: results/20261124-073000_name, with -2, -3 .. when two runs share a second.
fs::path new_folder(std::string_view name) {
  const std::string stem = fmt::format("{:%Y%m%d-%H%M%S}_{}", fmt::gmtime(std::time(nullptr)), file_name_of(name));
  fs::path path = fs::path("results") / stem;
  std::error_code error;
  fs::create_directories("results", error);
  if (error) fail("results", error.message());
  for (int i = 2; !fs::create_directory(path, error); ++i) {
    if (error) fail(path, error.message());
    path = fs::path("results") / fmt::format("{}-{}", stem, i);
  }
  return path;
}

}  // namespace

std::string file_name_of(std::string_view text) {
  std::string out(text.substr(0, 80));
  for (char& c : out)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '.' && c != '-' && c != '_') c = '_';
  return out.empty() ? "run" : out;
}

void write_file(const fs::path& named, std::string_view content, std::string_view advice) {
  constexpr int kMostLinks = 40;  // as Linux itself follows
  std::error_code unknown;
  fs::path file = named;  // a link may lead to a file that is not there yet
  for (int i = 0; i < kMostLinks && fs::is_symlink(file, unknown); ++i)
    file = file.parent_path() / fs::read_symlink(file, unknown);
  if (fs::is_symlink(file, unknown)) fail(named, std::strerror(ELOOP), advice);
  if (fs::exists(file, unknown) && !fs::is_regular_file(file, unknown)) fail(named, "it is no regular file", advice);
  const fs::path temporary = temporary_name(file);
  std::FILE* const stream = std::fopen(temporary.c_str(), "wb");
  if (stream == nullptr) fail(file, std::strerror(errno), advice);
  errno = 0;
  const bool written =
      std::fwrite(content.data(), 1, content.size(), stream) == content.size() && std::fflush(stream) == 0;
  int error = errno;
  if (std::fclose(stream) != 0 && error == 0) error = errno;
  if (!written || error != 0 || std::rename(temporary.c_str(), file.c_str()) != 0) {
    if (written && error == 0) error = errno;  // of the renaming
    std::remove(temporary.c_str());
    fail(file, error != 0 ? std::strerror(error) : "the file system took only a part of it", advice);
  }
}

void write_file(const fs::path& file, std::string_view content) { write_file(file, content, kOtherFolder); }

ResultFolder::ResultFolder(const fs::path& out, std::string_view name)
    : path_(out.empty() ? new_folder(name) : out), chosen_here_(out.empty()) {
  std::error_code error;
  fs::create_directories(path_, error);
  if (error) fail(path_, error.message());
  const fs::path trial = path_ / fmt::format(".accrete-trial-{}", ::getpid());
  write_file(trial, "trial\n");
  fs::remove(trial, error);
}

void ResultFolder::write(const fs::path& file, std::string_view content) const {
  std::error_code error;
  const fs::path target = path_ / file;
  fs::create_directories(target.parent_path(), error);
  if (error) fail(target.parent_path(), error.message());
  write_file(target, content);
}

std::string ResultFolder::link_latest() const {
  if (!chosen_here_) return {};
  const fs::path link = path_.parent_path() / "latest";
  std::error_code error;
  if (fs::exists(fs::symlink_status(link, error)) && !fs::is_symlink(fs::symlink_status(link, error)))
    return fmt::format("{}: is no link, left as it is", link.string());
  const fs::path temporary = temporary_name(link);
  fs::create_directory_symlink(path_.filename(), temporary, error);
  if (!error) fs::rename(temporary, link, error);
  if (!error) return {};
  const std::string why = error.message();
  fs::remove(temporary, error);
  return fmt::format("{}: no link to the newest results: {}", link.string(), why);
}

}  // namespace accrete::cli
