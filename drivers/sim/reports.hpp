#pragma once
// The simulated base's state in the words of the bus, for the codec to encode.

#include <cstdint>
#include <string>
#include <vector>

#include "base/measurements.hpp"
#include "bunker/codec.hpp"
#include "sim/radio.hpp"

namespace roverd::sim {

using base::CanFrame;

/// Byte 0 and byte 1 of 0x211.
std::uint8_t raw(base::VehicleState state) noexcept;
std::uint8_t raw(base::ControlMode mode) noexcept;

/// 0x241. Sticks are cut to [−1, 1].
bunker::RadioFrame radio_report(const Radio& radio, std::uint8_t count) noexcept;

/// The frames that answer a host's version request, in either form; none for another frame.
std::vector<CanFrame> version_answer(const CanFrame& request, const std::string& firmware);

/// Metres to whole millimetres in 32 bits, wrapping around as the base's counter does.
std::int32_t wrapped_mm(double metres) noexcept;
/// Motor revolutions to encoder pulses (1024 a revolution), wrapping likewise.
std::int32_t wrapped_pulses(double revolutions) noexcept;

/// Rounded and cut to the range of a 16-bit report.
std::int16_t whole(double value) noexcept;

}  // namespace roverd::sim
