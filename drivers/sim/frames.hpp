#pragma once
// The base's side of the bus: its reports as CAN frames, and what it reads of the host's. Written
// from the protocol sheet, not from the robot's codec, so that a shared mistake cannot cancel.
// AgileX protocol V2: 11-bit ids, big endian.

#include <cstdint>
#include <optional>

#include "base/bytes.hpp"
#include "base/geo.hpp"
#include "base/measurements.hpp"
#include "sim/radio.hpp"

namespace roverd::sim {

using base::CanFrame;

struct StateReport {
  base::VehicleState vehicle_state = base::VehicleState::Normal;
  base::ControlMode control_mode = base::ControlMode::Standby;
  double battery_v = 0.0;
  std::uint16_t error_code = 0;
  std::uint8_t count = 0;
};

struct MotorReport {
  double rpm = 0.0;
  double current_a = 0.0;
  std::int32_t pulses = 0;
};

struct BatteryReport {
  double charge_pct = 0.0;
  double voltage_v = 0.0;
  double current_a = 0.0;
  double temperature_c = 0.0;
};

CanFrame state_frame(const StateReport& report) noexcept;                        // 0x211
CanFrame motion_frame(base::BodyTwist measured) noexcept;                        // 0x221
CanFrame radio_frame(const Radio& radio, std::uint8_t count) noexcept;           // 0x241
CanFrame motor_fast_frame(int motor, const MotorReport& report) noexcept;        // 0x250 + motor
CanFrame motor_slow_frame(int motor, double supply_v, double motor_c) noexcept;  // 0x260 + motor
CanFrame odometer_frame(std::int32_t left_mm, std::int32_t right_mm) noexcept;   // 0x311
CanFrame battery_frame(const BatteryReport& report) noexcept;                    // 0x361

inline constexpr std::uint32_t kMotionCommandId = 0x111;
inline constexpr std::uint32_t kModeCommandId = 0x421;
inline constexpr std::uint32_t kClearErrorsId = 0x441;

/// 0x111. Empty if it is too short.
std::optional<base::BodyTwist> motion_command(const CanFrame& frame) noexcept;

/// Metres to whole millimetres in 32 bits, wrapping around as the base's counter does.
std::int32_t wrapped_mm(double metres) noexcept;
/// Motor revolutions to encoder pulses (1024 a revolution), wrapping likewise.
std::int32_t wrapped_pulses(double revolutions) noexcept;

}  // namespace roverd::sim
