#include "v4l2/kernel.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <system_error>

namespace accrete::hal::v4l2 {
namespace {

namespace fs = std::filesystem;

class LinuxKernel final : public Kernel {
 public:
  int open(const char* path, int flags) override { return ::open(path, flags); }
  int close(int fd) override { return ::close(fd); }
  int ioctl(int fd, unsigned long request, void* argument) override { return ::ioctl(fd, request, argument); }
  void* mmap(std::size_t length, int fd, std::int64_t offset) override {
    return ::mmap(nullptr, length, PROT_READ | PROT_WRITE, MAP_SHARED, fd, static_cast<off_t>(offset));
  }
  int munmap(void* address, std::size_t length) override { return ::munmap(address, length); }
  int poll(pollfd* fds, unsigned count, int timeout_ms) override { return ::poll(fds, count, timeout_ms); }
  std::int64_t now_ns() override {
    timespec t{};
    clock_gettime(CLOCK_MONOTONIC, &t);
    return static_cast<std::int64_t>(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
  }
  std::vector<std::string> list(const std::string& folder) override {
    std::vector<std::string> names;
    std::error_code error;
    for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error))
      names.push_back(i->path().filename().string());
    return names;
  }
  std::string resolve(const std::string& path) override {
    std::error_code error;
    const fs::path real = fs::canonical(path, error);
    return error ? std::string() : real.string();
  }
};

}  // namespace

Kernel& linux_kernel() {
  static LinuxKernel kernel;
  return kernel;
}

int open_retrying(Kernel& kernel, const char* path) {
  int fd = -1;
  for (int i = 0; i < kMaxInterruptions; ++i) {
    fd = kernel.open(path, O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (fd >= 0 || errno != EINTR) break;
  }
  return fd;
}

int ioctl_retrying(Kernel& kernel, int fd, unsigned long request, void* argument) {
  int result = -1;
  for (int i = 0; i < kMaxInterruptions; ++i) {
    result = kernel.ioctl(fd, request, argument);
    if (result >= 0 || errno != EINTR) break;
  }
  return result;
}

void* mmap_retrying(Kernel& kernel, std::size_t length, int fd, std::int64_t offset) {
  void* address = MAP_FAILED;
  for (int i = 0; i < kMaxInterruptions; ++i) {
    address = kernel.mmap(length, fd, offset);
    if (address != MAP_FAILED || errno != EINTR) break;
  }
  return address;
}

int wait(Kernel& kernel, pollfd* fds, unsigned count, std::int64_t deadline_ns) {
  const std::int64_t left_ns = deadline_ns - kernel.now_ns();
  // Rounded up, or the last millisecond would be spent in a loop; a minute at a time is long enough.
  const std::int64_t left_ms = std::clamp<std::int64_t>(left_ns / 1'000'000 + (left_ns % 1'000'000 > 0), 0, 60'000);
  const int ready = kernel.poll(fds, count, static_cast<int>(left_ms));
  return ready < 0 && (errno == EINTR || errno == EAGAIN) ? 0 : ready;
}

std::string error_text(int error) {
  std::string text = std::generic_category().message(error);
  switch (error) {
    case EACCES:
    case EPERM:
      return text + ": add the user to the group that owns it (often video) and log in again";
    case EBUSY:
      return text + ": another program uses it, end that one (fuser -v DEVICE names it)";
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return text + ": is it plugged in?";
    case ENOMEM:
    case ENOSPC:
      return text + ": fewer buffers, a smaller image, a lower rate or another USB port need less";
    default:
      return text;
  }
}

}  // namespace accrete::hal::v4l2
