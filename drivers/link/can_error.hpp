#pragma once
// What a CAN controller says in its error message frames (linux/can/error.h), in words. Pure
// functions; no allocation, because a broken bus sends thousands a second.

#include <array>
#include <cstdint>
#include <string_view>

#include "base/bytes.hpp"

namespace roverd::link {

/// The words, in the order of the bits that faults_of sets.
inline constexpr std::array<std::string_view, 23> kCanFaultWords{
    "transmit time-out",
    "arbitration lost",
    "receive buffer overflow",
    "transmit buffer overflow",
    "error warning (receiving)",
    "error warning (transmitting)",
    "error passive (receiving)",
    "error passive (transmitting)",
    "error active again",
    "protocol error: bit",
    "protocol error: form",
    "protocol error: stuff",
    "protocol error: cannot send 0",
    "protocol error: cannot send 1",
    "protocol error: overload",
    "protocol error",
    "transceiver fault",
    "no acknowledgement",
    "bus off",
    "bus error",
    "restarted",
    "controller fault",
    "unknown error frame",
};

/// Bits are indices into kCanFaultWords.
using CanFaults = std::uint32_t;

/// The bit of one of the words; does not compile with another.
consteval CanFaults fault_bit(std::string_view word) {
  for (std::size_t i = 0; i < kCanFaultWords.size(); ++i) {
    if (kCanFaultWords[i] == word) return CanFaults{1} << i;
  }
  throw "no such word";
}

/// @param frame an error message frame. @return never 0, except for one that only carries error
/// counters.
CanFaults faults_of(const base::CanFrame& frame) noexcept;

}  // namespace roverd::link
