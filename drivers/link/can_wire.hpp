#pragma once
// A CAN frame as the Linux kernel lays it out (struct can_frame of linux/can.h), on SocketCAN and
// on the local CAN socket alike:
//
//   byte 0..3   id in host order; bit 31 extended (EFF), bit 30 remote (RTR), bit 29 error (ERR)
//   byte 4      data length 0..8
//   byte 5..7   padding, reserved, len8_dlc: written as 0, ignored on reading
//   byte 8..15  data; bytes beyond the length are 0 when written
//
// Pure functions.

#include <array>
#include <cstddef>
#include <cstdint>

#include "base/bytes.hpp"
#include "base/result.hpp"

namespace roverd::link {

inline constexpr std::size_t kCanPacketSize = 16;
using CanPacket = std::array<std::uint8_t, kCanPacketSize>;

inline constexpr std::uint32_t kStandardIdMask = 0x7FF;
inline constexpr std::uint32_t kExtendedIdMask = 0x1FFF'FFFF;

/// What CAN has: at most 8 bytes, an 11-bit id unless extended or an error frame, then 29 bits.
bool is_valid(const base::CanFrame& frame) noexcept;

/// @param frame valid (is_valid).
CanPacket to_packet(const base::CanFrame& frame) noexcept;

/// Refuses any other size than 16 bytes and a length above 8; the error names the byte.
base::Result<base::CanFrame> from_packet(base::Bytes packet);

}  // namespace roverd::link
