#pragma once
// Contact switches behind a microcontroller on USB serial, 115200 baud. It sends a line at every
// change and at least five times a second:
//
//   B,<mask>*<CS>\r\n      mask: decimal 0..255, one bit a switch; CS: two hexadecimal digits, XOR
//                          of all bytes before the '*'
//
//   bit 0 front left   1 front   2 front right   3 left   4 right   5 rear left   6 rear
//   bit 7 rear right
//
// Examples: B,0*5E nothing pressed; B,1*5F front left.
// Device side: mask as wired, print, XOR, done; neither latching nor debouncing is asked of it.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/line_decoder.hpp"

namespace roverd::bumper {

/// @return the mask; empty: it is no such line. @param line without the line end.
std::optional<std::uint8_t> parse(std::string_view line) noexcept;
using Decoder = base::LineDecoder<std::uint8_t, 16, parse>;
/// With the line end.
std::string encode(std::uint8_t mask);
/// "front left, rear"; empty when nothing is pressed.
std::string where(std::uint8_t mask);

}  // namespace roverd::bumper
