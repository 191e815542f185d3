#pragma once
// Speed and ratio, for the indoor robot: a text line with two values over TCP, every 200 ms.
//
//   <speed> <ratio>\n      "0.300 -0.250"      '.' as decimal point, one blank, '\r' tolerated
//
//   speed   of the faster wheel, m/s, forward positive
//   ratio   how much slower the other wheel turns: its speed is speed · (1 − |ratio|).
//           Positive: the left wheel is the slower one, so the robot turns left going forward.
//           0 straight, ±1 one wheel stands, ±2 on the spot; never beyond.
//
// The same line coming back is what the wheels really do. The robot stops by itself when no line
// arrives for 500 ms. Two numbers and a line end are all: whoever reads half a line waits, and a
// damaged line is one command lost. Pure.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/geo.hpp"
#include "base/line_decoder.hpp"

namespace roverd::ratio {

struct Message {
  double speed_mps = 0.0;
  double ratio = 0.0;
  friend bool operator==(const Message&, const Message&) = default;
};

/// With the line end; rounded to 0.001.
std::string encode(const Message& message);
/// @param line without the line end. Empty: not two finite numbers, or |ratio| > 2.
std::optional<Message> parse(std::string_view line) noexcept;

Message from_twist(base::BodyTwist twist, double track_width_m) noexcept;
base::BodyTwist to_twist(const Message& message, double track_width_m) noexcept;

using Decoder = base::LineDecoder<Message, 48, parse>;

}  // namespace roverd::ratio
