#pragma once
// AgileX CAN protocol V2 as a Bunker speaks it: frames to SI structs and back. Pure, constexpr, no
// state, nothing thrown. Both directions are here for every frame: a driver decodes what the base
// sends, a simulated base encodes it.
//
// Wire: 11-bit data frames at 500 kbit/s, big endian, two's complement, no checksum. Encoders write
// zero into reserved bytes; decoders never look at them, because real bases leave rubbish there.
// Signs: forward and counter-clockwise (left) positive. Every physical value is rounded to the
// nearest wire step and saturated to the wire's range; NaN and infinity become zero.
// Thread rules: none needed. The table of frames, by id:
//
//   0x111 motion command   0x211 system state    0x251-4 actuator, fast   0x361 battery
//   0x121 light command    0x221 motion state    0x261-4 actuator, slow   0x362 battery alarms
//   0x421 control mode     0x231 light state     0x311   odometer           0x41A version
//   0x441 clear errors     0x241 radio state                                0x4A1 version text
//   0x411 0x4A1 version request

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <variant>

#include "base/bytes.hpp"
#include "base/geo.hpp"
#include "base/measurements.hpp"

namespace roverd::bunker {

using base::CanFrame;

namespace id {
inline constexpr std::uint32_t kMotionCommand = 0x111;
inline constexpr std::uint32_t kLightCommand = 0x121;
inline constexpr std::uint32_t kControlMode = 0x421;
inline constexpr std::uint32_t kClearErrors = 0x441;
inline constexpr std::uint32_t kSystemState = 0x211;
inline constexpr std::uint32_t kMotionState = 0x221;
inline constexpr std::uint32_t kLightState = 0x231;
inline constexpr std::uint32_t kRadioState = 0x241;
inline constexpr std::uint32_t kActuatorFast = 0x250;  ///< plus the motor number, 1 to 4
inline constexpr std::uint32_t kActuatorSlow = 0x260;  ///< plus the motor number, 1 to 4
inline constexpr std::uint32_t kOdometer = 0x311;
inline constexpr std::uint32_t kBattery = 0x361;
inline constexpr std::uint32_t kBatteryAlarms = 0x362;
inline constexpr std::uint32_t kVersionRequest = 0x411;
inline constexpr std::uint32_t kVersion = 0x41A;      ///< its answer, the old form
inline constexpr std::uint32_t kVersionText = 0x4A1;  ///< the new form; also its request
}  // namespace id

/// Four speeds share one layout in both directions. Wire step 0.001.
struct Motion {
  double linear_mps = 0.0;
  double angular_radps = 0.0;
  double lateral_mps = 0.0;   ///< always 0 on a Bunker
  double steering_rad = 0.0;  ///< always 0 on a Bunker; some bases report FFFF
};
struct MotionCommand : Motion {};
struct MotionState : Motion {};

enum class RequestedMode : std::uint8_t { Standby = 0, Can = 1, Uart = 2 };
struct ControlModeCommand {
  RequestedMode mode = RequestedMode::Standby;
};

/// 0: every error; 1 to 4: that motor's.
struct ClearErrors {
  std::uint8_t which = 0;
};

enum class LightMode : std::uint8_t { Off = 0, On = 1, Breathing = 2, Custom = 3 };
struct Light {
  bool enabled = false;  ///< the host's commands count
  LightMode front_mode = LightMode::Off;
  std::uint8_t front_value = 0;  ///< 0..100, used in mode Custom
  LightMode rear_mode = LightMode::Off;
  std::uint8_t rear_value = 0;
  std::uint8_t count = 0;
};
struct LightCommand : Light {};
struct LightState : Light {};

struct SystemState {
  std::uint8_t vehicle_state_raw = 0;  ///< 0 normal, 1 emergency stop, 2 exception
  std::uint8_t control_mode_raw = 0;   ///< 0 standby, 1 CAN, 2 UART, 3 radio
  double battery_v = 0.0;              ///< step 0.1, 0..6553.5
  std::uint16_t error_code = 0;        ///< see error_bits()
  std::uint8_t count = 0;              ///< +1 per frame; real bases are seen to keep it at 0

  constexpr base::VehicleState vehicle_state() const noexcept;
  constexpr base::ControlMode control_mode() const noexcept;
};

/// Order of the two left-stick bytes (3 and 4) in 0x241; the vendor's sources disagree.
enum class LeftStick { UdLr, LrUd };

struct RadioFrame {
  std::uint8_t switches_raw = 0;  ///< see pack_switches
  std::int8_t right_lr = 0;       ///< sticks and knob: −100..100
  std::int8_t right_ud = 0;
  std::int8_t left_ud = 0;
  std::int8_t left_lr = 0;
  std::int8_t vra = 0;
  std::uint8_t count = 0;  ///< +1 per frame

  /// Unknown while a lever is between two detents (raw 0, or 1 on a two-way switch).
  constexpr base::Switch swa() const noexcept;
  constexpr base::Switch swb() const noexcept;
  constexpr base::Switch swc() const noexcept;
  constexpr base::Switch swd() const noexcept;
};

struct ActuatorFast {
  std::uint8_t motor = 1;  ///< 1 or 2 on a Bunker; 3 and 4 on a base with four
  std::int16_t rpm = 0;
  double current_a = 0.0;  ///< step 0.1
  std::int32_t pulses = 0;
};

struct ActuatorSlow {
  std::uint8_t motor = 1;
  double driver_voltage_v = 0.0;  ///< step 0.1
  std::int16_t driver_temp_c = 0;
  std::int8_t motor_temp_c = 0;
  std::uint8_t driver_state = 0;  ///< bits of kDriverFlags
};

/// Travel since power-up, negative after reversing. Differences need 32-bit wrap-around arithmetic.
struct Odometer {
  std::int32_t left_mm = 0;
  std::int32_t right_mm = 0;
};

struct Battery {
  std::uint8_t soc_pct = 0;
  std::uint8_t soh_pct = 0;
  double voltage_v = 0.0;      ///< step 0.1
  double current_a = 0.0;      ///< step 0.1; the sign of charging is not documented
  double temperature_c = 0.0;  ///< step 0.1
};

/// Meaning of the bits differs between batteries: show raw.
struct BatteryAlarms {
  std::uint8_t alarm1 = 0;
  std::uint8_t alarm2 = 0;
  std::uint8_t warn1 = 0;
  std::uint8_t warn2 = 0;
};

/// Four numbers whose meaning is not documented.
struct Version {
  std::array<std::uint16_t, 4> number{};
};

/// Eight of the characters of a text that comes in ten or more frames. The request looks alike: one
/// byte 01.
struct VersionText {
  std::array<char, 8> text{};
};

/// The host's question for either of the two: one byte 01.
struct VersionRequest {
  bool as_text = true;  ///< 0x4A1, else 0x411
};

using Message =
    std::variant<std::monostate, MotionCommand, ControlModeCommand, ClearErrors, LightCommand,
                 SystemState, MotionState, LightState, RadioFrame, ActuatorFast, ActuatorSlow,
                 Odometer, Battery, BatteryAlarms, Version, VersionText>;

/// Foreign: not a data frame of this protocol (extended, remote, error or unknown id): ignore it.
/// TooShort: a known id with too few bytes. BadValue: a command byte outside its table.
/// BadChecksum: protocol V1 only.
enum class Verdict { Decoded, Foreign, TooShort, BadValue, BadChecksum };

struct Decoded {
  Verdict verdict = Verdict::Foreign;
  Message message{};
};

/// A frame longer than its table says is accepted.
constexpr Decoded decode(const CanFrame& frame, LeftStick order = LeftStick::UdLr) noexcept;

constexpr CanFrame encode(const MotionCommand& m) noexcept;
constexpr CanFrame encode(const ControlModeCommand& m) noexcept;
constexpr CanFrame encode(const ClearErrors& m) noexcept;
constexpr CanFrame encode(const LightCommand& m) noexcept;
constexpr CanFrame encode(const SystemState& m) noexcept;
constexpr CanFrame encode(const MotionState& m) noexcept;
constexpr CanFrame encode(const LightState& m) noexcept;
constexpr CanFrame encode(const RadioFrame& m, LeftStick order = LeftStick::UdLr) noexcept;
constexpr CanFrame encode(const ActuatorFast& m) noexcept;
constexpr CanFrame encode(const ActuatorSlow& m) noexcept;
constexpr CanFrame encode(const Odometer& m) noexcept;
constexpr CanFrame encode(const Battery& m) noexcept;
constexpr CanFrame encode(const BatteryAlarms& m) noexcept;
constexpr CanFrame encode(const Version& m) noexcept;
constexpr CanFrame encode(const VersionText& m) noexcept;
constexpr CanFrame encode(const VersionRequest& m) noexcept;

/// For the base's side: the question this frame asks, if it asks one.
constexpr std::optional<VersionRequest> version_request(const CanFrame& frame) noexcept;

/// A twist cut to the limits (both positive). A twist with a NaN or infinity becomes zero as a
/// whole: half of a broken command is not a command.
constexpr MotionCommand limited(base::BodyTwist twist, double max_linear_mps,
                                double max_angular_radps) noexcept;

/// Byte 0 of 0x241. Unknown is sent as 0; Middle on the two-way switches A and D as 1.
constexpr std::uint8_t pack_switches(base::Switch swa, base::Switch swb, base::Switch swc,
                                     base::Switch swd) noexcept;

/// One error bit: a stable word, and what to tell an operator.
struct ErrorBit {
  std::string_view word;
  std::string_view text;
};
using ErrorTable = std::array<ErrorBit, 16>;  ///< by bit of the big-endian error code

/// Current firmware.
inline constexpr ErrorTable kErrorBits{{
    {"battery_fault", "battery under-voltage fault"},
    {"battery_warning", "battery under-voltage warning"},
    {"rc_signal_loss", "radio transmitter signal lost"},
    {"motor_driver_1_lost", "motor driver 1 does not answer"},
    {"motor_driver_2_lost", "motor driver 2 does not answer"},
    {"motor_driver_3_lost", "motor driver 3 does not answer"},
    {"motor_driver_4_lost", "motor driver 4 does not answer"},
    {"bit7_reserved", "bit 7 (seen with e-stop)"},
    {"motor_driver_fault", "motor driver fault"},
    {"host_comm_lost", "host communication lost"},
    {"bit10_reserved", "bit 10"},
    {"bit11_reserved", "bit 11"},
    {"bit12_reserved", "bit 12"},
    {"bit13_reserved", "bit 13"},
    {"bit14_reserved", "bit 14"},
    {"bit15_reserved", "bit 15"},
}};

/// Older firmware knows one fault byte, the high one.
inline constexpr ErrorTable kOldErrorBits{{
    {"bit0_reserved", "bit 0"},
    {"bit1_reserved", "bit 1"},
    {"bit2_reserved", "bit 2"},
    {"bit3_reserved", "bit 3"},
    {"bit4_reserved", "bit 4"},
    {"bit5_reserved", "bit 5"},
    {"bit6_reserved", "bit 6"},
    {"bit7_reserved", "bit 7"},
    {"battery_fault", "battery under-voltage fault"},
    {"battery_warning", "battery under-voltage warning"},
    {"rc_signal_loss", "radio transmitter signal lost"},
    {"bit11_reserved", "bit 11"},
    {"bit12_reserved", "bit 12"},
    {"bit13_reserved", "bit 13"},
    {"bit14_reserved", "bit 14"},
    {"bit15_reserved", "bit 15"},
}};

/// Words for the bits of ActuatorSlow::driver_state, lowest first.
inline constexpr std::array<std::string_view, 8> kDriverFlags{
    "supply_voltage_low", "motor_overheat", "driver_overcurrent", "driver_overheat",
    "sensor_fault",       "driver_fault",   "driver_enabled",     "driver_reset"};

/// The bits of `code` that are set, lowest first.
struct ErrorBits {
  std::array<ErrorBit, 16> bit{};
  std::size_t size = 0;
  constexpr const ErrorBit* begin() const noexcept { return bit.data(); }
  constexpr const ErrorBit* end() const noexcept { return bit.data() + size; }
};
constexpr ErrorBits error_bits(std::uint16_t code, const ErrorTable& table = kErrorBits) noexcept;
/// Is the bit with this word set?
constexpr bool has_error(std::uint16_t code, std::string_view word,
                         const ErrorTable& table = kErrorBits) noexcept;

/// Byte 7 of every frame of protocol V1 (bunker/v1.hpp).
constexpr std::uint8_t v1_checksum(const CanFrame& frame) noexcept;

}  // namespace roverd::bunker

#include "bunker/codec_impl.hpp"
