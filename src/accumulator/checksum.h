// CRC-64/XZ: polynomial 0x42f0e1eba9ea3693 of ECMA-182, reflected; finds every damage of up to 64 bits in a row.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace accrete {

[[nodiscard]] constexpr std::array<std::uint64_t, 256> crc64_table() {
  std::array<std::uint64_t, 256> table{};
  for (std::uint64_t i = 0; i < 256; ++i) {
    std::uint64_t crc = i;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xc96c5795d7870f42U : 0U);
    table[static_cast<std::size_t>(i)] = crc;
  }
  return table;
}

[[nodiscard]] inline std::uint64_t crc64(std::span<const std::byte> bytes) {
  static constexpr std::array<std::uint64_t, 256> kTable = crc64_table();
  std::uint64_t crc = ~std::uint64_t{0};
  for (const std::byte b : bytes) crc = (crc >> 8) ^ kTable[(crc ^ static_cast<std::uint64_t>(b)) & 0xff];
  return ~crc;
}

}  // namespace accrete
