// The device's end of each drive protocol: what it obeys, what it tells, when it stops by itself.

#include "sim/cart.hpp"

#include <gtest/gtest.h>

#include "ackermann/codec.hpp"
#include "bumper/codec.hpp"
#include "cart.hpp"
#include "ratio/codec.hpp"
#include "twist/binary.hpp"
#include "twist/text.hpp"

namespace roverd::sim {
namespace {

using ackermann::DriveMode;
using base::ControlMode;
using base::VehicleState;

std::array<std::uint8_t, 12> steer_order(float speed_mps, float wheel_rad, DriveMode mode) {
  return ackermann::encode({speed_mps, wheel_rad, mode});
}

std::string twist_order(double speed_mps, double turn_radps, bool enable = true) {
  return twist::encode_text(twist::Command{7, speed_mps, turn_radps, enable});
}

twist::Feedback feedback(const std::string& line) {
  const auto said = twist::parse_text(line.substr(0, line.size() - 2));
  const auto* f = std::get_if<twist::Feedback>(&said);
  return f != nullptr ? *f : twist::Feedback{};
}

ackermann::Message answer(const CartPlant& p) {
  const std::string& last = p.said.back();
  return ackermann::decode({reinterpret_cast<const std::uint8_t*>(last.data()), last.size()})
      .message;
}

TEST(AckermannCart, ObeysTheBytesOfTheSystemSheet) {
  Params params = ideal_cart("ackermann");
  params.drive.max_linear_mps = 2.0;
  CartPlant p(params);
  // 1.23 m/s, 0.2571 rad, autonomous
  const std::vector<int> bytes{0x10, 0x3F, 0x9D, 0x70, 0xA4, 0x20,
                               0x3E, 0x83, 0xA2, 0x9C, 0x30, 0x02};
  p.repeat(std::vector<std::uint8_t>(bytes.begin(), bytes.end()), 1s);
  EXPECT_NEAR(p.truth().twist.linear_mps, 1.23, 1e-6);
  EXPECT_NEAR(p.truth().wheel_rad, 0.2571, 1e-6);
  EXPECT_EQ(p.truth().control_mode, ControlMode::Can);
  EXPECT_EQ(p.truth().commands, 50u);
}

TEST(AckermannCart, StandsInParkAndAfterSilenceAndTheWheelStays) {
  CartPlant p(ideal_cart("ackermann"));
  p.repeat(steer_order(1.0F, 0.3F, DriveMode::Autonomous), 500ms);
  p.repeat(steer_order(1.0F, 0.0F, DriveMode::Park), 500ms);
  EXPECT_EQ(p.truth().twist.linear_mps, 0.0);
  EXPECT_NEAR(p.truth().wheel_rad, 0.3, 1e-6);
  EXPECT_EQ(p.truth().control_mode, ControlMode::Standby);
  p.repeat(steer_order(1.0F, 0.3F, DriveMode::Autonomous), 500ms);
  p.wait(250ms);
  EXPECT_GT(p.truth().twist.linear_mps, 0.9);  // the time-out is 0.3 s after the last datagram
  p.wait(300ms);
  EXPECT_EQ(p.truth().twist.linear_mps, 0.0);
}

TEST(AckermannCart, SendsItsCommandsLayoutBack) {
  CartPlant p(ideal_cart("ackermann"));
  p.repeat(steer_order(1.0F, 0.3F, DriveMode::Autonomous), 1s);
  ASSERT_EQ(p.said.size(), 50u);  // 50 Hz
  EXPECT_EQ(answer(p).mode, DriveMode::Autonomous);
  EXPECT_NEAR(answer(p).speed_mps, 1.0F, 1e-6F);
  EXPECT_NEAR(answer(p).wheel_rad, 0.3F, 1e-6F);
  p.wait(500ms);
  EXPECT_EQ(answer(p).mode, DriveMode::Park);
  EXPECT_EQ(answer(p).speed_mps, 0.0F);
}

TEST(AckermannCart, TellsNothingWhereItHasNoFeedback) {
  Params params = ideal_cart("ackermann");
  params.device.feedback_hz = 0.0;
  CartPlant p(params);
  p.repeat(steer_order(1.0F, 0.0F, DriveMode::Autonomous), 1s);
  EXPECT_TRUE(p.said.empty());
}

TEST(AckermannCart, DamagedDatagramsAreNoCommands) {
  CartPlant p(ideal_cart("ackermann"));
  p.repeat(std::string("\x10\x3f\x80"), 200ms);
  p.repeat(std::string(12, '\x10'), 200ms);
  EXPECT_EQ(p.truth().commands, 0u);
  EXPECT_EQ(p.truth().twist.linear_mps, 0.0);
}

TEST(AckermannCart, APersonWithTheTransmitterDrivesItAndItSaysSo) {
  CartPlant p(ideal_cart("ackermann"));
  Radio radio;
  radio.swb = base::Switch::Middle;
  radio.right_ud = 0.5;
  radio.left_lr = 1.0;  // right
  p.cart.set_radio(radio);
  p.repeat(steer_order(1.0F, 0.3F, DriveMode::Autonomous), 1s);
  EXPECT_NEAR(p.truth().twist.linear_mps, 0.6, 1e-6);  // half of 1.2 m/s
  EXPECT_NEAR(p.truth().wheel_rad, -0.7, 1e-6);
  EXPECT_EQ(answer(p).mode, DriveMode::Remote);
  p.fault([](Faults& f) { f.radio_loss = true; });
  p.repeat(steer_order(1.0F, 0.3F, DriveMode::Autonomous), 1s);
  EXPECT_NEAR(p.truth().twist.linear_mps, 1.0, 1e-6);
}

// 0.4 m between the wheels; "0.500 0.500": the right wheel 0.5, the left one 0.25 m/s.
// v = 0.375 m/s, ω = 0.25/0.4 = 0.625 rad/s.
TEST(RatioCart, TheFasterWheelAndTheRatioBecomeATwist) {
  Params params = ideal_cart("ratio");
  params.drive.track_width_m = 0.4;
  CartPlant p(params);
  p.repeat(std::string("0.500 0.500\n"), 1s);
  EXPECT_NEAR(p.truth().twist.linear_mps, 0.375, 1e-9);
  EXPECT_NEAR(p.truth().twist.angular_radps, 0.625, 1e-9);
  EXPECT_NEAR(p.truth().left_track_mps, 0.25, 1e-9);
  EXPECT_NEAR(p.truth().right_track_mps, 0.5, 1e-9);
  EXPECT_EQ(p.said.back(), "0.500 0.500\n");
}

TEST(RatioCart, HalfALineWaitsForItsRest) {
  CartPlant p(ideal_cart("ratio"));
  const auto put = [&](const std::string& text) {
    p.cart.receive({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  };
  put("0.5");
  EXPECT_EQ(p.truth().commands, 0u);
  put("00 0.000\n0.1 x\n");
  EXPECT_EQ(p.truth().commands, 1u);
}

TEST(RatioCart, StopsByItselfAfterHalfASecond) {
  Params params = ideal_cart("ratio");
  params.drive.command_timeout_s = 0.5;
  CartPlant p(params);
  p.repeat(std::string("0.500 0.000\n"), 1s);
  p.wait(460ms);
  EXPECT_NEAR(p.truth().twist.linear_mps, 0.5, 1e-9);
  p.wait(200ms);
  EXPECT_EQ(p.truth().twist.linear_mps, 0.0);
}

TEST(TwistCart, ObeysOnlyWhatIsEnabledAndAcknowledgesIt) {
  CartPlant p(ideal_cart("twist_text"));
  p.repeat(twist_order(0.5, 0.25, false), 500ms);
  EXPECT_EQ(p.truth().twist.linear_mps, 0.0);
  EXPECT_EQ(feedback(p.said.back()).status, 0);
  p.repeat(twist_order(0.5, 0.25), 500ms);
  EXPECT_NEAR(p.truth().twist.linear_mps, 0.5, 1e-9);
  EXPECT_NEAR(p.truth().twist.angular_radps, 0.25, 1e-9);
  const auto f = feedback(p.said.back());
  EXPECT_EQ(f.ack, 7);
  EXPECT_EQ(f.status, twist::kObeying);
  EXPECT_NEAR(f.speed_mps, 0.5, 1e-3);
  EXPECT_NEAR(f.turn_radps, 0.25, 1e-3);
  EXPECT_EQ(f.seq, 49);  // the fiftieth
  // 0.6 m between the tracks: they run at 0.425 and 0.575 m/s.
  EXPECT_NEAR(f.right_m - f.left_m, 0.15 * 0.5, 0.01);
}

TEST(TwistCart, ItsWatchdogStopsItAndSaysSo) {
  CartPlant p(ideal_cart("twist_text"));
  p.repeat(twist_order(0.5, 0.0), 500ms);
  p.wait(600ms);
  EXPECT_EQ(p.truth().twist.linear_mps, 0.0);
  EXPECT_EQ(feedback(p.said.back()).status, twist::kWatchdog);
  p.repeat(twist_order(0.5, 0.0), 500ms);  // the next command is enough
  EXPECT_NEAR(p.truth().twist.linear_mps, 0.5, 1e-9);
}

TEST(TwistCart, EmergencyStopAndMotorFaultBrakeAndAreTold) {
  CartPlant p(ideal_cart("twist_text"));
  p.repeat(twist_order(0.9, 0.0), 500ms);
  p.fault([](Faults& f) { f.estop = true; });
  p.repeat(twist_order(0.9, 0.0), 500ms);
  EXPECT_EQ(p.truth().twist.linear_mps, 0.0);
  EXPECT_EQ(p.truth().vehicle_state, VehicleState::Estop);
  EXPECT_TRUE(feedback(p.said.back()).estop);
  EXPECT_EQ(feedback(p.said.back()).status & twist::kObeying, 0);
  p.fault([](Faults& f) { f.error_bits = 8; });
  p.repeat(twist_order(0.9, 0.0), 500ms);
  EXPECT_EQ(p.truth().twist.linear_mps, 0.0);
  EXPECT_EQ(feedback(p.said.back()).status, twist::kMotorFault);
  p.cart.power_cycle();
  p.repeat(twist_order(0.9, 0.0), 500ms);
  EXPECT_NEAR(p.truth().twist.linear_mps, 0.9, 1e-9);
}

TEST(TwistCart, AnEmptyBatteryStopsIt) {
  CartPlant p(ideal_cart("twist_text"));
  p.cart.set_battery_pct(4.0);
  p.repeat(twist_order(0.5, 0.0), 500ms);
  EXPECT_EQ(p.truth().twist.linear_mps, 0.0);
  EXPECT_TRUE((feedback(p.said.back()).status & twist::kLowBattery) != 0);
}

TEST(TwistCart, SpeaksTheBinaryForm) {
  CartPlant p(ideal_cart("twist_binary"));
  p.repeat(twist::encode_binary(twist::Command{9, 0.4, -0.3, true}), 500ms);
  EXPECT_NEAR(p.truth().twist.linear_mps, 0.4, 1e-9);
  EXPECT_NEAR(p.truth().twist.angular_radps, -0.3, 1e-9);
  twist::Feedback got;
  const std::string& last = p.said.back();
  twist::BinaryDecoder().feed(
      {reinterpret_cast<const std::uint8_t*>(last.data()), last.size()},
      [&](const twist::Said& said) { got = std::get<twist::Feedback>(said); });
  EXPECT_EQ(got.ack, 9);
  EXPECT_NEAR(got.speed_mps, 0.4, 1e-3);
}

TEST(TwistCart, CommandsAreCutToWhatItCan) {
  Params params = ideal_cart("twist_text");
  params.drive.max_linear_mps = 0.6;
  params.drive.max_angular_radps = 1.0;
  CartPlant p(params);
  p.repeat(twist_order(3.0, -2.0), 1s);
  EXPECT_NEAR(p.truth().twist.linear_mps, 0.6, 1e-9);
  EXPECT_NEAR(p.truth().twist.angular_radps, -1.0, 1e-9);
}

TEST(CartFaults, ADeadDriveLinkPassesNothingInAndNothingOut) {
  CartPlant p(ideal_cart("twist_text"));
  p.fault([](Faults& f) { f.bus_off = true; });
  p.repeat(twist_order(0.5, 0.0), 500ms);
  EXPECT_EQ(p.truth().commands, 0u);
  EXPECT_TRUE(p.said.empty());
}

TEST(CartFaults, ALossTakesItsShareOfTheMessages) {
  CartPlant p(ideal_cart("twist_text"));
  p.fault([](Faults& f) { f.loss_to_base = f.loss_from_base = 0.25; });
  p.repeat(twist_order(0.5, 0.0), 20s);  // 1000 commands, 1000 reports
  EXPECT_NEAR(static_cast<double>(p.truth().commands), 750.0, 50.0);
  EXPECT_NEAR(static_cast<double>(p.said.size()), 750.0, 50.0);
}

TEST(CartFaults, TheBumperSpeaksTenTimesASecondAndAtEveryChange) {
  Params params = ideal_cart("twist_text");
  params.device.bumper = true;
  CartPlant p(params);
  p.wait(1s);
  EXPECT_EQ(p.bumper.size(), 11u);  // the first at once
  EXPECT_EQ(p.bumper.front(), "B,0*5E\r\n");
  p.bumper.clear();
  p.fault([](Faults& f) { f.bumper = 1; });
  p.wait(5ms);
  ASSERT_EQ(p.bumper.size(), 1u);
  EXPECT_EQ(p.bumper.front(), "B,1*5F\r\n");
  p.fault([](Faults& f) { f.bumper_silent = true; });
  p.bumper.clear();
  p.wait(1s);
  EXPECT_TRUE(p.bumper.empty());
}

TEST(CartFaults, EqualSeedsAndInputsGiveEqualBytes) {
  const auto told = [](std::uint64_t seed) {
    Params params = ideal_cart("twist_text");
    params.drive.slip_wander = 0.01;
    params.gnss.noise_scale = 1.0;
    CartPlant p(params, seed);
    std::string all;
    p.cart.on_gnss = [&](Bytes b, Time) { all.append(b.begin(), b.end()); };
    p.repeat(twist_order(0.5, 0.1), 5s);
    for (const auto& line : p.said) all += line;
    return all;
  };
  EXPECT_EQ(told(3), told(3));
  EXPECT_NE(told(3), told(4));
}

}  // namespace
}  // namespace roverd::sim
