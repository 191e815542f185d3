// Protocol V1: the codec against the fact sheet's vectors, and the driver speaking it.

#include "bunker/v1.hpp"

#include <cmath>
#include <string>

#include "driver_fixture.hpp"
#include "hex.hpp"

namespace roverd::bunker {
namespace {

template <class M>
M decoded_v1(const CanFrame& f) {
  const v1::Decoded d = v1::decode(f);
  EXPECT_EQ(d.verdict, Verdict::Decoded);
  const M* m = std::get_if<M>(&d.message);
  EXPECT_NE(m, nullptr);
  return m != nullptr ? *m : M{};
}

TEST(BunkerV1, CommandsMatchTheTableInBothDirections) {
  const CanFrame ahead = frame(0x130, "01 00 0A 00 00 00 00 44");
  EXPECT_EQ(decoded_v1<v1::Command>(ahead).linear_pct, 10);
  EXPECT_EQ(v1::encode(decoded_v1<v1::Command>(ahead)), ahead);
  const CanFrame bend = frame(0x130, "01 00 E7 19 00 00 42 7C");
  const auto m = decoded_v1<v1::Command>(bend);
  EXPECT_EQ(m.mode, v1::RequestedMode::Can);
  EXPECT_EQ(m.linear_pct, -25);
  EXPECT_EQ(m.angular_pct, 25);
  EXPECT_EQ(m.count, 0x42);
  EXPECT_EQ(v1::encode(m), bend);
}

TEST(BunkerV1, FeedbackMatchesTheTableInBothDirections) {
  const CanFrame state = frame(0x151, "00 01 00 F5 00 00 03 53");
  const auto s = decoded_v1<v1::SystemState>(state);
  EXPECT_EQ(s.vehicle_state(), VehicleState::Normal);
  EXPECT_EQ(s.control_mode(), ControlMode::Can);
  EXPECT_DOUBLE_EQ(s.battery_v, 24.5);
  EXPECT_EQ(s.error_code, 0);
  EXPECT_EQ(s.count, 3);
  EXPECT_EQ(v1::encode(s), state);

  const CanFrame motion = frame(0x131, "01 2C FF 9C 00 00 07 09");
  const auto m = decoded_v1<v1::MotionState>(motion);
  EXPECT_DOUBLE_EQ(m.linear_mps, 0.3);
  EXPECT_DOUBLE_EQ(m.angular_radps, -0.1);
  EXPECT_EQ(m.count, 7);
  EXPECT_EQ(v1::encode(m), motion);

  const CanFrame motor = frame(0x200, "FF F1 03 E8 23 28 01 31");
  const auto w = decoded_v1<v1::Motor>(motor);
  EXPECT_EQ(w.motor, 1);
  EXPECT_DOUBLE_EQ(w.current_a, -1.5);
  EXPECT_EQ(w.rpm, 1000);
  EXPECT_EQ(w.driver_temp_c, 35);
  EXPECT_EQ(w.motor_temp_c, 40);
  EXPECT_EQ(v1::encode(w), motor);
}

TEST(BunkerV1, LightsAreSealedLikeEverythingElse) {
  v1::LightState lights;
  lights.enabled = true;
  lights.front_mode = LightMode::Custom;
  lights.front_value = 60;
  lights.count = 9;
  const CanFrame f = v1::encode(lights);
  EXPECT_EQ(f.id, 0x141u);
  EXPECT_EQ(f.data[6], 9);
  EXPECT_EQ(decoded_v1<v1::LightState>(f).front_value, 60);
  EXPECT_EQ(decoded_v1<v1::LightState>(f).count, 9);
  EXPECT_EQ(v1::encode(v1::LightCommand{lights}).id, 0x140u);
}

TEST(BunkerV1, WhatIsNotIntactIsRefused) {
  EXPECT_EQ(v1::decode(frame(0x151, "00 01 00 F5 00 00 03 00")).verdict, Verdict::BadChecksum);
  EXPECT_EQ(v1::decode(frame(0x151, "00 01 00 F5 00 00 03")).verdict, Verdict::TooShort);
  EXPECT_EQ(v1::decode(v1::encode(v1::Command{.mode = static_cast<v1::RequestedMode>(3)})).verdict,
            Verdict::BadValue);
  EXPECT_EQ(v1::decode(frame(0x204, "00 00 00 00 00 00 00 00")).verdict, Verdict::Foreign);
  CanFrame remote = frame(0x151, "00 01 00 F5 00 00 03 53");
  remote.remote = true;
  EXPECT_EQ(v1::decode(remote).verdict, Verdict::Foreign);
}

TEST(BunkerV1, PercentIsTheNearestThatDoesNotExceedTheLimit) {
  EXPECT_EQ(v1::percent(0.15, 3.0, 1.5), 5);
  EXPECT_EQ(v1::percent(0.10, 3.0, 1.5), 3);
  EXPECT_EQ(v1::percent(-0.10, 3.0, 1.5), -3);
  EXPECT_EQ(v1::percent(1.5, 3.0, 1.5), 50);
  EXPECT_EQ(v1::percent(1.49, 3.0, 1.49), 49) << "50 would be faster than 1.49 m/s";
  EXPECT_EQ(v1::percent(-9.0, 3.0, 1.49), -49);
  EXPECT_EQ(v1::percent(9.0, 3.0, 9.0), 100);
  EXPECT_EQ(v1::percent(std::nan(""), 3.0, 1.5), 0);
}

class BunkerV1DriverTest : public BunkerDriverTest {
 protected:
  void hear_v1(int mode, int vehicle = 0, std::uint16_t errors = 0) {
    hear(v1::encode(v1::SystemState{static_cast<std::uint8_t>(vehicle),
                                    static_cast<std::uint8_t>(mode), 24.5, errors, count++}));
    hear(v1::encode(v1::MotionState{0.3, -0.1, count}));
  }
  void up_v1(int mode) {
    driver->start(now);
    base_talks = false;
    v1_mode = mode;
    hear_v1(mode);
  }
  void rounds_v1(int n, const base::DriveCommand& command) {
    for (int i = 0; i < n; ++i) {
      hear_v1(v1_mode);
      round(command);
    }
  }
  std::vector<v1::Command> said() const {
    std::vector<v1::Command> out;
    for (const CanFrame& f : commands) out.push_back(decoded_v1<v1::Command>(f));
    return out;
  }
  std::uint8_t count = 0;
  int v1_mode = 0;
};

TEST_F(BunkerV1DriverTest, IsRecognisedByAnIntactSystemState) {
  driver->start(now);
  CanFrame broken = v1::encode(v1::SystemState{});
  ++broken.data[7];
  hear(broken);
  hear(v1::encode(v1::MotionState{}));
  EXPECT_EQ(status().phase, DriverPhase::Opening) << "0x131 alone may be anything";
  hear(v1::encode(v1::SystemState{}));
  EXPECT_EQ(status().phase, DriverPhase::Up);
  now += 500ms;
  driver->tick(now);
  EXPECT_EQ(status().detail->facts.at("protocol"), "V1");
  EXPECT_EQ(status().detail->counts.at("0x151 with a wrong checksum"), 1u);
}

TEST_F(BunkerV1DriverTest, ItsFramesBecomeTheSameMeasurements) {
  up_v1(1);
  hear_v1(1, 2, 0x1001);
  const auto s = measured<base::BaseStatus>().back();
  EXPECT_EQ(s.vehicle_state, VehicleState::Exception);
  EXPECT_EQ(s.control_mode, ControlMode::Can);
  EXPECT_DOUBLE_EQ(s.battery_v.value(), 24.5);
  EXPECT_TRUE(s.radio_lost);
  EXPECT_TRUE(s.battery_fault);
  EXPECT_DOUBLE_EQ(measured<base::BaseMotion>().back().twist.linear_mps, 0.3);
  hear(v1::encode(v1::Motor{2, -1.5, 1000, 35, 40, 1}));
  const auto m = measured<base::MotorState>().back();
  EXPECT_EQ(m.motor, 2);
  EXPECT_EQ(m.speed_rpm, 1000.0);
  EXPECT_EQ(m.current_a, -1.5);
  EXPECT_EQ(m.driver_temperature_c, 35.0);
  EXPECT_EQ(m.motor_temperature_c, 40.0);
  EXPECT_FALSE(m.supply_v);
  v1::LightState lights;
  lights.front_mode = LightMode::On;
  hear(v1::encode(lights));
  EXPECT_EQ(measured<base::LightState>().back().front_mode, 1);
}

TEST_F(BunkerV1DriverTest, IsAskedForCanModeAndThenDrivenInPercent) {
  up_v1(0);
  EXPECT_EQ(measured<base::BaseStatus>().back().control_mode, ControlMode::Standby);
  rounds_v1(50, ahead(0.3));
  ASSERT_EQ(said().size(), 2u) << "a request each half second";
  EXPECT_EQ(said()[0].mode, v1::RequestedMode::Can);
  EXPECT_EQ(said()[0].linear_pct, 0);
  commands.clear();
  v1_mode = 1;
  rounds_v1(10, ahead(0.3, -0.5));
  ASSERT_EQ(commands.size(), 10u);
  EXPECT_EQ(said().back().linear_pct, 10);
  EXPECT_EQ(said().back().angular_pct, -20);
  EXPECT_EQ(said()[9].count, said()[8].count + 1);
  EXPECT_EQ(driver->gate_counts().refused_total(), 0u);
}

TEST_F(BunkerV1DriverTest, StaysWithinTheLimitsAndSteps) {
  up_v1(1);
  rounds_v1(30, ahead(9.0, 9.0));
  EXPECT_EQ(said().back().linear_pct, 50);
  EXPECT_EQ(said().back().angular_pct, 31);
  rounds_v1(30, ahead(-9.0, -9.0));
  EXPECT_EQ(said().back().linear_pct, -50);
  EXPECT_EQ(driver->gate_counts().refused_total(), 0u);
}

TEST_F(BunkerV1DriverTest, StopsWithZerosThenModeZero) {
  up_v1(1);
  rounds_v1(5, ahead(0.3));
  commands.clear();
  rounds_v1(50, off());
  ASSERT_EQ(said().size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(said()[i].linear_pct, 0) << i;
  EXPECT_EQ(said()[4].mode, v1::RequestedMode::Can);
  EXPECT_EQ(said()[5].mode, v1::RequestedMode::Radio);
}

TEST_F(BunkerV1DriverTest, StoppingTheDriverSendsSealedStops) {
  up_v1(1);
  rounds_v1(5, ahead(0.3));
  commands.clear();
  ours->set_immediate([this] { return now; });
  driver->stop(now);
  ASSERT_EQ(said().size(), 4u);
  for (const auto& c : said()) {
    EXPECT_EQ(c.mode, v1::RequestedMode::Radio);
    EXPECT_EQ(c.linear_pct, 0);
  }
}

TEST_F(BunkerV1DriverTest, ABaseThatLeavesCanModeWasTakenByTheRadio) {
  up_v1(1);
  rounds_v1(5, ahead(0.3));
  commands.clear();
  v1_mode = 0;
  rounds_v1(99, ahead(0.3));
  EXPECT_EQ(measured<base::BaseStatus>().back().control_mode, ControlMode::Radio);
  EXPECT_EQ(status().detail->facts.at("control"), "the radio took over");
  EXPECT_TRUE(commands.empty()) << "no fight";
  // When two seconds are over, it is asked again: V1 does not tell who has it
  rounds_v1(3, ahead(0.3));
  EXPECT_EQ(measured<base::BaseStatus>().back().control_mode, ControlMode::Standby);
  EXPECT_EQ(commands.size(), 1u);
}

TEST_F(BunkerV1DriverTest, SilenceIsSaidInItsOwnIds) {
  up_v1(1);
  now += 501ms;
  driver->tick(now);
  EXPECT_EQ(status().reason, "no 0x131 or 0x151 for 0.5 s");
}

TEST_F(BunkerV1DriverTest, ClearsAllKindsOfErrorsOneAfterTheOther) {
  up_v1(0);
  EXPECT_TRUE(driver->clear_errors(0, now));
  rounds_v1(300, off());
  ASSERT_EQ(said().size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(said()[i].clear, i + 1);
  commands.clear();
  EXPECT_TRUE(driver->clear_errors(2, now));
  rounds_v1(60, off());
  ASSERT_EQ(said().size(), 1u);
  EXPECT_EQ(said()[0].clear, 4);
}

TEST_F(BunkerV1DriverTest, LightsAreSentInItsOwnFrame) {
  up_v1(0);
  EXPECT_TRUE(driver->set_lights({.stamp = {}, .commanded = true, .front_mode = 1}, now));
  wire.b->deliver(now);
  ASSERT_EQ(sent(0x140).size(), 1u);
  EXPECT_EQ(decoded_v1<v1::LightCommand>(sent(0x140)[0]).front_mode, LightMode::On);
}

TEST_F(BunkerV1DriverTest, AfterBothProtocolsOneMustSpeakAloneForASecond) {
  up_v1(1);
  hear(encode(MotionState{}));
  EXPECT_EQ(status().phase, DriverPhase::Faulty);
  now += 500ms;
  driver->tick(now);
  EXPECT_EQ(status().phase, DriverPhase::Opening);
  hear_v1(1);
  now += 999ms;
  hear_v1(1);
  EXPECT_EQ(status().phase, DriverPhase::Opening) << "the other may speak again";
  now += 1ms;
  hear_v1(1);
  EXPECT_EQ(status().phase, DriverPhase::Up);
}

TEST_F(BunkerV1DriverTest, A0x211IsTheAnswerToASettingAndNoState) {
  up_v1(1);
  const auto before = measured<base::BaseStatus>().size();
  hear(state(1, 3));
  EXPECT_EQ(measured<base::BaseStatus>().size(), before);
  EXPECT_EQ(status().phase, DriverPhase::Up);
}

TEST_F(BunkerV1DriverTest, ASecondCommanderIsAHazard) {
  up_v1(1);
  hear(v1::encode(v1::Command{.mode = v1::RequestedMode::Can, .linear_pct = 10}));
  ASSERT_EQ(status().detail->hazards.size(), 1u);
  EXPECT_EQ(status().detail->hazards[0], "somebody else sends motion commands (0x130)");
}

}  // namespace
}  // namespace roverd::bunker
