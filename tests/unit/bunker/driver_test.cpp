// The driver's state machine and what it tells the robot.

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "driver_fixture.hpp"

namespace roverd::bunker {
namespace {

TEST_F(BunkerDriverTest, IsDownUntilStarted) {
  EXPECT_EQ(status().phase, DriverPhase::Down);
  driver->tick(now);
  driver->send(ahead(0.5), now);
  EXPECT_EQ(status().phase, DriverPhase::Down);
  EXPECT_TRUE(commands.empty());
}

TEST_F(BunkerDriverTest, OpensAndIsUpWithTheFirstFeedback) {
  driver->start(now);
  EXPECT_EQ(status().phase, DriverPhase::Opening);
  EXPECT_EQ(status().reason, "waiting for 0x211 or 0x221");
  hear(encode(RadioFrame{}));
  EXPECT_EQ(status().phase, DriverPhase::Opening) << "a transmitter is no base";
  hear(encode(MotionState{}));
  EXPECT_EQ(status().phase, DriverPhase::Up);
  EXPECT_EQ(status().reason, "");
  EXPECT_EQ(measured<base::DriverStatus>().back().phase, DriverPhase::Up) << "told at once";
}

/// Remembers what it was told before it was opened.
class ListeningLink final : public link::FrameLink {
 public:
  void attend(const std::vector<std::uint32_t>& ids) override { attended = ids; }
  base::Result<void> open() override {
    attended_at_open = attended;
    return {};
  }
  void close() noexcept override {}
  link::SendResult send(const CanFrame&) noexcept override { return link::SendResult::Sent; }
  std::string describe() const override { return "listening"; }
  std::vector<std::uint32_t> attended;
  std::vector<std::uint32_t> attended_at_open;
};

TEST(BunkerDriverLink, IsToldEveryIdOfBothProtocolsBeforeItIsOpenedAndNoOther) {
  auto made = std::make_unique<ListeningLink>();
  ListeningLink* const link = made.get();
  Driver one(
      "bunker", {}, [&] { return base::Result<std::unique_ptr<link::FrameLink>>(std::move(made)); },
      [](const base::Measurement&) {});
  one.start(Time{} + 1s);
  const auto& ids = link->attended_at_open;
  for (const std::uint32_t id :
       {0x111u, 0x121u, 0x211u, 0x221u, 0x231u, 0x241u, 0x251u, 0x252u, 0x261u,
        0x262u, 0x311u, 0x361u, 0x362u, 0x411u, 0x41Au, 0x421u, 0x441u, 0x4A1u,  // V2
        0x130u, 0x131u, 0x140u, 0x141u, 0x151u, 0x200u, 0x201u, 0x202u, 0x203u}) {
    EXPECT_EQ(std::count(ids.begin(), ids.end(), id), 1) << std::hex << id;
  }
  for (const std::uint32_t id : {0x000u, 0x123u, 0x5F0u, 0x7FFu}) {
    EXPECT_EQ(std::count(ids.begin(), ids.end(), id), 0) << std::hex << id;
  }
}

TEST_F(BunkerDriverTest, ALinkThatCannotBeMadeIsFaultyAndTriedAgain) {
  make_error = "no such interface";
  driver->start(now);
  EXPECT_EQ(status().phase, DriverPhase::Faulty);
  EXPECT_EQ(status().reason, "no such interface");
  make_error.clear();
  now += 499ms;
  driver->tick(now);
  EXPECT_EQ(status().phase, DriverPhase::Faulty);
  now += 1ms;
  driver->tick(now);
  EXPECT_EQ(status().phase, DriverPhase::Opening);
}

TEST_F(BunkerDriverTest, TheBackOffDoublesUpToItsLimit) {
  // 0.5 s ─▶ 1 s ─▶ 2 s ─▶ 4 s ─▶ 5 s ─▶ 5 s
  ours->refuse_open("the bus is down");
  driver->start(now);
  EXPECT_EQ(status().reason, "the bus is down");
  for (const auto wait : {500ms, 1000ms, 2000ms, 4000ms, 5000ms, 5000ms}) {
    const auto reports = measured<base::DriverStatus>().size();
    ours->refuse_open("still down at " + std::to_string(reports));
    now += wait - 1ms;
    driver->tick(now);
    EXPECT_EQ(status().reason.find("still down at " + std::to_string(reports)), std::string::npos);
    now += 1ms;
    driver->tick(now);
    EXPECT_EQ(status().reason, "still down at " + std::to_string(reports));
  }
  ours->refuse_open("");
  now += 5s;
  driver->tick(now);
  EXPECT_EQ(status().phase, DriverPhase::Opening);
}

TEST_F(BunkerDriverTest, HalfASecondOfSilenceIsALostBase) {
  up(1);
  now += 500ms;
  hear(encode(RadioFrame{}));
  driver->tick(now);
  EXPECT_EQ(status().phase, DriverPhase::Up);
  now += 1ms;
  driver->tick(now);
  EXPECT_EQ(status().phase, DriverPhase::Faulty);
  EXPECT_EQ(status().reason, "no 0x211 or 0x221 for 0.5 s");
  // When the base speaks again
  hear(encode(RadioFrame{}));
  EXPECT_EQ(status().phase, DriverPhase::Faulty) << "a transmitter is no base";
  hear(state(0, 0));
  EXPECT_EQ(status().phase, DriverPhase::Up);
}

TEST_F(BunkerDriverTest, AnOpenButSilentBusIsOpenedAgain) {
  driver->start(now);
  now += 5s;
  driver->tick(now);
  EXPECT_EQ(status().phase, DriverPhase::Opening);
  now += 1ms;
  driver->tick(now);
  EXPECT_EQ(status().phase, DriverPhase::Faulty);
  EXPECT_EQ(status().reason, "the bus is open but silent: no 0x211 or 0x221");
}

TEST_F(BunkerDriverTest, ARecordingIsNotBegunAgainInItsGaps) {
  Params p;
  p.silent_reopen_s = 0.0;
  make(p);
  driver->start(now);
  now += 3600s;
  driver->tick(now);
  EXPECT_TRUE(ours->is_open());
  EXPECT_EQ(status().phase, DriverPhase::Opening);
}

TEST_F(BunkerDriverTest, ALinkThatBreaksIsFaultyWithItsReason) {
  up(1);
  ours->fail("can0 went down");
  EXPECT_EQ(status().phase, DriverPhase::Faulty);
  EXPECT_EQ(status().reason, "can0 went down");
  now += 500ms;
  driver->tick(now);
  EXPECT_EQ(status().phase, DriverPhase::Opening);
}

TEST_F(BunkerDriverTest, RefusesABusWithBothProtocols) {
  up(1);
  CanFrame v1;
  v1.id = 0x151;
  v1.len = 8;
  v1.data = {0x00, 0x01, 0x00, 0xF5, 0x00, 0x00, 0x03, 0x53};
  hear(v1);
  EXPECT_EQ(status().phase, DriverPhase::Faulty);
  EXPECT_EQ(status().reason,
            "speaks protocols V1 (0x151) and V2 (0x221, 0x241) at once: will not drive it");
  driver->send(ahead(0.1), now);
  wire.b->deliver(now);
  EXPECT_TRUE(commands.empty());
}

TEST_F(BunkerDriverTest, TellsStateMotionAndBattery) {
  up(1);
  seen.clear();
  hear(state(1, 1, 0x0007));
  hear(encode(MotionState{{.linear_mps = 0.5, .angular_radps = -0.25}}));
  hear(encode(Battery{80, 99, 54.0, -12.3, 31.5}));

  const auto base = measured<base::BaseStatus>().at(0);
  EXPECT_EQ(base.stamp, now);
  EXPECT_EQ(base.vehicle_state, VehicleState::Estop);
  EXPECT_EQ(base.control_mode, ControlMode::Can);
  EXPECT_DOUBLE_EQ(base.battery_v.value(), 48.0);
  EXPECT_EQ(base.error_code, 7);
  EXPECT_EQ(base.errors.size(), 3u);
  EXPECT_EQ(base.errors.at(2), "radio transmitter signal lost");
  EXPECT_TRUE(base.radio_lost);
  EXPECT_TRUE(base.battery_fault);

  const auto motion = measured<base::BaseMotion>().at(0);
  EXPECT_DOUBLE_EQ(motion.twist.linear_mps, 0.5);
  EXPECT_DOUBLE_EQ(motion.twist.angular_radps, -0.25);

  const auto battery = measured<base::BatteryState>().at(0);
  EXPECT_EQ(battery.charge_pct, 80.0);
  EXPECT_DOUBLE_EQ(battery.voltage_v, 54.0);
  EXPECT_DOUBLE_EQ(battery.current_a.value(), -12.3);
  EXPECT_DOUBLE_EQ(battery.temperature_c.value(), 31.5);
}

TEST_F(BunkerDriverTest, ABatteryAboveAHundredPercentIsRefused) {
  up(1);
  hear(encode(Battery{101, 99, 54.0, 0.0, 20.0}));
  EXPECT_TRUE(measured<base::BatteryState>().empty());
  EXPECT_EQ(status().refused, 1u);
}

TEST_F(BunkerDriverTest, OlderFirmwareHasItsErrorBitsElsewhere) {
  Params p;
  p.error_table = "old";
  make(p);
  up(1);
  hear(state(0, 1, 0x0400));
  EXPECT_TRUE(measured<base::BaseStatus>().back().radio_lost);
  hear(state(0, 1, 0x0004));
  EXPECT_FALSE(measured<base::BaseStatus>().back().radio_lost);
}

TEST_F(BunkerDriverTest, ALeverBetweenDetentsKeepsItsLastPosition) {
  up(1);
  RadioFrame r;
  r.switches_raw = pack_switches(Switch::Up, Switch::Unknown, Switch::Middle, Switch::Down);
  r.right_lr = 25;
  r.right_ud = -60;
  r.left_ud = 127;
  r.left_lr = -128;
  r.vra = 100;
  r.count = 7;
  hear(encode(r));
  auto radio = measured<base::RadioState>().back();
  EXPECT_EQ(radio.swa, Switch::Up);
  EXPECT_EQ(radio.swb, Switch::Unknown) << "never seen yet";
  EXPECT_EQ(radio.swc, Switch::Middle);
  EXPECT_EQ(radio.swd, Switch::Down);
  EXPECT_DOUBLE_EQ(radio.right_lr, 0.25);
  EXPECT_DOUBLE_EQ(radio.right_ud, -0.6);
  EXPECT_DOUBLE_EQ(radio.left_ud, 1.0) << "cut to the range";
  EXPECT_DOUBLE_EQ(radio.left_lr, -1.0);
  EXPECT_DOUBLE_EQ(radio.vra, 1.0);
  EXPECT_EQ(radio.count, 7);

  r.switches_raw = pack_switches(Switch::Unknown, Switch::Down, Switch::Unknown, Switch::Unknown);
  hear(encode(r));
  radio = measured<base::RadioState>().back();
  EXPECT_EQ(radio.swa, Switch::Up);
  EXPECT_EQ(radio.swb, Switch::Down);
  EXPECT_EQ(radio.swc, Switch::Middle);
  EXPECT_EQ(radio.swd, Switch::Down);
}

TEST_F(BunkerDriverTest, TheOdometerBecomesTravelAndWildStepsAreCounted) {
  up(1);
  hear(encode(Odometer{1000, 1000}));
  now += 20ms;
  hear(encode(Odometer{1030, 1020}));
  const auto travel = measured<base::WheelTravel>();
  ASSERT_EQ(travel.size(), 1u);
  EXPECT_EQ(travel[0].stamp, now);
  EXPECT_DOUBLE_EQ(travel[0].left_m, 0.030);
  EXPECT_DOUBLE_EQ(travel[0].right_m, 0.020);
  now += 20ms;
  hear(encode(Odometer{9'000'000, 1040}));
  EXPECT_EQ(measured<base::WheelTravel>().size(), 1u);
  EXPECT_EQ(status().refused, 1u);
}

TEST_F(BunkerDriverTest, AfterALossTheOdometerBeginsAnew) {
  up(1);
  hear(encode(Odometer{1000, 1000}));
  now += 600ms;
  driver->tick(now);
  hear(state(0, 0));
  hear(encode(Odometer{1500, 1500}));
  EXPECT_TRUE(measured<base::WheelTravel>().empty()) << "who knows what happened in between";
}

TEST_F(BunkerDriverTest, CountsWhatItHeardAndWhatItRefused) {
  up(1);
  const auto before = status();
  CanFrame shorter = encode(MotionState{});
  shorter.len = 7;
  hear(shorter);
  CanFrame foreign = encode(MotionState{});
  foreign.extended = true;
  hear(foreign);
  now += 10ms;
  hear(encode(LightState{}));
  EXPECT_EQ(status().received, before.received + 1);
  EXPECT_EQ(status().refused, before.refused + 1);
  EXPECT_EQ(status().last_received, now);
}

TEST_F(BunkerDriverTest, RepeatsItsStatusTwiceASecond) {
  up(1);
  driver->tick(now);
  const auto before = measured<base::DriverStatus>().size();
  base_mode = 1;
  rounds(100, off());
  EXPECT_EQ(measured<base::DriverStatus>().size(), before + 4) << "in two seconds";
}

TEST(BunkerParams, WordsOutsideTheListAreRefusedByName) {
  Params p;
  EXPECT_TRUE(validate(p));
  p.rc_left_stick_order = "up_down";
  EXPECT_EQ(validate(p).error().fields.at(0).pointer, "rc_left_stick_order");
  EXPECT_THROW(Driver("bunker", p, {}, {}), std::invalid_argument);
  p = {};
  p.error_table = "new";
  EXPECT_EQ(validate(p).error().fields.at(0).pointer, "error_table");
}

TEST(BunkerParams, AreListedWithTheirRanges) {
  Params p;
  EXPECT_TRUE(base::set_param(p, "max_linear_mps", 1.0));
  EXPECT_FALSE(base::set_param(p, "max_linear_mps", 9.0));
  EXPECT_EQ(base::describe(p).size(), 16u);
}

}  // namespace
}  // namespace roverd::bunker
