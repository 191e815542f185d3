// What the driver finds wrong, and how it tells; the measurements of lights, motors and battery.

#include <algorithm>

#include "driver_fixture.hpp"
#include "hex.hpp"

namespace roverd::bunker {
namespace {

class BunkerDetailTest : public BunkerDriverTest {
 protected:
  base::DriverDetail detail() {
    now += 500ms;
    hear(encode(MotionState{}));
    driver->tick(now);
    return *status().detail;
  }
  bool hazard(const std::string& part) const {
    const auto last = measured<base::DriverStatus>().back().detail;
    return last && std::any_of(last->hazards.begin(), last->hazards.end(),
                               [&](const std::string& h) { return h.find(part) != h.npos; });
  }
};

TEST_F(BunkerDetailTest, EveryRefusalIsCountedByItsCause) {
  up(1);
  CanFrame f = encode(MotionState{});
  f.len = 7;
  hear(f);
  for (bool CanFrame::*flag : {&CanFrame::extended, &CanFrame::remote, &CanFrame::error}) {
    CanFrame other = encode(MotionState{});
    other.*flag = true;
    hear(other);
  }
  hear(frame(0x123, "00"));
  hear(frame(0x211, "00 01 FF FF 00 00 00 00"));
  hear(frame(0x441, "09"));
  hear(frame(0x421, "01"));
  const auto d = detail();
  const std::map<std::string, std::uint64_t> wanted{
      {"0x221 too short", 1},
      {"extended id", 1},
      {"remote frame", 1},
      {"error frame", 1},
      {"unknown id 0x123", 1},
      {"impossible value in 0x211: battery 6553.5 V", 1},
      {"0x441 with an unlisted code", 1},
      {"somebody else's command 0x421", 1}};
  EXPECT_EQ(d.counts, wanted);
  EXPECT_TRUE(d.hazards.empty());
}

TEST_F(BunkerDetailTest, AnImpossibleFrameIsNotBelievedAtAll) {
  up(1);
  const auto before = measured<base::BaseStatus>().size();
  hear(frame(0x211, "00 03 FF FF 00 00 00 00"));
  EXPECT_EQ(measured<base::BaseStatus>().size(), before);
  hear(frame(0x221, "7D 00 00 00 00 00 00 00"));
  EXPECT_EQ(measured<base::BaseMotion>().size(), 1u) << "32 m/s";
  // and such frames are no sign of life
  for (int i = 0; i < 30; ++i) {
    now += 20ms;
    hear(frame(0x221, "7D 00 00 00 00 00 00 00"));
    driver->tick(now);
  }
  EXPECT_EQ(status().phase, DriverPhase::Faulty);
}

TEST_F(BunkerDetailTest, RatesAndFactsAreTold) {
  up(1);
  detail();
  for (int i = 0; i < 25; ++i) round(off());
  const auto d = *status().detail;
  EXPECT_NEAR(d.rates_hz.at("0x221"), 50.0, 2.1);
  EXPECT_EQ(d.facts.at("protocol"), "V2");
  EXPECT_EQ(d.facts.at("control_mode"), "can");
  EXPECT_EQ(d.facts.at("vehicle_state"), "normal");
  EXPECT_EQ(d.facts.count("firmware"), 0u);
}

TEST_F(BunkerDetailTest, DetailIsMadeAtMostTwiceASecond) {
  up(1);
  detail();
  const auto first = status().detail;
  for (int i = 0; i < 24; ++i) round(off());
  EXPECT_EQ(status().detail, first);
  round(off());
  EXPECT_NE(status().detail, first);
}

TEST_F(BunkerDetailTest, TheFirmwareIsTextOfManyFrames) {
  up(1);
  for (const char* part : {"42 55 4E 4B 45 52 20 56", "32 2E 30 2E 31 00 00 00"}) {
    hear(frame(0x4A1, part));
  }
  EXPECT_EQ(detail().facts.at("firmware"), "BUNKER V2.0.1");
  now += 2s;
  hear(frame(0x4A1, "56 39 00 00 00 00 00 00"));
  EXPECT_EQ(detail().facts.at("firmware"), "V9") << "a new answer";
  for (int i = 0; i < 100; ++i) hear(frame(0x4A1, "41 41 41 41 41 41 41 41"));
  EXPECT_LE(detail().facts.at("firmware").size(), 128u);
}

TEST_F(BunkerDetailTest, TheFirmwareIsAskedForInBothFormsAndNotForEver) {
  asks_firmware = true;
  make(Params{});
  up(0);
  rounds(500, off());
  const auto text = frame(0x4A1, "01");
  const auto numbers = frame(0x411, "01");
  EXPECT_EQ(commands, (std::vector<CanFrame>{text, numbers, text, numbers}));
  driver->restart(now);
  up(0);
  commands.clear();
  rounds(60, off());
  hear(frame(0x4A1, "56 39 00 00 00 00 00 00"));
  rounds(200, off());
  EXPECT_EQ(commands, std::vector<CanFrame>{text}) << "it answered";
}

TEST_F(BunkerDetailTest, ABaseThatIsNotUpIsAskedNothing) {
  asks_firmware = true;
  make(Params{});
  driver->start(now);
  base_talks = false;
  rounds(200, off());
  EXPECT_TRUE(commands.empty());
}

TEST_F(BunkerDetailTest, ASecondCommanderIsAHazardForASecond) {
  up(1);
  driver->tick(now);
  const auto reports = measured<base::DriverStatus>().size();
  hear(frame(0x111, "00 96 00 00 00 00 00 00"));
  EXPECT_EQ(measured<base::DriverStatus>().size(), reports + 1) << "told at once";
  EXPECT_TRUE(hazard("somebody else sends motion commands (0x111)"));
  rounds(49, off());
  EXPECT_TRUE(hazard("somebody else"));
  rounds(1, off());
  EXPECT_FALSE(hazard("somebody else"));
  EXPECT_EQ(status().detail->counts.at("somebody else's command 0x111"), 1u);
}

TEST_F(BunkerDetailTest, SwappedSidesAreAHazard) {
  up(1);
  std::int32_t mm = 0;
  for (int i = 0; i < 110; ++i) {
    now += 20ms;
    hear(encode(MotionState{{.angular_radps = 0.5}}));
    hear(state(0, 1));
    mm += 3;
    hear(encode(Odometer{mm, -mm}));
    driver->tick(now);
  }
  EXPECT_TRUE(hazard("left and right are swapped"));
  driver->restart(now);
  up(1);
  driver->tick(now);
  EXPECT_FALSE(hazard("swapped")) << "somebody has looked at the cables";
}

TEST_F(BunkerDetailTest, AStateThatRepeatsItselfIsAHazard) {
  up(1);
  SystemState s;
  s.control_mode_raw = 1;
  for (std::uint8_t c = 0; c < 5; ++c) {
    s.count = c;
    hear(encode(s));
  }
  for (int i = 0; i < 12; ++i) {
    now += 100ms;
    hear(encode(s));
    hear(encode(MotionState{}));
    driver->tick(now);
  }
  EXPECT_TRUE(hazard("repeats itself"));
  EXPECT_GE(detail().counts.at("0x211 count frozen"), 1u);
}

TEST_F(BunkerDetailTest, ARefusalToHandOverIsSaidInWords) {
  up(0);
  rounds(50, ahead(0.3));
  EXPECT_EQ(detail().facts.at("control"), "asked for CAN control");
  for (int i = 0; i < 100; ++i) round(ahead(0.3));
  EXPECT_EQ(detail().facts.at("control"),
            "refused: asked for CAN control for more than 2 s, the base stays in standby");
  base_mode = 1;
  rounds(5, ahead(0.3));
  EXPECT_EQ(detail().facts.at("control"), "this computer drives");
  base_mode = 3;
  rounds(5, ahead(0.3));
  EXPECT_EQ(detail().facts.at("control"), "the radio took over");
  hear(state(1, 3));
  EXPECT_EQ(detail().facts.at("control"), "the emergency stop button at the base is pressed");
}

TEST_F(BunkerDetailTest, EachStateOfControlHasItsWords) {
  driver->start(now);
  now += 500ms;
  driver->tick(now);
  EXPECT_EQ(status().detail->facts.at("control"), "the base is not heard");
  up(0);
  EXPECT_EQ(detail().facts.at("control"), "nobody drives");
  const std::map<int, std::string> words{{1, "in CAN mode, this computer is silent"},
                                         {2, "a host on the serial port drives"},
                                         {3, "the radio drives"},
                                         {9, "the base does not tell its control mode"}};
  for (const auto& [mode, text] : words) {
    hear(state(0, mode));
    EXPECT_EQ(detail().facts.at("control"), text);
  }
}

TEST_F(BunkerDetailTest, LightsMotorsAndAlarmsAreMeasured) {
  up(1);
  hear(frame(0x231, "01 03 3C 00 00 00 00 09"));
  const auto lights = measured<base::LightState>().back();
  EXPECT_TRUE(lights.commanded);
  EXPECT_EQ(lights.front_mode, 3);
  EXPECT_EQ(lights.front_pct, 60);

  hear(frame(0x252, "FB 2E FF E1 7F FF FF FF"));
  EXPECT_FALSE(measured<base::MotorState>().back().supply_v) << "not told yet";
  hear(frame(0x262, "00 CD FF F9 FD 23 00 00"));
  const auto motor = measured<base::MotorState>().back();
  EXPECT_EQ(motor.motor, 2);
  EXPECT_EQ(motor.speed_rpm, -1234.0);
  EXPECT_EQ(motor.current_a, -3.1);
  EXPECT_EQ(motor.encoder_pulses, 2147483647);
  EXPECT_EQ(motor.supply_v, 20.5);
  EXPECT_EQ(motor.driver_temperature_c, -7.0);
  EXPECT_EQ(motor.motor_temperature_c, -3.0);
  EXPECT_EQ(motor.faults,
            (std::vector<std::string>{"supply voltage too low", "motor too hot", "driver error"}));

  hear(frame(0x254, "F8 30 00 7B 80 00 00 00"));
  hear(frame(0x264, "02 58 FF D8 80 10 00 00"));
  const auto fourth = measured<base::MotorState>().back();
  EXPECT_EQ(fourth.motor, 4);
  EXPECT_EQ(fourth.speed_rpm, -2000.0);
  EXPECT_EQ(fourth.supply_v, 60.0);
  EXPECT_EQ(fourth.faults, (std::vector<std::string>{"sensor fault or CAN link lost"}));
  hear(frame(0x253, "00 0A 00 7B 00 00 00 00"));
  EXPECT_EQ(measured<base::MotorState>().back().motor, 3);
  EXPECT_EQ(measured<base::MotorState>().back().speed_rpm, 10.0);

  hear(frame(0x362, "10 20 00 01 00 00 00 00"));
  EXPECT_TRUE(measured<base::BatteryState>().empty()) << "no charge is known";
  EXPECT_EQ(detail().facts.at("battery_alarms"), "alarm 1: 0x10, alarm 2: 0x20, warning 2: 0x01");
  hear(frame(0x361, "50 63 02 1C FF 85 01 3B"));
  EXPECT_EQ(measured<base::BatteryState>().back().alarms.size(), 3u);
  hear(frame(0x362, "00 00 00 00"));
  EXPECT_TRUE(measured<base::BatteryState>().back().alarms.empty()) << "told at once";
}

TEST_F(BunkerDetailTest, LightsCanBeSetWithinTheirRange) {
  const base::LightState wanted{.stamp = {},
                                .commanded = true,
                                .front_mode = 3,
                                .front_pct = 60,
                                .rear_mode = 2,
                                .rear_pct = 0};
  EXPECT_FALSE(driver->set_lights(wanted, now)) << "down";
  up(0);
  EXPECT_TRUE(driver->set_lights(wanted, now));
  now += 20ms;
  EXPECT_TRUE(driver->set_lights(wanted, now));
  wire.b->deliver(now);
  EXPECT_EQ(commands, (std::vector<CanFrame>{frame(0x121, "01 03 3C 02 00 00 00 00"),
                                             frame(0x121, "01 03 3C 02 00 00 00 01")}));
  for (int base::LightState::*field : {&base::LightState::front_mode, &base::LightState::front_pct,
                                       &base::LightState::rear_mode, &base::LightState::rear_pct}) {
    for (const int bad : {-1, 101}) {
      base::LightState wrong = wanted;
      wrong.*field = bad;
      EXPECT_FALSE(driver->set_lights(wrong, now + 1s));
    }
  }
}

TEST_F(BunkerDetailTest, ErrorsOfOneMotorCanBeCleared) {
  up(0);
  EXPECT_TRUE(driver->clear_errors(2, now));
  EXPECT_FALSE(driver->clear_errors(3, now));
  EXPECT_FALSE(driver->clear_errors(-1, now));
  wire.b->deliver(now);
  EXPECT_EQ(commands, std::vector<CanFrame>{encode(ClearErrors{2})});
}

}  // namespace
}  // namespace roverd::bunker
