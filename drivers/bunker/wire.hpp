#pragma once
// Byte layouts behind bunker/codec.hpp; include that one.

#include <algorithm>

#include "bunker/codec.hpp"

namespace roverd::bunker {

namespace wire {

/// Nearest integer of value / step in [lo, hi]; halves away from zero; NaN and infinity give 0.
constexpr std::int32_t steps(double value, double per_unit, std::int32_t lo,
                             std::int32_t hi) noexcept {
  constexpr double kMax = std::numeric_limits<double>::max();
  if (!(value >= -kMax && value <= kMax)) return 0;
  const double x = std::clamp(value * per_unit, static_cast<double>(lo), static_cast<double>(hi));
  const auto whole = static_cast<std::int32_t>(x);
  const double rest = x - whole;
  if (rest >= 0.5) return std::min(whole + 1, hi);
  if (rest <= -0.5) return std::max(whole - 1, lo);
  return whole;
}

constexpr void put16(CanFrame& f, std::size_t at, std::int32_t v) noexcept {
  const auto u = static_cast<std::uint32_t>(v);
  f.data[at] = static_cast<std::uint8_t>((u >> 8U) & 0xFFU);
  f.data[at + 1] = static_cast<std::uint8_t>(u & 0xFFU);
}
constexpr void put32(CanFrame& f, std::size_t at, std::int32_t v) noexcept {
  const auto u = static_cast<std::uint32_t>(v);
  put16(f, at, static_cast<std::int32_t>(u >> 16U));
  put16(f, at + 2, static_cast<std::int32_t>(u & 0xFFFFU));
}
constexpr void put_i16(CanFrame& f, std::size_t at, double value, double per_unit) noexcept {
  put16(f, at, steps(value, per_unit, -32768, 32767));
}
constexpr void put_u16(CanFrame& f, std::size_t at, double value, double per_unit) noexcept {
  put16(f, at, steps(value, per_unit, 0, 65535));
}

constexpr std::uint16_t get_u16(const CanFrame& f, std::size_t at) noexcept {
  return static_cast<std::uint16_t>((f.data[at] << 8U) | f.data[at + 1]);
}
constexpr std::int16_t get_i16(const CanFrame& f, std::size_t at) noexcept {
  return static_cast<std::int16_t>(get_u16(f, at));
}
constexpr std::int32_t get_i32(const CanFrame& f, std::size_t at) noexcept {
  const std::uint32_t high = get_u16(f, at);
  return static_cast<std::int32_t>((high << 16U) | get_u16(f, at + 2));
}
constexpr std::int8_t get_i8(const CanFrame& f, std::size_t at) noexcept {
  return static_cast<std::int8_t>(f.data[at]);
}

constexpr CanFrame frame(std::uint32_t frame_id) noexcept {
  CanFrame f;
  f.id = frame_id;
  f.len = 8;
  return f;
}

/// Shortest acceptable length of a known id; 0: unknown.
constexpr std::uint8_t least_length(std::uint32_t frame_id) noexcept {
  switch (frame_id) {
    case id::kControlMode:
    case id::kClearErrors:
      return 1;
    case id::kBatteryAlarms:
      return 4;
    case id::kMotionCommand:
    case id::kLightCommand:
    case id::kSystemState:
    case id::kMotionState:
    case id::kLightState:
    case id::kRadioState:
    case id::kActuatorFast + 1:
    case id::kActuatorFast + 2:
    case id::kActuatorFast + 3:
    case id::kActuatorFast + 4:
    case id::kActuatorSlow + 1:
    case id::kActuatorSlow + 2:
    case id::kActuatorSlow + 3:
    case id::kActuatorSlow + 4:
    case id::kOdometer:
    case id::kBattery:
    case id::kVersion:
    case id::kVersionText:
      return 8;
    default:
      return 0;
  }
}

template <class M>
constexpr M motion_from(const CanFrame& f) noexcept {
  M m;
  m.linear_mps = get_i16(f, 0) / 1000.0;
  m.angular_radps = get_i16(f, 2) / 1000.0;
  m.lateral_mps = get_i16(f, 4) / 1000.0;
  m.steering_rad = get_i16(f, 6) / 1000.0;
  return m;
}
constexpr CanFrame motion_to(std::uint32_t frame_id, const Motion& m) noexcept {
  CanFrame f = frame(frame_id);
  put_i16(f, 0, m.linear_mps, 1000.0);
  put_i16(f, 2, m.angular_radps, 1000.0);
  put_i16(f, 4, m.lateral_mps, 1000.0);
  put_i16(f, 6, m.steering_rad, 1000.0);
  return f;
}

template <class L>
constexpr L light_from(const CanFrame& f) noexcept {
  L m;
  m.enabled = f.data[0] != 0;
  m.front_mode = static_cast<LightMode>(f.data[1] & 3U);
  m.front_value = f.data[2];
  m.rear_mode = static_cast<LightMode>(f.data[3] & 3U);
  m.rear_value = f.data[4];
  m.count = f.data[7];
  return m;
}
constexpr CanFrame light_to(std::uint32_t frame_id, const Light& m) noexcept {
  CanFrame f = frame(frame_id);
  f.data[0] = m.enabled ? 1 : 0;
  f.data[1] = static_cast<std::uint8_t>(m.front_mode);
  f.data[2] = std::min<std::uint8_t>(m.front_value, 100);
  f.data[3] = static_cast<std::uint8_t>(m.rear_mode);
  f.data[4] = std::min<std::uint8_t>(m.rear_value, 100);
  f.data[7] = m.count;
  return f;
}

constexpr SystemState system_from(const CanFrame& f) noexcept {
  SystemState m;
  m.vehicle_state_raw = f.data[0];
  m.control_mode_raw = f.data[1];
  m.battery_v = get_u16(f, 2) / 10.0;
  m.error_code = get_u16(f, 4);
  m.count = f.data[7];
  return m;
}

constexpr RadioFrame radio_from(const CanFrame& f, LeftStick order) noexcept {
  const bool ud_first = order == LeftStick::UdLr;
  RadioFrame m;
  m.switches_raw = f.data[0];
  m.right_lr = get_i8(f, 1);
  m.right_ud = get_i8(f, 2);
  m.left_ud = get_i8(f, ud_first ? 3 : 4);
  m.left_lr = get_i8(f, ud_first ? 4 : 3);
  m.vra = get_i8(f, 5);
  m.count = f.data[7];
  return m;
}

constexpr ActuatorFast fast_from(const CanFrame& f) noexcept {
  ActuatorFast m;
  m.motor = static_cast<std::uint8_t>(f.id - id::kActuatorFast);
  m.rpm = get_i16(f, 0);
  m.current_a = get_i16(f, 2) / 10.0;
  m.pulses = get_i32(f, 4);
  return m;
}

constexpr ActuatorSlow slow_from(const CanFrame& f) noexcept {
  ActuatorSlow m;
  m.motor = static_cast<std::uint8_t>(f.id - id::kActuatorSlow);
  m.driver_voltage_v = get_u16(f, 0) / 10.0;
  m.driver_temp_c = get_i16(f, 2);
  m.motor_temp_c = get_i8(f, 4);
  m.driver_state = f.data[5];
  return m;
}

constexpr Battery battery_from(const CanFrame& f) noexcept {
  Battery m;
  m.soc_pct = f.data[0];
  m.soh_pct = f.data[1];
  m.voltage_v = get_i16(f, 2) / 10.0;
  m.current_a = get_i16(f, 4) / 10.0;
  m.temperature_c = get_i16(f, 6) / 10.0;
  return m;
}

constexpr VersionText text_from(const CanFrame& f) noexcept {
  VersionText m;
  for (std::size_t i = 0; i < m.text.size(); ++i) m.text[i] = static_cast<char>(f.data[i]);
  return m;
}

constexpr base::Switch switch_of(unsigned raw, bool three_way) noexcept {
  switch (raw & 3U) {
    case 2:
      return base::Switch::Up;
    case 3:
      return base::Switch::Down;
    case 1:
      return three_way ? base::Switch::Middle : base::Switch::Unknown;
    default:
      return base::Switch::Unknown;
  }
}
constexpr unsigned switch_bits(base::Switch s) noexcept {
  switch (s) {
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

}  // namespace wire

}  // namespace roverd::bunker
