// The memory that one device and we share: requested, mapped, and given back whatever happens.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "accrete/hal/v4l2.h"
#include "v4l2/kernel.h"

namespace accrete::hal::v4l2 {

class Buffers {
 public:
  explicit Buffers(Kernel& kernel) : kernel_(kernel) {}
  ~Buffers() { release(); }
  Buffers(const Buffers&) = delete;
  Buffers& operator=(const Buffers&) = delete;

  // REQBUFS, QUERYBUF and mmap; a few times where a driver refuses for once. On failure nothing is held.
  // `type`: V4L2_BUF_TYPE_VIDEO_CAPTURE or its multiplanar sister.
  [[nodiscard]] Outcome request(int fd, std::uint32_t type, int count, int planes, const std::string& who);
  // Unmaps all and, where the device is still there, frees them.
  void release();

  [[nodiscard]] int count() const { return static_cast<int>(maps_.size()); }
  [[nodiscard]] std::span<const std::uint8_t> plane(int slot, int plane) const;

 private:
  struct Map {
    void* address = nullptr;
    std::size_t length = 0;
  };
  using Planes = std::array<Map, 3>;

  [[nodiscard]] bool try_request(int count, int planes, const char*& step);
  [[nodiscard]] bool map_slot(unsigned slot, int planes, const char*& step);
  void unmap_all();

  Kernel& kernel_;
  int fd_ = -1;
  std::uint32_t type_ = 0;
  std::vector<Planes> maps_;
};

// How often a step that a driver refused is tried: vivid's injected errors and a device that another program is just
// closing are over at the second time.
inline constexpr int kMaxAttempts = 3;

}  // namespace accrete::hal::v4l2
