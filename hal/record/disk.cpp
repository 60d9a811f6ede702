#include "record/disk.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace accrete::hal {
namespace {

namespace fs = std::filesystem;

Outcome failed(const fs::path& path, int error) {
  return {Status::kUnavailable, path.string() + " cannot be written: " + std::strerror(error)};
}

class File {
 public:
  File(const fs::path& path, int flags) : fd_(::open(path.c_str(), flags | O_CLOEXEC, 0644)) {}
  ~File() { (void)close(); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  [[nodiscard]] int fd() const { return fd_; }
  // Zero, or the errno of what failed. A quota or a network says so only here.
  int close() {
    const int fd = fd_;
    fd_ = -1;
    return fd >= 0 && ::close(fd) != 0 && errno != EINTR ? errno : 0;
  }

 private:
  int fd_;
};

// Zero, or the errno.
int write_all(int fd, const void* data, std::size_t n) {
  const auto* at = static_cast<const std::uint8_t*>(data);
  while (n > 0) {
    const ssize_t written = ::write(fd, at, n);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    if (written == 0) return ENOSPC;
    at += written;
    n -= static_cast<std::size_t>(written);
  }
  return 0;
}

class PosixDisk final : public Disk {
 public:
  Outcome make_folder(const fs::path& folder) override {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) return {Status::kUnavailable, folder.string() + " cannot be made: " + error.message()};
    return {};
  }

  Outcome write_whole(const fs::path& file, std::span<const std::uint8_t> bytes) override {
    const fs::path hidden = file.parent_path() / ("." + file.filename().string() + ".tmp");
    File out(hidden, O_WRONLY | O_CREAT | O_TRUNC);
    if (out.fd() < 0) return failed(file, errno);
    int error = write_all(out.fd(), bytes.data(), bytes.size());
    if (const int closing = out.close(); error == 0) error = closing;
    if (error == 0 && std::rename(hidden.c_str(), file.c_str()) != 0) error = errno;
    if (error == 0) return {};
    std::remove(hidden.c_str());  // frees the space, too
    return failed(file, error);
  }

  Outcome append(const fs::path& file, std::string_view text) override {
    auto& list = lists_[file.string()];
    if (!list) list = std::make_unique<File>(file, O_WRONLY | O_CREAT | O_APPEND);
    if (list->fd() < 0) {
      const int error = errno;
      list.reset();
      return failed(file, error);
    }
    struct stat before {};
    if (::fstat(list->fd(), &before) != 0) return failed(file, errno);
    const int error = write_all(list->fd(), text.data(), text.size());
    if (error == 0) return {};
    [[maybe_unused]] const int cut = ::ftruncate(list->fd(), before.st_size);  // a reader copes with half a line, too
    return failed(file, error);
  }

  // One call for every file of the last second: a call for each image costs a transaction of the journal each.
  Outcome sync(const fs::path& folder) override {
    const File any(folder, O_RDONLY | O_DIRECTORY);
    if (any.fd() < 0 || ::syncfs(any.fd()) != 0) return failed(folder, errno);
    return {};
  }

 private:
  std::map<std::string, std::unique_ptr<File>> lists_;
};

}  // namespace

std::unique_ptr<Disk> make_disk() { return std::make_unique<PosixDisk>(); }

}  // namespace accrete::hal
