// State to bytes and back. What is written is said once, by functions `fields(archive, object)` that name an object's
// members: an archive counts them, writes them, reads them, or makes a mark of their types.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

namespace accrete {

template <class T>
inline constexpr bool kIsValue = std::is_arithmetic_v<T> || std::is_enum_v<T>;

template <class Archive, class... Members>
void members(Archive& archive, Members&... all);

template <class Archive, class T, std::size_t kCount>
void fields(Archive& archive, std::array<T, kCount>& all) {
  for (T& one : all) members(archive, one);
}

template <class Archive, class... Members>
void members(Archive& archive, Members&... all) {
  const auto member = [&archive](auto& one) {
    if constexpr (kIsValue<std::remove_cvref_t<decltype(one)>>)
      archive.value(one);
    else
      fields(archive, one);
  };
  (member(all), ...);
}

class ByteCounter {
 public:
  template <class T>
  void value(T& /*v*/) {
    count += sizeof(T);
  }
  std::size_t count = 0;
};

// Precondition: there is room.
class ByteWriter {
 public:
  explicit ByteWriter(std::span<std::byte> to) : to_(to) {}
  template <class T>
  void value(T& v) {
    std::memcpy(to_.data() + at, &v, sizeof v);
    at += sizeof v;
  }
  void bytes(std::span<const std::uint8_t> all) {
    if (!all.empty()) std::memcpy(to_.data() + at, all.data(), all.size());
    at += all.size();
  }
  std::size_t at = 0;

 private:
  std::span<std::byte> to_;
};

// Reads zeros beyond the end, and remembers that.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> from) : from_(from) {}
  template <class T>
  void value(T& v) {
    if constexpr (std::is_same_v<T, bool>) {  // any other byte than 0 and 1 is no bool
      std::uint8_t byte = 0;
      value(byte);
      good = good && byte <= 1;
      v = byte == 1;
    } else {
      v = T{};
      if (from_.size() - at < sizeof v) {
        good = false;
        return;
      }
      std::memcpy(&v, from_.data() + at, sizeof v);
      at += sizeof v;
      if constexpr (std::is_floating_point_v<T>) good = good && v - v == 0;  // finite
    }
  }
  // A view of the next bytes, empty beyond the end.
  [[nodiscard]] std::span<const std::byte> bytes(std::size_t count) {
    if (from_.size() - at < count) {
      good = false;
      return {};
    }
    at += count;
    return from_.subspan(at - count, count);
  }
  void skip(std::size_t count) { good = good && (count == 0 || !bytes(count).empty()); }
  std::size_t at = 0;
  bool good = true;  // all was there, and every number is one

 private:
  std::span<const std::byte> from_;
};

// A mark of the sequence of types that is visited: another library's mark differs when a member is added, lost, or of
// another size or kind. FNV-1a.
class LayoutMark {
 public:
  template <class T>
  void value(T& /*v*/) {
    mix(sizeof(T) * 4 + (std::is_floating_point_v<T> ? 1 : std::is_enum_v<T> ? 2 : std::is_signed_v<T> ? 3 : 0));
  }
  void mix(std::uint64_t word) { mark = (mark ^ word) * 0x100000001b3U; }
  std::uint64_t mark = 0xcbf29ce484222325U;
};

}  // namespace accrete
