#pragma once
// The text of can-utils' candump, both ways. Pure functions.
//
//   log      candump -L      (1700000000.123456) can0 241#A60000B00000007E
//                            (1700000000.123456) can0 0000211A#R4           extended, remote
//                            (1700000000.123456) can0 20000040#0000…        error message frame
//            with -x         … R  or  … T                                   received, sent
//   console  candump         vcan0  241   [8]  A6 00 00 B0 00 00 00 7E
//            with -t, -x, -a, -e: a stamp before, RX/TX after the bus, text behind the data
//
// An id of 3 hex digits is a standard one, of 8 digits an extended one or, with bit 29, an error
// frame. CAN FD frames (## or a two-digit length) are refused: the robot's buses are classic.

#include <optional>
#include <string>
#include <string_view>

#include "base/bytes.hpp"
#include "base/result.hpp"
#include "base/time.hpp"

namespace roverd::link {

struct CanRecord {
  /// Since 1970 in a log; in console output whatever the stamps were made of; absent without.
  std::optional<base::Duration> stamp;
  std::string bus;
  base::CanFrame frame;
  bool sent = false;  ///< marked T or TX: by the program that recorded, not by the others
  friend bool operator==(const CanRecord&, const CanRecord&) = default;
};

/// One line; a line end is ignored. Nothing for a line that carries no
/// frame: blank, a comment (#), or candump -e's explanation of an error frame (begins with a tab).
/// Any other line is Malformed, and the detail says what is wrong.
base::Result<std::optional<CanRecord>> parse_candump_line(std::string_view line);

/// A line of a log with its line feed, marked R or T. parse_candump_line gives `record` again, with
/// the stamp cut to whole microseconds.
/// @param record with a stamp of 0 or later and a bus name without blanks; a valid frame.
std::string to_candump_line(const CanRecord& record);

}  // namespace roverd::link
