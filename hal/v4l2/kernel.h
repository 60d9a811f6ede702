// Every call of the back-end to the operating system, so that a test can answer in its place: with any error at any
// call, and with a clock that no test waits for.
#pragma once

#include <poll.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace accrete::hal::v4l2 {

class Kernel {
 public:
  virtual ~Kernel() = default;
  Kernel(const Kernel&) = delete;
  Kernel& operator=(const Kernel&) = delete;

  // As the calls of the same names: -1 (mmap: MAP_FAILED) and errno.
  virtual int open(const char* path, int flags) = 0;
  virtual int close(int fd) = 0;
  virtual int ioctl(int fd, unsigned long request, void* argument) = 0;
  virtual void* mmap(std::size_t length, int fd, std::int64_t offset) = 0;  // for reading and writing, shared
  virtual int munmap(void* address, std::size_t length) = 0;
  virtual int poll(pollfd* fds, unsigned count, int timeout_ms) = 0;
  virtual std::int64_t now_ns() = 0;  // CLOCK_MONOTONIC, by which drivers stamp images

  // Names in a folder, in any order; none where it cannot be read.
  virtual std::vector<std::string> list(const std::string& folder) = 0;
  // What a path is after all links, empty when there is nothing.
  virtual std::string resolve(const std::string& path) = 0;

 protected:
  Kernel() = default;
};

// The real one.
[[nodiscard]] Kernel& linux_kernel();

// The same calls, again while a signal interrupts them, but not for ever.
inline constexpr int kMaxInterruptions = 100;
int open_retrying(Kernel& kernel, const char* path);
int ioctl_retrying(Kernel& kernel, int fd, unsigned long request, void* argument);
void* mmap_retrying(Kernel& kernel, std::size_t length, int fd, std::int64_t offset);

// Waits for one of `fds`, until `deadline_ns` at most; with none it sleeps. What poll() returns, 0 also for a signal:
// the caller looks at its clock and comes again.
int wait(Kernel& kernel, pollfd* fds, unsigned count, std::int64_t deadline_ns);

// What an errno means to a person, with the way out of it where there is one.
[[nodiscard]] std::string error_text(int error);

}  // namespace accrete::hal::v4l2
