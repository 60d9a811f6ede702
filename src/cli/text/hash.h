// FNV-1a over 32-bit words, 64 bits wide (Fowler, Noll, Vo). Fields are fed one by one, so that neither padding nor the
// layout of a struct nor the order of bytes counts.
#pragma once

#include <bit>
#include <cstdint>

namespace accrete {

class Hash {
 public:
  void operator()(std::uint32_t word) { value_ = (value_ ^ word) * 0x100000001b3U; }
  void operator()(std::int32_t word) { (*this)(static_cast<std::uint32_t>(word)); }
  void operator()(float x) { (*this)(std::bit_cast<std::uint32_t>(x)); }
  void operator()(bool x) { (*this)(std::uint32_t{x}); }
  void operator()(std::uint8_t x) { (*this)(std::uint32_t{x}); }
  void operator()(std::uint16_t x) { (*this)(std::uint32_t{x}); }
  template <class Range>
  requires requires(const Range& r) { r.begin(); }
  void operator()(const Range& range) {
    for (const auto& x : range) (*this)(x);
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

}  // namespace accrete
