#pragma once
// CRC-24Q as RTCM 10403 uses it: polynomial 0x1864CFB, from 0, not reflected. Pure.

#include <array>
#include <cstdint>

#include "base/bytes.hpp"

namespace roverd::rtcm {

inline constexpr std::array<std::uint32_t, 256> kCrc24q = [] {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t crc = i << 16U;
    for (int bit = 0; bit < 8; ++bit) {
      crc <<= 1U;
      if ((crc & 0x1000000U) != 0) crc ^= 0x1864CFBU;
    }
    table[i] = crc;
  }
  return table;
}();

/// Zero over a whole frame with its own sum.
inline std::uint32_t crc24q(base::Bytes bytes) noexcept {
  std::uint32_t crc = 0;
  for (const std::uint8_t b : bytes) crc = ((crc << 8U) & 0xFFFFFFU) ^ kCrc24q[(crc >> 16U) ^ b];
  return crc;
}

}  // namespace roverd::rtcm
