#pragma once
// Values that the wire can carry and no Bunker can have. A frame with one is not believed in any
// of its fields. Pure.

#include <optional>

#include "bunker/codec.hpp"
#include "bunker/tally.hpp"
#include "bunker/v1.hpp"

namespace roverd::bunker {

/// Widest possible values; far beyond a real base and well inside what the bytes can say.
inline constexpr double kMaxBattery_v = 100.0;
inline constexpr double kMaxTurn_radps = 15.0;
inline constexpr double kMaxMotor_rpm = 20000.0;
inline constexpr double kMaxCurrent_a = 500.0;
inline constexpr double kColdest_c = -60.0;
inline constexpr double kHottest_c = 200.0;

/// @param max_mps faster than this it cannot drive. @return the first impossible value.
std::optional<Impossible> impossible(const Message& message, double max_mps) noexcept;
std::optional<Impossible> impossible(const v1::Message& message, double max_mps) noexcept;

}  // namespace roverd::bunker
