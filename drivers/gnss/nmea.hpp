#pragma once
// One NMEA 0183 line to a typed sentence. Pure, noexcept, allocates nothing; any bytes may come in.
//
// What is refused (and counted by reason): a missing or wrong checksum, too few fields, and any
// non-empty field that is not what its column wants: numbers are plain decimals (no exponent, sign
// '+', blanks, hex), minutes of arc and time below 60, |lat| ≤ 90, |lon| ≤ 180, real dates, the
// right unit and hemisphere letters. Extra trailing fields are allowed. An unknown talker is fine.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "base/bytes.hpp"
#include "gnss/sentence.hpp"

namespace roverd::gnss {

using base::Bytes;

/// Used: decoded. Unused: a type we know and have no use for (GLL, GBS …). Unknown: any other
/// type, proprietary ones too. Damaged: see Flaw.
enum class Kind { Used, Unused, Unknown, Damaged };

enum class Flaw {
  None,
  CutShort,       ///< a '$' came before the end of the line
  NotText,        ///< a byte outside printable ASCII
  TooLong,        ///< more than kMaxLine bytes
  NoChecksum,     ///< no "*hh" at the end
  WrongChecksum,  ///< it does not match
  TooFewFields,
  BadField,  ///< Parsed::field says which
};
inline constexpr std::size_t kFlaws = 8;
std::string_view to_string(Flaw flaw) noexcept;

/// The standard says 82 characters; receivers with more decimals exceed it.
inline constexpr std::size_t kMaxLine = 256;

struct Parsed {
  Kind kind = Kind::Damaged;
  Flaw flaw = Flaw::None;
  int field = 0;  ///< of a BadField, counted from 1 after the tag
  Sentence sentence{};
};

/// @param line from '$' (which may be missing) to the checksum's last digit, without CR and LF.
Parsed parse_line(std::string_view line) noexcept;

/// XOR of all bytes.
constexpr std::uint8_t checksum(std::string_view body) noexcept {
  std::uint8_t sum = 0;
  for (const char c : body) sum = static_cast<std::uint8_t>(sum ^ static_cast<std::uint8_t>(c));
  return sum;
}

/// The UTC time of day an intact GGA, RMC, GNS, GST, ZDA or GLL line carries, for pacing a replay.
/// Empty for anything else. @param line as parse_line's.
std::optional<double> time_of_day_s(std::string_view line) noexcept;

}  // namespace roverd::gnss
