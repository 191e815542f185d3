#pragma once
// AgileX CAN protocol V1, as older Bunker firmware speaks it: frames to SI structs and back. Pure,
// constexpr, no state. As bunker/codec.hpp (which has V2) in everything else; what differs:
//
//   every frame is 8 bytes, byte 6 counts up, byte 7 is the checksum: low id byte + high id byte +
//   length + bytes 0..6, modulo 256. A frame with a wrong one is refused.
//
//   0x130 command (speeds in percent)   0x151 system state          0x140 light command
//   0x131 motion state                  0x200 to 0x203 motor 1..4   0x141 light state
//
// There is no standby: mode 0 is the radio's, or nobody's if its transmitter is off.

#include "bunker/codec.hpp"
#include "bunker/wire.hpp"

namespace roverd::bunker::v1 {

namespace id {
inline constexpr std::uint32_t kCommand = 0x130;
inline constexpr std::uint32_t kMotionState = 0x131;
inline constexpr std::uint32_t kLightCommand = 0x140;
inline constexpr std::uint32_t kLightState = 0x141;
inline constexpr std::uint32_t kSystemState = 0x151;
inline constexpr std::uint32_t kMotor = 0x1FF;  ///< plus the motor number, 1 to 4
}  // namespace id

enum class RequestedMode : std::uint8_t { Radio = 0, Can = 1, Uart = 2 };

/// Byte 1 of a command. Motors 1 and 2 of a Bunker: 3 and 4.
inline constexpr std::uint8_t kClearNone = 0;
inline constexpr std::uint8_t kClearMotor1 = 3;
inline constexpr std::uint8_t kClearLast = 8;

struct Command {
  RequestedMode mode = RequestedMode::Radio;
  std::uint8_t clear = kClearNone;  ///< 0..8: one kind of error
  std::int8_t linear_pct = 0;       ///< −100..100 of the base's own full speed
  std::int8_t angular_pct = 0;
  std::int8_t lateral_pct = 0;  ///< always 0 on a Bunker
  std::uint8_t count = 0;
};

struct MotionState {
  double linear_mps = 0.0;  ///< step 0.001
  double angular_radps = 0.0;
  std::uint8_t count = 0;
};

struct LightCommand : Light {};
struct LightState : Light {};

struct SystemState {
  std::uint8_t vehicle_state_raw = 0;  ///< 0 normal, 1 emergency stop, 2 exception
  std::uint8_t control_mode_raw = 0;   ///< 0 radio, 1 CAN, 2 UART
  double battery_v = 0.0;              ///< step 0.1
  std::uint16_t error_code = 0;        ///< bits of kErrorBits below
  std::uint8_t count = 0;

  constexpr base::VehicleState vehicle_state() const noexcept {
    return bunker::SystemState{.vehicle_state_raw = vehicle_state_raw}.vehicle_state();
  }
  constexpr base::ControlMode control_mode() const noexcept {
    constexpr std::array kModes{base::ControlMode::Radio, base::ControlMode::Can,
                                base::ControlMode::Uart};
    return control_mode_raw < kModes.size() ? kModes[control_mode_raw] : base::ControlMode::Unknown;
  }
};

struct Motor {
  std::uint8_t motor = 1;  ///< 1 to 4
  double current_a = 0.0;  ///< step 0.1
  std::int16_t rpm = 0;
  std::int8_t driver_temp_c = 0;
  std::int8_t motor_temp_c = 0;
  std::uint8_t count = 0;
};

using Message = std::variant<std::monostate, Command, MotionState, LightCommand, LightState,
                             SystemState, Motor>;

struct Decoded {
  Verdict verdict = Verdict::Foreign;
  Message message{};
};

inline constexpr ErrorTable kErrorBits{{
    {"battery_fault", "battery under-voltage fault"},
    {"battery_over_voltage", "battery over-voltage fault"},
    {"motor_driver_1_lost", "motor driver 1 does not answer"},
    {"motor_driver_2_lost", "motor driver 2 does not answer"},
    {"motor_driver_3_lost", "motor driver 3 does not answer"},
    {"motor_driver_4_lost", "motor driver 4 does not answer"},
    {"driver_overheat", "motor driver too hot"},
    {"driver_overcurrent", "motor driver over-current"},
    {"can_checksum", "the base received a command with a wrong checksum"},
    {"driver_overheat_warning", "motor driver gets hot"},
    {"driver_overcurrent_warning", "motor driver near its current limit"},
    {"battery_warning", "battery under-voltage warning"},
    {"rc_signal_loss", "radio transmitter signal lost"},
    {"bit13_reserved", "bit 13"},
    {"bit14_reserved", "bit 14"},
    {"bit15_reserved", "bit 15"},
}};

constexpr bool is_known(std::uint32_t frame_id) noexcept {
  return frame_id == id::kCommand || frame_id == id::kMotionState ||
         frame_id == id::kLightCommand || frame_id == id::kLightState ||
         frame_id == id::kSystemState || (frame_id > id::kMotor && frame_id <= id::kMotor + 4);
}

namespace wire {
using namespace bunker::wire;

constexpr CanFrame sealed(CanFrame f, std::uint8_t count) noexcept {
  f.data[6] = count;
  f.data[7] = v1_checksum(f);
  return f;
}

template <class L>
constexpr L light_from(const CanFrame& f) noexcept {
  L m = bunker::wire::light_from<L>(f);
  m.count = f.data[6];
  return m;
}

constexpr Command command_from(const CanFrame& f) noexcept {
  return {static_cast<RequestedMode>(f.data[0]),
          f.data[1],
          get_i8(f, 2),
          get_i8(f, 3),
          get_i8(f, 4),
          f.data[6]};
}
constexpr SystemState system_from(const CanFrame& f) noexcept {
  return {f.data[0], f.data[1], get_u16(f, 2) / 10.0, get_u16(f, 4), f.data[6]};
}
constexpr Motor motor_from(const CanFrame& f) noexcept {
  return {static_cast<std::uint8_t>(f.id - id::kMotor),
          get_i16(f, 0) / 10.0,
          get_i16(f, 2),
          get_i8(f, 4),
          get_i8(f, 5),
          f.data[6]};
}
}  // namespace wire

constexpr Decoded decode(const CanFrame& f) noexcept {
  if (f.extended || f.remote || f.error || !is_known(f.id)) return {};
  if (f.len < 8) return {Verdict::TooShort, {}};
  if (f.data[7] != v1_checksum(f)) return {Verdict::BadChecksum, {}};
  const auto decoded = [](Message m) { return Decoded{Verdict::Decoded, m}; };
  switch (f.id) {
    case id::kCommand:
      if (f.data[0] > 2) return {Verdict::BadValue, {}};
      return decoded(wire::command_from(f));
    case id::kMotionState:
      return decoded(
          MotionState{wire::get_i16(f, 0) / 1000.0, wire::get_i16(f, 2) / 1000.0, f.data[6]});
    case id::kLightCommand:
      return decoded(wire::light_from<LightCommand>(f));
    case id::kLightState:
      return decoded(wire::light_from<LightState>(f));
    case id::kSystemState:
      return decoded(wire::system_from(f));
    default:
      return decoded(wire::motor_from(f));
  }
}

constexpr CanFrame encode(const Command& m) noexcept {
  CanFrame f = wire::frame(id::kCommand);
  f.data[0] = static_cast<std::uint8_t>(m.mode);
  f.data[1] = m.clear;
  f.data[2] = static_cast<std::uint8_t>(m.linear_pct);
  f.data[3] = static_cast<std::uint8_t>(m.angular_pct);
  f.data[4] = static_cast<std::uint8_t>(m.lateral_pct);
  return wire::sealed(f, m.count);
}

constexpr CanFrame encode(const MotionState& m) noexcept {
  CanFrame f = wire::frame(id::kMotionState);
  wire::put_i16(f, 0, m.linear_mps, 1000.0);
  wire::put_i16(f, 2, m.angular_radps, 1000.0);
  return wire::sealed(f, m.count);
}

constexpr CanFrame encode(const LightCommand& m) noexcept {
  return wire::sealed(wire::light_to(id::kLightCommand, m), m.count);
}
constexpr CanFrame encode(const LightState& m) noexcept {
  return wire::sealed(wire::light_to(id::kLightState, m), m.count);
}

constexpr CanFrame encode(const SystemState& m) noexcept {
  CanFrame f = wire::frame(id::kSystemState);
  f.data[0] = m.vehicle_state_raw;
  f.data[1] = m.control_mode_raw;
  wire::put_u16(f, 2, m.battery_v, 10.0);
  wire::put16(f, 4, m.error_code);
  return wire::sealed(f, m.count);
}

constexpr CanFrame encode(const Motor& m) noexcept {
  CanFrame f = wire::frame(id::kMotor + m.motor);
  wire::put_i16(f, 0, m.current_a, 10.0);
  wire::put16(f, 2, m.rpm);
  f.data[4] = static_cast<std::uint8_t>(m.driver_temp_c);
  f.data[5] = static_cast<std::uint8_t>(m.motor_temp_c);
  return wire::sealed(f, m.count);
}

/// A speed as whole percent of `full` (positive): the nearest one that does not exceed `limit`.
/// NaN and infinity give 0.
constexpr std::int8_t percent(double value, double full, double limit) noexcept {
  const auto most = static_cast<std::int32_t>(std::clamp(limit / full * 100.0 + 1e-9, 0.0, 100.0));
  return static_cast<std::int8_t>(wire::steps(value, 100.0 / full, -most, most));
}

}  // namespace roverd::bunker::v1
