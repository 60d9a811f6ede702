#include "libcamera/mapped_planes.h"

#include <linux/dma-buf.h>
#include <sys/ioctl.h>
#include <sys/mman.h>

#include <algorithm>
#include <utility>

namespace accrete::hal::libcam {

MappedPlanes& MappedPlanes::operator=(MappedPlanes&& other) noexcept {
  std::swap(mappings_, other.mappings_);
  std::swap(planes_, other.planes_);
  return *this;
}

MappedPlanes::~MappedPlanes() {
  for (const Mapping& mapping : mappings_) munmap(mapping.address, mapping.length);
}

bool MappedPlanes::map(const std::vector<FilePlane>& planes) {
  const auto mapping_of = [this](int fd) {
    return std::find_if(mappings_.begin(), mappings_.end(), [fd](const Mapping& m) { return m.fd == fd; });
  };
  for (const FilePlane& plane : planes) {
    if (mapping_of(plane.fd) != mappings_.end()) continue;
    std::size_t length = 0;
    for (const FilePlane& other : planes)
      if (other.fd == plane.fd) length = std::max(length, other.begin + other.length);
    void* address = mmap(nullptr, length, PROT_READ, MAP_SHARED, plane.fd, 0);
    if (address == MAP_FAILED) return false;
    mappings_.push_back({plane.fd, address, length});
  }
  for (const FilePlane& plane : planes)
    planes_.emplace_back(static_cast<const std::uint8_t*>(mapping_of(plane.fd)->address) + plane.begin, plane.length);
  return true;
}

void MappedPlanes::sync(std::uint64_t flags) const {
  for (const Mapping& mapping : mappings_) {
    dma_buf_sync argument{flags | DMA_BUF_SYNC_READ};
    ioctl(mapping.fd, DMA_BUF_IOCTL_SYNC, &argument);  // fails for what is no such buffer, and needs none
  }
}

void MappedPlanes::begin_reading() const { sync(DMA_BUF_SYNC_START); }
void MappedPlanes::end_reading() const { sync(DMA_BUF_SYNC_END); }

}  // namespace accrete::hal::libcam
