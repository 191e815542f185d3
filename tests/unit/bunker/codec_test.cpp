#include "bunker/codec.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hex.hpp"

namespace roverd::bunker {
namespace {

using base::ControlMode;
using base::Switch;
using base::VehicleState;

template <class M>
M decoded(const CanFrame& f, LeftStick order = LeftStick::UdLr) {
  const Decoded d = decode(f, order);
  EXPECT_EQ(d.verdict, Verdict::Decoded);
  const M* m = std::get_if<M>(&d.message);
  EXPECT_NE(m, nullptr);
  return m != nullptr ? *m : M{};
}

std::vector<std::string> words(std::uint16_t code, const ErrorTable& table = kErrorBits) {
  std::vector<std::string> out;
  for (const ErrorBit& bit : error_bits(code, table)) out.emplace_back(bit.word);
  return out;
}

struct MotionCase {
  const char* hex;
  double linear_mps;
  double angular_radps;
};

TEST(BunkerCodec, MotionCommandsMatchTheTableInBothDirections) {
  for (const MotionCase& c : {MotionCase{"00 96 00 00 00 00 00 00", 0.15, 0.0},
                              MotionCase{"00 00 00 C8 00 00 00 00", 0.0, 0.2},
                              MotionCase{"FF 06 FE 70 00 00 00 00", -0.25, -0.4}}) {
    const CanFrame wire = frame(0x111, c.hex);
    const auto m = decoded<MotionCommand>(wire);
    EXPECT_DOUBLE_EQ(m.linear_mps, c.linear_mps) << c.hex;
    EXPECT_DOUBLE_EQ(m.angular_radps, c.angular_radps) << c.hex;
    EXPECT_EQ(m.lateral_mps, 0.0);
    EXPECT_EQ(m.steering_rad, 0.0);
    EXPECT_EQ(encode(m), wire) << c.hex;
  }
}

TEST(BunkerCodec, TheEstopFrameOfARealBaseIsUnderstood) {
  const CanFrame wire = frame(0x211, "01 00 01 00 00 80 00 00");
  const auto m = decoded<SystemState>(wire);
  EXPECT_EQ(m.vehicle_state(), VehicleState::Estop);
  EXPECT_EQ(m.vehicle_state_raw, 1);
  EXPECT_EQ(m.control_mode(), ControlMode::Standby);
  EXPECT_EQ(m.control_mode_raw, 0);
  EXPECT_DOUBLE_EQ(m.battery_v, 25.6);
  EXPECT_EQ(m.error_code, 128);
  EXPECT_EQ(words(m.error_code), std::vector<std::string>{"bit7_reserved"});
  EXPECT_EQ(m.count, 0);
  EXPECT_EQ(encode(m), wire);
}

TEST(BunkerCodec, SystemStateCarriesVoltageModeAndErrorWords) {
  const CanFrame wire = frame(0x211, "00 01 01 E7 00 06 00 11");
  const auto m = decoded<SystemState>(wire);
  EXPECT_EQ(m.vehicle_state(), VehicleState::Normal);
  EXPECT_EQ(m.control_mode(), ControlMode::Can);
  EXPECT_DOUBLE_EQ(m.battery_v, 48.7);
  EXPECT_EQ(m.error_code, 6);
  EXPECT_EQ(words(m.error_code), (std::vector<std::string>{"battery_warning", "rc_signal_loss"}));
  EXPECT_EQ(m.count, 17);
  EXPECT_EQ(encode(m), wire);
}

TEST(BunkerCodec, UnlistedStatesAndModesAreUnknown) {
  const auto m = decoded<SystemState>(frame(0x211, "03 04 00 00 00 00 00 00"));
  EXPECT_EQ(m.vehicle_state(), VehicleState::Unknown);
  EXPECT_EQ(m.control_mode(), ControlMode::Unknown);
  EXPECT_EQ(decoded<SystemState>(frame(0x211, "02 02 00 00 00 00 00 00")).vehicle_state(),
            VehicleState::Exception);
  EXPECT_EQ(decoded<SystemState>(frame(0x211, "00 02 00 00 00 00 00 00")).control_mode(),
            ControlMode::Uart);
  EXPECT_EQ(decoded<SystemState>(frame(0x211, "00 03 00 00 00 00 00 00")).control_mode(),
            ControlMode::Radio);
}

TEST(BunkerCodec, ErrorBitsOfOlderFirmwareSitInTheHighByte) {
  EXPECT_EQ(words(0x0500, kOldErrorBits),
            (std::vector<std::string>{"battery_fault", "rc_signal_loss"}));
  EXPECT_TRUE(has_error(0x0500, "rc_signal_loss", kOldErrorBits));
  EXPECT_FALSE(has_error(0x0500, "rc_signal_loss"));
  EXPECT_EQ(words(0xFFFF).size(), 16u);
}

TEST(BunkerCodec, MotionStateMatchesTheTable) {
  const CanFrame wire = frame(0x221, "02 DB FF CC 00 00 00 00");
  const auto m = decoded<MotionState>(wire);
  EXPECT_DOUBLE_EQ(m.linear_mps, 0.731);
  EXPECT_DOUBLE_EQ(m.angular_radps, -0.052);
  EXPECT_EQ(encode(m), wire);
}

TEST(BunkerCodec, LightsMatchTheTableInBothDirections) {
  const CanFrame wire = frame(0x231, "01 03 3C 00 00 00 00 09");
  const auto m = decoded<LightState>(wire);
  EXPECT_TRUE(m.enabled);
  EXPECT_EQ(m.front_mode, LightMode::Custom);
  EXPECT_EQ(m.front_value, 60);
  EXPECT_EQ(m.rear_mode, LightMode::Off);
  EXPECT_EQ(m.rear_value, 0);
  EXPECT_EQ(m.count, 9);
  EXPECT_EQ(encode(m), wire);

  LightCommand command;
  command.enabled = true;
  command.rear_mode = LightMode::Breathing;
  command.front_value = 200;
  EXPECT_EQ(encode(command), frame(0x121, "01 00 64 02 00 00 00 00")) << "brightness ends at 100";
  EXPECT_EQ(decoded<LightCommand>(encode(command)).rear_mode, LightMode::Breathing);
}

TEST(BunkerCodec, TheRadioFrameOfARealBaseIsUnderstood) {
  const CanFrame wire = frame(0x241, "AA 00 00 00 00 00 00 61");
  const auto m = decoded<RadioFrame>(wire);
  EXPECT_EQ(m.swa(), Switch::Up);
  EXPECT_EQ(m.swb(), Switch::Up);
  EXPECT_EQ(m.swc(), Switch::Up);
  EXPECT_EQ(m.swd(), Switch::Up);
  EXPECT_EQ(m.right_lr, 0);
  EXPECT_EQ(m.count, 97);
  EXPECT_EQ(encode(m), wire);
}

TEST(BunkerCodec, SwitchesSticksAndKnobMatchTheTable) {
  const CanFrame wire = frame(0x241, "97 19 C4 00 00 64 00 C8");
  const auto m = decoded<RadioFrame>(wire);
  EXPECT_EQ(m.swa(), Switch::Down);
  EXPECT_EQ(m.swb(), Switch::Middle);
  EXPECT_EQ(m.swc(), Switch::Middle);
  EXPECT_EQ(m.swd(), Switch::Up);
  EXPECT_EQ(m.right_lr, 25);
  EXPECT_EQ(m.right_ud, -60);
  EXPECT_EQ(m.vra, 100);
  EXPECT_EQ(m.count, 200);
  EXPECT_EQ(encode(m), wire);
  EXPECT_EQ(pack_switches(Switch::Down, Switch::Middle, Switch::Middle, Switch::Up), 0x97);
}

TEST(BunkerCodec, ALeverBetweenDetentsIsUnknown) {
  const auto m = decoded<RadioFrame>(frame(0x241, "E1 00 00 00 00 00 00 C9"));
  EXPECT_EQ(m.swa(), Switch::Unknown);
  EXPECT_EQ(m.swb(), Switch::Unknown);
  EXPECT_EQ(m.swc(), Switch::Up);
  EXPECT_EQ(m.swd(), Switch::Down);
  EXPECT_EQ(m.count, 201);
  EXPECT_EQ(pack_switches(Switch::Middle, Switch::Unknown, Switch::Up, Switch::Down), 0xE1);
}

TEST(BunkerCodec, TheOrderOfTheLeftStickIsAParameter) {
  const CanFrame wire = frame(0x241, "AA 00 00 0A F6 00 00 01");
  EXPECT_EQ(decoded<RadioFrame>(wire).left_ud, 10);
  EXPECT_EQ(decoded<RadioFrame>(wire).left_lr, -10);
  const auto swapped = decoded<RadioFrame>(wire, LeftStick::LrUd);
  EXPECT_EQ(swapped.left_ud, -10);
  EXPECT_EQ(swapped.left_lr, 10);
  EXPECT_EQ(encode(swapped, LeftStick::LrUd), wire);
}

TEST(BunkerCodec, ActuatorFastFramesMatchTheTable) {
  const CanFrame first = frame(0x251, "04 D2 00 39 FF FE 79 60");
  const auto a = decoded<ActuatorFast>(first);
  EXPECT_EQ(a.motor, 1);
  EXPECT_EQ(a.rpm, 1234);
  EXPECT_DOUBLE_EQ(a.current_a, 5.7);
  EXPECT_EQ(a.pulses, -100000);
  EXPECT_EQ(encode(a), first);

  const CanFrame second = frame(0x252, "FB 2E FF E1 7F FF FF FF");
  const auto b = decoded<ActuatorFast>(second);
  EXPECT_EQ(b.motor, 2);
  EXPECT_EQ(b.rpm, -1234);
  EXPECT_DOUBLE_EQ(b.current_a, -3.1);
  EXPECT_EQ(b.pulses, 2147483647);
  EXPECT_EQ(encode(b), second);
}

TEST(BunkerCodec, ActuatorSlowFramesMatchTheTable) {
  const CanFrame first = frame(0x261, "01 EB 00 26 29 40 00 00");
  const auto a = decoded<ActuatorSlow>(first);
  EXPECT_EQ(a.motor, 1);
  EXPECT_DOUBLE_EQ(a.driver_voltage_v, 49.1);
  EXPECT_EQ(a.driver_temp_c, 38);
  EXPECT_EQ(a.motor_temp_c, 41);
  EXPECT_EQ(a.driver_state, 64);
  EXPECT_EQ(kDriverFlags[6], "driver_enabled");
  EXPECT_EQ(encode(a), first);

  const CanFrame second = frame(0x262, "00 CD FF F9 FD 23 00 00");
  const auto b = decoded<ActuatorSlow>(second);
  EXPECT_EQ(b.motor, 2);
  EXPECT_DOUBLE_EQ(b.driver_voltage_v, 20.5);
  EXPECT_EQ(b.driver_temp_c, -7);
  EXPECT_EQ(b.motor_temp_c, -3);
  EXPECT_EQ(b.driver_state, 0b100011) << "supply low, motor hot, driver fault";
  EXPECT_EQ(encode(b), second);
}

TEST(BunkerCodec, ThirdAndFourthMotorHaveTheSameLayout) {
  // Big endian: -2000 rpm, 12.3 A, -2147483648 pulses; 9 bytes would be one too many for CAN.
  const CanFrame third = frame(0x253, "F8 30 00 7B 80 00 00 00");
  const auto a = decoded<ActuatorFast>(third);
  EXPECT_EQ(a.motor, 3);
  EXPECT_EQ(a.rpm, -2000);
  EXPECT_DOUBLE_EQ(a.current_a, 12.3);
  EXPECT_EQ(a.pulses, std::numeric_limits<std::int32_t>::min());
  EXPECT_EQ(encode(a), third);
  EXPECT_EQ(decoded<ActuatorFast>(frame(0x254, "00 01 FF FF 00 00 00 01")).motor, 4);
  EXPECT_DOUBLE_EQ(decoded<ActuatorFast>(frame(0x254, "00 01 FF FF 00 00 00 01")).current_a, -0.1);

  const CanFrame fourth = frame(0x264, "02 58 FF D8 80 10 00 00");
  const auto b = decoded<ActuatorSlow>(fourth);
  EXPECT_EQ(b.motor, 4);
  EXPECT_DOUBLE_EQ(b.driver_voltage_v, 60.0);
  EXPECT_EQ(b.driver_temp_c, -40);
  EXPECT_EQ(b.motor_temp_c, -128);
  EXPECT_EQ(b.driver_state, 0x10);
  EXPECT_EQ(encode(b), fourth);
  EXPECT_EQ(decoded<ActuatorSlow>(frame(0x263, "01 EB 00 26 29 40 FF FF")).motor, 3);
}

TEST(BunkerCodec, TheOdometerKeepsItsExtremes) {
  const CanFrame near = frame(0x311, "00 00 30 39 FF FF CF C7");
  EXPECT_EQ(decoded<Odometer>(near).left_mm, 12345);
  EXPECT_EQ(decoded<Odometer>(near).right_mm, -12345);
  EXPECT_EQ(encode(decoded<Odometer>(near)), near);
  const CanFrame far = frame(0x311, "80 00 00 00 7F FF FF FF");
  EXPECT_EQ(decoded<Odometer>(far).left_mm, -2147483647 - 1);
  EXPECT_EQ(decoded<Odometer>(far).right_mm, 2147483647);
  EXPECT_EQ(encode(decoded<Odometer>(far)), far);
}

TEST(BunkerCodec, BatteryFramesMatchTheTable) {
  const CanFrame wire = frame(0x361, "50 63 02 1C FF 85 01 3B");
  const auto m = decoded<Battery>(wire);
  EXPECT_EQ(m.soc_pct, 80);
  EXPECT_EQ(m.soh_pct, 99);
  EXPECT_DOUBLE_EQ(m.voltage_v, 54.0);
  EXPECT_DOUBLE_EQ(m.current_a, -12.3);
  EXPECT_DOUBLE_EQ(m.temperature_c, 31.5);
  EXPECT_EQ(encode(m), wire);

  const CanFrame alarms = frame(0x362, "10 20 00 01 00 00 00 00");
  const auto a = decoded<BatteryAlarms>(alarms);
  EXPECT_EQ(a.alarm1, 16);
  EXPECT_EQ(a.alarm2, 32);
  EXPECT_EQ(a.warn1, 0);
  EXPECT_EQ(a.warn2, 1);
  EXPECT_EQ(encode(a), alarms);
  EXPECT_EQ(decode(frame(0x362, "10 20 00 01")).verdict, Verdict::Decoded) << "four bytes do";
}

TEST(BunkerCodec, ModeAndErrorCommandsAreEightBytesLong) {
  EXPECT_EQ(encode(ControlModeCommand{RequestedMode::Can}),
            frame(0x421, "01 00 00 00 00 00 00 00"));
  EXPECT_EQ(encode(ControlModeCommand{RequestedMode::Standby}),
            frame(0x421, "00 00 00 00 00 00 00 00"));
  EXPECT_EQ(encode(ClearErrors{}), frame(0x441, "00 00 00 00 00 00 00 00"));
  EXPECT_EQ(decoded<ControlModeCommand>(frame(0x421, "01")).mode, RequestedMode::Can);
  EXPECT_EQ(decoded<ClearErrors>(frame(0x441, "02")).which, 2);
  EXPECT_EQ(decode(frame(0x421, "03")).verdict, Verdict::BadValue);
  EXPECT_EQ(decode(frame(0x441, "05")).verdict, Verdict::BadValue);
}

TEST(BunkerCodec, ForeignFramesAreIgnoredEvenWithAKnownId) {
  CanFrame f = frame(0x211, "00 01 01 E7 00 06 00 11");
  f.extended = true;
  EXPECT_EQ(decode(f).verdict, Verdict::Foreign);
  f.extended = false;
  f.remote = true;
  EXPECT_EQ(decode(f).verdict, Verdict::Foreign);
  f.remote = false;
  f.error = true;
  EXPECT_EQ(decode(f).verdict, Verdict::Foreign);
  for (const std::uint32_t other : {0x000u, 0x250u, 0x255u, 0x260u, 0x265u, 0x291u, 0x7FFu}) {
    EXPECT_EQ(decode(frame(other, "00 00 00 00 00 00 00 00")).verdict, Verdict::Foreign) << other;
  }
}

TEST(BunkerCodec, AShortFrameIsDroppedWhateverItsId) {
  for (const std::uint32_t known :
       {0x111u, 0x121u, 0x211u, 0x221u, 0x231u, 0x241u, 0x251u, 0x252u, 0x253u, 0x254u, 0x261u,
        0x262u, 0x263u, 0x264u, 0x311u, 0x361u}) {
    EXPECT_EQ(decode(frame(known, "00 00 00 00 00 00 00")).verdict, Verdict::TooShort) << known;
  }
  EXPECT_EQ(decode(frame(0x362, "00 00 00")).verdict, Verdict::TooShort);
  EXPECT_EQ(decode(frame(0x421, "")).verdict, Verdict::TooShort);
  EXPECT_EQ(decode(frame(0x441, "")).verdict, Verdict::TooShort);
}

TEST(BunkerCodec, CommandsAreRoundedToTheNearestMillimetrePerSecond) {
  const auto first_two = [](double v) {
    const CanFrame f = encode(limited({.linear_mps = v, .angular_radps = 0.0}, 100.0, 1.0));
    return decoded<MotionCommand>(f).linear_mps;
  };
  EXPECT_DOUBLE_EQ(first_two(0.0004), 0.0);
  EXPECT_DOUBLE_EQ(first_two(0.0006), 0.001);
  EXPECT_DOUBLE_EQ(first_two(-0.0006), -0.001);
  EXPECT_DOUBLE_EQ(first_two(0.7853), 0.785);
  EXPECT_DOUBLE_EQ(first_two(99.0), 32.767) << "the wire's own range";
  EXPECT_DOUBLE_EQ(first_two(-99.0), -32.768);
}

TEST(BunkerCodec, CommandsAreCutToTheLimits) {
  const MotionCommand m = limited({.linear_mps = 2.0, .angular_radps = -3.0}, 1.5, 0.7853);
  EXPECT_EQ(m.linear_mps, 1.5);
  EXPECT_EQ(m.angular_radps, -0.7853);
}

TEST(BunkerCodec, ABrokenCommandBecomesZeroAsAWhole) {
  const CanFrame zero = frame(0x111, "00 00 00 00 00 00 00 00");
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    EXPECT_EQ(encode(limited({.linear_mps = bad, .angular_radps = 0.5}, 1.5, 1.0)), zero);
    EXPECT_EQ(encode(limited({.linear_mps = 0.5, .angular_radps = bad}, 1.5, 1.0)), zero);
    MotionCommand unlimited;
    unlimited.linear_mps = bad;
    EXPECT_EQ(encode(unlimited), zero);
  }
}

TEST(BunkerCodec, VersionsOfBothFormsAreRead) {
  const CanFrame numbers = frame(0x41A, "00 02 00 01 01 00 00 07");
  EXPECT_EQ(decoded<Version>(numbers).number, (std::array<std::uint16_t, 4>{2, 1, 256, 7}));
  EXPECT_EQ(encode(decoded<Version>(numbers)), numbers);
  const CanFrame text = frame(0x4A1, "42 55 4E 4B 45 52 20 56");
  EXPECT_EQ(decoded<VersionText>(text).text[0], 'B');
  EXPECT_EQ(encode(decoded<VersionText>(text)), text);
}

}  // namespace
}  // namespace roverd::bunker
