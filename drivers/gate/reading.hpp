#pragma once
// The gate's own reading of messages, by its tables and with no help of the codec that made them.
// Pure, no allocation.

#include <array>
#include <cstdint>
#include <optional>

#include "base/bytes.hpp"
#include "gate/table.hpp"

namespace roverd::gate {

/// What wants to leave, or came in.
struct Wire {
  std::uint32_t id = 0;  ///< of a CAN frame, else 0
  base::Bytes bytes;
};

/// What a motion message says, in the units of its limits.
struct Said {
  std::array<double, 2> values{};  ///< finite
  bool stands = false;             ///< both zero, but for one that holds
  bool drives = false;             ///< in the driving mode, or not zero where there is no mode
  bool asks = false;
  bool beyond = false;  ///< what holds is beyond its limit
};

bool right_length(const Motion& motion, base::Bytes bytes) noexcept;
/// Empty: a byte, number or seal that the table does not have.
std::optional<Said> read(const Motion& motion, const Wire& wire) noexcept;
/// Every byte within its range, and the seal intact. @param wire exactly as long as the layout.
bool fits(const Layout& layout, const Wire& wire) noexcept;
/// @param check not Xor, whose seal is text.
bool sealed(Check check, const Wire& wire) noexcept;

}  // namespace roverd::gate
