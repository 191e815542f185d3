#include "sim/frames.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace roverd::sim {
namespace {

CanFrame empty_frame(std::uint32_t id) noexcept {
  CanFrame frame;
  frame.id = id;
  frame.len = 8;
  return frame;
}

template <class Int>
Int saturated(double value) noexcept {
  constexpr double low = std::numeric_limits<Int>::min();
  constexpr double high = std::numeric_limits<Int>::max();
  return static_cast<Int>(std::clamp(std::nearbyint(value), low, high));
}

void put16(CanFrame& frame, std::size_t at, int value) noexcept {
  frame.data.at(at) = static_cast<std::uint8_t>((value >> 8) & 0xFF);
  frame.data.at(at + 1) = static_cast<std::uint8_t>(value & 0xFF);
}

void put32(CanFrame& frame, std::size_t at, std::int32_t value) noexcept {
  const auto bits = static_cast<std::uint32_t>(value);
  for (std::size_t i = 0; i < 4; ++i) {
    frame.data.at(at + i) = static_cast<std::uint8_t>((bits >> (24 - 8 * i)) & 0xFF);
  }
}

std::uint8_t axis(double value) noexcept {
  return static_cast<std::uint8_t>(saturated<std::int8_t>(std::clamp(value, -1.0, 1.0) * 100.0));
}

/// 2 up, 1 middle, 3 down; 0 between detents.
unsigned lever(base::Switch position) noexcept {
  switch (position) {
    case base::Switch::Up:
      return 2;
    case base::Switch::Middle:
      return 1;
    case base::Switch::Down:
      return 3;
    case base::Switch::Unknown:
      break;
  }
  return 0;
}

std::uint8_t raw(base::VehicleState state) noexcept {
  switch (state) {
    case base::VehicleState::Normal:
      return 0;
    case base::VehicleState::Estop:
      return 1;
    case base::VehicleState::Exception:
    case base::VehicleState::Unknown:
      break;
  }
  return 2;
}

std::uint8_t raw(base::ControlMode mode) noexcept {
  switch (mode) {
    case base::ControlMode::Can:
      return 1;
    case base::ControlMode::Uart:
      return 2;
    case base::ControlMode::Radio:
      return 3;
    case base::ControlMode::Standby:
    case base::ControlMode::Unknown:
      break;
  }
  return 0;
}

std::int32_t wrapped(double value) noexcept {
  const auto whole = static_cast<std::uint64_t>(std::llround(value));
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(whole));
}

}  // namespace

CanFrame state_frame(const StateReport& report) noexcept {
  CanFrame frame = empty_frame(0x211);
  frame.data[0] = raw(report.vehicle_state);
  frame.data[1] = raw(report.control_mode);
  put16(frame, 2, saturated<std::uint16_t>(report.battery_v * 10.0));
  put16(frame, 4, report.error_code);
  frame.data[7] = report.count;
  return frame;
}

CanFrame motion_frame(base::BodyTwist measured) noexcept {
  CanFrame frame = empty_frame(0x221);
  put16(frame, 0, saturated<std::int16_t>(measured.linear_mps * 1000.0));
  put16(frame, 2, saturated<std::int16_t>(measured.angular_radps * 1000.0));
  return frame;
}

CanFrame radio_frame(const Radio& radio, std::uint8_t count) noexcept {
  CanFrame frame = empty_frame(0x241);
  frame.data[0] = static_cast<std::uint8_t>(lever(radio.swa) | lever(radio.swb) << 2 |
                                            lever(radio.swc) << 4 | lever(radio.swd) << 6);
  frame.data[1] = axis(radio.right_lr);
  frame.data[2] = axis(radio.right_ud);
  frame.data[3] = axis(radio.left_ud);
  frame.data[4] = axis(radio.left_lr);
  frame.data[5] = axis(radio.vra);
  frame.data[7] = count;
  return frame;
}

CanFrame motor_fast_frame(int motor, const MotorReport& report) noexcept {
  CanFrame frame = empty_frame(0x250u + static_cast<std::uint32_t>(motor));
  put16(frame, 0, saturated<std::int16_t>(report.rpm));
  put16(frame, 2, saturated<std::int16_t>(report.current_a * 10.0));
  put32(frame, 4, report.pulses);
  return frame;
}

CanFrame motor_slow_frame(int motor, double supply_v, double motor_c) noexcept {
  CanFrame frame = empty_frame(0x260u + static_cast<std::uint32_t>(motor));
  put16(frame, 0, saturated<std::uint16_t>(supply_v * 10.0));
  put16(frame, 2, saturated<std::int16_t>(motor_c));  // the driver sits on the motor's heat sink
  frame.data[4] = static_cast<std::uint8_t>(saturated<std::int8_t>(motor_c));
  return frame;
}

CanFrame odometer_frame(std::int32_t left_mm, std::int32_t right_mm) noexcept {
  CanFrame frame = empty_frame(0x311);
  put32(frame, 0, left_mm);
  put32(frame, 4, right_mm);
  return frame;
}

CanFrame battery_frame(const BatteryReport& report) noexcept {
  CanFrame frame = empty_frame(0x361);
  frame.data[0] = saturated<std::uint8_t>(report.charge_pct);
  frame.data[1] = 100;  // a new battery
  put16(frame, 2, saturated<std::int16_t>(report.voltage_v * 10.0));
  put16(frame, 4, saturated<std::int16_t>(report.current_a * 10.0));
  put16(frame, 6, saturated<std::int16_t>(report.temperature_c * 10.0));
  return frame;
}

std::optional<base::BodyTwist> motion_command(const CanFrame& frame) noexcept {
  if (frame.len < 8) return std::nullopt;
  const auto at = [&](std::size_t i) {
    return static_cast<std::int16_t>(frame.data.at(i) << 8 | frame.data.at(i + 1)) / 1000.0;
  };
  return base::BodyTwist{at(0), at(2)};
}

std::int32_t wrapped_mm(double metres) noexcept {
  return wrapped(metres * 1000.0);
}

std::int32_t wrapped_pulses(double revolutions) noexcept {
  return wrapped(revolutions * 1024.0);
}

}  // namespace roverd::sim
