#include "cli/text/file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "cli/failure.h"

namespace accrete::cli {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{256} << 20U;

[[noreturn]] void fail(const std::filesystem::path& path, const char* why) {
  throw Failure(ExitStatus::kInput, fmt::format("{}: cannot be read: {}", path.string(), why));
}

}  // namespace

std::string read_text_file(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) fail(path, "it is a folder");
  struct Close {
    void operator()(std::FILE* f) const { std::fclose(f); }
  };
  const std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "rb"));
  if (!file) fail(path, std::strerror(errno));
  std::string content;
  char chunk[65536];
  std::size_t n = 0;
  while ((n = std::fread(chunk, 1, sizeof chunk, file.get())) > 0) {
    content.append(chunk, n);
    if (content.size() > kMaxBytes) fail(path, "it is larger than 256 MiB");
  }
  if (std::ferror(file.get()) != 0) fail(path, std::strerror(errno));
  return content;
}

}  // namespace accrete::cli
