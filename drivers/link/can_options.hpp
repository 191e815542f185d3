#pragma once
// What an address may say about a CAN interface behind its name.
//
//   can:can0?bitrate=500000&restart_ms=100&only=211+221+18FF0000
//
//   bitrate=N     bit/s: the interface is set to it and brought up, when that is allowed
//   up=1          the interface is brought up with the bit rate it has
//   restart_ms=N  the kernel restarts a bus that is off after this long; 0: this program does
//   only=A+B+…    no other ids are read: 3 hex digits a standard id, 8 an extended one
//
// Without `only` every id is heard, so that a driver can count the foreign ones: the default.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"

namespace roverd::link {

struct CanId {
  std::uint32_t id = 0;
  bool extended = false;
  friend bool operator==(const CanId&, const CanId&) = default;
};

struct CanOptions {
  std::optional<unsigned> bitrate{};     ///< bit/s, 10 000 to 1 000 000
  bool up = false;                       ///< bring the interface up; a bit rate means it too
  std::optional<unsigned> restart_ms{};  ///< absent: 100 with a bit rate, else left as it is
  std::vector<CanId> only{};             ///< empty: every id

  bool configures() const noexcept { return up || bitrate.has_value(); }
  friend bool operator==(const CanOptions&, const CanOptions&) = default;
};

/// @param text what follows the question mark; empty: no options. The error's detail says what is
/// wrong with which option.
base::Result<CanOptions> parse_can_options(std::string_view text);
/// With its question mark; empty without options.
std::string to_string(const CanOptions& options);

}  // namespace roverd::link
