#pragma once
// Raw input words: bytes from a stream and frames from a CAN bus.

#include <array>
#include <cstdint>
#include <span>

namespace roverd::base {

using Bytes = std::span<const std::uint8_t>;

/// One classic CAN 2.0 data, remote or error frame as the kernel hands it over.
struct CanFrame {
  std::uint32_t id = 0;  ///< 11 or 29 bits, without flags
  bool extended = false;
  bool remote = false;
  bool error = false;    ///< error message frame of the interface; id then holds the error class
  std::uint8_t len = 0;  ///< 0..8
  std::array<std::uint8_t, 8> data{};

  Bytes bytes() const noexcept { return {data.data(), len}; }
  friend bool operator==(const CanFrame&, const CanFrame&) = default;
};

}  // namespace roverd::base
