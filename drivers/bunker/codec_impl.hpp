#pragma once
// Bodies of bunker/codec.hpp; include that one.

#include <algorithm>

#include "bunker/codec.hpp"
#include "bunker/wire.hpp"

namespace roverd::bunker {

constexpr Decoded decode(const CanFrame& f, LeftStick order) noexcept {
  if (f.extended || f.remote || f.error) return {};
  const std::uint8_t least = wire::least_length(f.id);
  if (least == 0) return {};
  if (f.len < least) return {Verdict::TooShort, {}};
  const auto decoded = [](Message m) { return Decoded{Verdict::Decoded, m}; };
  switch (f.id) {
    case id::kMotionCommand:
      return decoded(wire::motion_from<MotionCommand>(f));
    case id::kLightCommand:
      return decoded(wire::light_from<LightCommand>(f));
    case id::kControlMode:
      if (f.data[0] > 2) return {Verdict::BadValue, {}};
      return decoded(ControlModeCommand{static_cast<RequestedMode>(f.data[0])});
    case id::kClearErrors:
      if (f.data[0] > 4) return {Verdict::BadValue, {}};
      return decoded(ClearErrors{f.data[0]});
    case id::kSystemState:
      return decoded(wire::system_from(f));
    case id::kMotionState:
      return decoded(wire::motion_from<MotionState>(f));
    case id::kLightState:
      return decoded(wire::light_from<LightState>(f));
    case id::kRadioState:
      return decoded(wire::radio_from(f, order));
    case id::kActuatorFast + 1:
    case id::kActuatorFast + 2:
    case id::kActuatorFast + 3:
    case id::kActuatorFast + 4:
      return decoded(wire::fast_from(f));
    case id::kActuatorSlow + 1:
    case id::kActuatorSlow + 2:
    case id::kActuatorSlow + 3:
    case id::kActuatorSlow + 4:
      return decoded(wire::slow_from(f));
    case id::kOdometer:
      return decoded(Odometer{wire::get_i32(f, 0), wire::get_i32(f, 4)});
    case id::kBattery:
      return decoded(wire::battery_from(f));
    case id::kBatteryAlarms:
      return decoded(BatteryAlarms{f.data[0], f.data[1], f.data[2], f.data[3]});
    case id::kVersion:
      return decoded(Version{
          {wire::get_u16(f, 0), wire::get_u16(f, 2), wire::get_u16(f, 4), wire::get_u16(f, 6)}});
    case id::kVersionText:
      return decoded(wire::text_from(f));
    default:
      return {};
  }
}

constexpr CanFrame encode(const MotionCommand& m) noexcept {
  return wire::motion_to(id::kMotionCommand, m);
}
constexpr CanFrame encode(const MotionState& m) noexcept {
  return wire::motion_to(id::kMotionState, m);
}
constexpr CanFrame encode(const LightCommand& m) noexcept {
  return wire::light_to(id::kLightCommand, m);
}
constexpr CanFrame encode(const LightState& m) noexcept {
  return wire::light_to(id::kLightState, m);
}

constexpr CanFrame encode(const ControlModeCommand& m) noexcept {
  CanFrame f = wire::frame(id::kControlMode);
  f.data[0] = static_cast<std::uint8_t>(m.mode);
  return f;
}

constexpr CanFrame encode(const ClearErrors& m) noexcept {
  CanFrame f = wire::frame(id::kClearErrors);
  f.data[0] = m.which;
  return f;
}

constexpr CanFrame encode(const SystemState& m) noexcept {
  CanFrame f = wire::frame(id::kSystemState);
  f.data[0] = m.vehicle_state_raw;
  f.data[1] = m.control_mode_raw;
  wire::put_u16(f, 2, m.battery_v, 10.0);
  wire::put16(f, 4, m.error_code);
  f.data[7] = m.count;
  return f;
}

constexpr CanFrame encode(const RadioFrame& m, LeftStick order) noexcept {
  const bool ud_first = order == LeftStick::UdLr;
  CanFrame f = wire::frame(id::kRadioState);
  f.data[0] = m.switches_raw;
  f.data[1] = static_cast<std::uint8_t>(m.right_lr);
  f.data[2] = static_cast<std::uint8_t>(m.right_ud);
  f.data[ud_first ? 3 : 4] = static_cast<std::uint8_t>(m.left_ud);
  f.data[ud_first ? 4 : 3] = static_cast<std::uint8_t>(m.left_lr);
  f.data[5] = static_cast<std::uint8_t>(m.vra);
  f.data[7] = m.count;
  return f;
}

constexpr CanFrame encode(const ActuatorFast& m) noexcept {
  CanFrame f = wire::frame(id::kActuatorFast + m.motor);
  wire::put16(f, 0, m.rpm);
  wire::put_i16(f, 2, m.current_a, 10.0);
  wire::put32(f, 4, m.pulses);
  return f;
}

constexpr CanFrame encode(const ActuatorSlow& m) noexcept {
  CanFrame f = wire::frame(id::kActuatorSlow + m.motor);
  wire::put_u16(f, 0, m.driver_voltage_v, 10.0);
  wire::put16(f, 2, m.driver_temp_c);
  f.data[4] = static_cast<std::uint8_t>(m.motor_temp_c);
  f.data[5] = m.driver_state;
  return f;
}

constexpr CanFrame encode(const Odometer& m) noexcept {
  CanFrame f = wire::frame(id::kOdometer);
  wire::put32(f, 0, m.left_mm);
  wire::put32(f, 4, m.right_mm);
  return f;
}

constexpr CanFrame encode(const Battery& m) noexcept {
  CanFrame f = wire::frame(id::kBattery);
  f.data[0] = m.soc_pct;
  f.data[1] = m.soh_pct;
  wire::put_i16(f, 2, m.voltage_v, 10.0);
  wire::put_i16(f, 4, m.current_a, 10.0);
  wire::put_i16(f, 6, m.temperature_c, 10.0);
  return f;
}

constexpr CanFrame encode(const BatteryAlarms& m) noexcept {
  CanFrame f = wire::frame(id::kBatteryAlarms);
  f.data[0] = m.alarm1;
  f.data[1] = m.alarm2;
  f.data[2] = m.warn1;
  f.data[3] = m.warn2;
  return f;
}

constexpr CanFrame encode(const Version& m) noexcept {
  CanFrame f = wire::frame(id::kVersion);
  for (std::size_t i = 0; i < m.number.size(); ++i) wire::put16(f, 2 * i, m.number[i]);
  return f;
}

constexpr CanFrame encode(const VersionText& m) noexcept {
  CanFrame f = wire::frame(id::kVersionText);
  for (std::size_t i = 0; i < m.text.size(); ++i) f.data[i] = static_cast<std::uint8_t>(m.text[i]);
  return f;
}

constexpr CanFrame encode(const VersionRequest& m) noexcept {
  CanFrame f = wire::frame(m.as_text ? id::kVersionText : id::kVersionRequest);
  f.len = 1;
  f.data[0] = 1;
  return f;
}

constexpr std::optional<VersionRequest> version_request(const CanFrame& f) noexcept {
  if (f.extended || f.remote || f.error || f.len != 1 || f.data[0] != 1) return std::nullopt;
  if (f.id == id::kVersionText) return VersionRequest{true};
  if (f.id == id::kVersionRequest) return VersionRequest{false};
  return std::nullopt;
}

constexpr MotionCommand limited(base::BodyTwist t, double max_linear_mps,
                                double max_angular_radps) noexcept {
  constexpr double kMax = std::numeric_limits<double>::max();
  MotionCommand m;
  const auto finite = [](double v) { return v >= -kMax && v <= kMax; };
  if (!finite(t.linear_mps) || !finite(t.angular_radps)) return m;
  m.linear_mps = std::clamp(t.linear_mps, -max_linear_mps, max_linear_mps);
  m.angular_radps = std::clamp(t.angular_radps, -max_angular_radps, max_angular_radps);
  return m;
}

constexpr std::uint8_t pack_switches(base::Switch swa, base::Switch swb, base::Switch swc,
                                     base::Switch swd) noexcept {
  return static_cast<std::uint8_t>(wire::switch_bits(swa) | (wire::switch_bits(swb) << 2U) |
                                   (wire::switch_bits(swc) << 4U) | (wire::switch_bits(swd) << 6U));
}

constexpr base::Switch RadioFrame::swa() const noexcept {
  return wire::switch_of(switches_raw, false);
}
constexpr base::Switch RadioFrame::swb() const noexcept {
  return wire::switch_of(static_cast<unsigned>(switches_raw) >> 2U, true);
}
constexpr base::Switch RadioFrame::swc() const noexcept {
  return wire::switch_of(static_cast<unsigned>(switches_raw) >> 4U, true);
}
constexpr base::Switch RadioFrame::swd() const noexcept {
  return wire::switch_of(static_cast<unsigned>(switches_raw) >> 6U, false);
}

constexpr base::VehicleState SystemState::vehicle_state() const noexcept {
  constexpr std::array kStates{base::VehicleState::Normal, base::VehicleState::Estop,
                               base::VehicleState::Exception};
  return vehicle_state_raw < kStates.size() ? kStates[vehicle_state_raw]
                                            : base::VehicleState::Unknown;
}

constexpr base::ControlMode SystemState::control_mode() const noexcept {
  constexpr std::array kModes{base::ControlMode::Standby, base::ControlMode::Can,
                              base::ControlMode::Uart, base::ControlMode::Radio};
  return control_mode_raw < kModes.size() ? kModes[control_mode_raw] : base::ControlMode::Unknown;
}

constexpr ErrorBits error_bits(std::uint16_t code, const ErrorTable& table) noexcept {
  ErrorBits out;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if ((code >> i & 1) != 0) out.bit[out.size++] = table[i];
  }
  return out;
}

constexpr bool has_error(std::uint16_t code, std::string_view word,
                         const ErrorTable& table) noexcept {
  for (const ErrorBit& bit : error_bits(code, table)) {
    if (bit.word == word) return true;
  }
  return false;
}

constexpr std::uint8_t v1_checksum(const CanFrame& f) noexcept {
  unsigned sum = (f.id & 0xFFU) + (f.id >> 8U) + f.len;
  for (std::size_t i = 0; i < 7; ++i) sum += f.data[i];
  return static_cast<std::uint8_t>(sum);
}

}  // namespace roverd::bunker
