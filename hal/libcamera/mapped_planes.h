// The planes of one buffer, mapped for reading; planes of one file lie in one mapping.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace accrete::hal::libcam {

struct FilePlane {
  int fd = -1;
  std::size_t begin = 0, length = 0;
};

class MappedPlanes {
 public:
  MappedPlanes() = default;
  MappedPlanes(MappedPlanes&& other) noexcept { *this = std::move(other); }
  MappedPlanes& operator=(MappedPlanes&& other) noexcept;
  ~MappedPlanes();

  // False and errno. Precondition: nothing is mapped yet.
  [[nodiscard]] bool map(const std::vector<FilePlane>& planes);
  [[nodiscard]] std::size_t count() const { return planes_.size(); }
  [[nodiscard]] std::span<const std::uint8_t> operator[](std::size_t plane) const { return planes_[plane]; }

  // Around every reading: for processors whose caches do not see what a camera writes.
  void begin_reading() const;
  void end_reading() const;

 private:
  struct Mapping {
    int fd = -1;
    void* address = nullptr;
    std::size_t length = 0;
  };

  void sync(std::uint64_t flags) const;

  std::vector<Mapping> mappings_;
  std::vector<std::span<const std::uint8_t>> planes_;
};

}  // namespace accrete::hal::libcam
