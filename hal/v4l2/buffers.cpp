#include "v4l2/buffers.h"

#include <linux/videodev2.h>
#include <sys/mman.h>

#include <cerrno>

#include "text/sentence.h"
#include "v4l2/negotiate.h"

namespace accrete::hal::v4l2 {
namespace {

// One lies with the reader and one waits for its partner while the driver fills another.
constexpr int kMinBuffers = 3;
// 8192 x 8192 RGB twice, and some alignment: more than that is no image.
constexpr std::size_t kMaxPlaneBytes = std::size_t{512} << 20;

}  // namespace

Outcome Buffers::request(int fd, std::uint32_t type, int count, int planes, const std::string& who) {
  release();
  fd_ = fd;
  type_ = type;
  int error = 0;
  const char* step = "";
  for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
    if (try_request(count, planes, step)) return {};
    error = errno;
    release();
    if (error == ENODEV || error == ENOMEM) break;
    fd_ = fd;
  }
  fd_ = -1;
  return {status_of(error), who + ": " + step + ": " + error_text(error)};
}

bool Buffers::try_request(int count, int planes, const char*& step) {
  v4l2_requestbuffers raw{};
  raw.count = static_cast<std::uint32_t>(count);
  raw.type = type_;
  raw.memory = V4L2_MEMORY_MMAP;
  step = "it gives no buffers";
  if (ioctl_retrying(kernel_, fd_, VIDIOC_REQBUFS, &raw) < 0) return false;
  if (raw.count < kMinBuffers || raw.count > VIDEO_MAX_FRAME) {
    step = "it gives too few buffers";
    errno = ENOMEM;
    return false;
  }
  maps_.reserve(raw.count);
  for (unsigned slot = 0; slot < raw.count; ++slot)
    if (!map_slot(slot, planes, step)) return false;
  return true;
}

bool Buffers::map_slot(unsigned slot, int planes, const char*& step) {
  v4l2_buffer raw{};
  v4l2_plane raw_planes[VIDEO_MAX_PLANES]{};
  const bool multiplanar = type_ == V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE;
  raw.index = slot;
  raw.type = type_;
  raw.memory = V4L2_MEMORY_MMAP;
  if (multiplanar) {
    raw.m.planes = raw_planes;
    raw.length = VIDEO_MAX_PLANES;
  }
  step = "it does not say where its buffers are";
  if (ioctl_retrying(kernel_, fd_, VIDIOC_QUERYBUF, &raw) < 0) return false;
  maps_.emplace_back();
  step = "its buffers cannot be mapped";
  for (int i = 0; i < planes; ++i) {
    const std::size_t length = multiplanar ? raw_planes[i].length : raw.length;
    const std::uint32_t offset = multiplanar ? raw_planes[i].m.mem_offset : raw.m.offset;
    if (length == 0 || length > kMaxPlaneBytes) {
      errno = EINVAL;
      return false;
    }
    void* address = mmap_retrying(kernel_, length, fd_, offset);
    if (address == MAP_FAILED) return false;
    maps_.back()[static_cast<std::size_t>(i)] = {address, length};
  }
  return true;
}

void Buffers::unmap_all() {
  for (Planes& planes : maps_)
    for (Map& map : planes) {
      if (map.address == nullptr) continue;
      for (int attempt = 0; attempt < kMaxAttempts; ++attempt)
        if (kernel_.munmap(map.address, map.length) == 0) break;
      map = {};
    }
  maps_.clear();
}

void Buffers::release() {
  if (fd_ < 0) return;
  unmap_all();
  v4l2_requestbuffers raw{};
  raw.type = type_;
  raw.memory = V4L2_MEMORY_MMAP;
  ioctl_retrying(kernel_, fd_, VIDIOC_REQBUFS, &raw);  // fails where the device is gone: then nothing is held either
  fd_ = -1;
}

std::span<const std::uint8_t> Buffers::plane(int slot, int plane) const {
  const Map& map = maps_[static_cast<std::size_t>(slot)][static_cast<std::size_t>(plane)];
  return {static_cast<const std::uint8_t*>(map.address), map.length};
}

}  // namespace accrete::hal::v4l2
