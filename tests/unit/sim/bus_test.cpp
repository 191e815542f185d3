// What travels on the bus: bytes, periods, faults, repeatability.

#include <gtest/gtest.h>

#include "plant.hpp"
#include "sim/reports.hpp"

namespace roverd::sim {
namespace {

TEST(Bus, SwitchesAndSticksMatchTheProtocolSheetsVector) {
  Plant plant;
  Radio radio;
  radio.swa = base::Switch::Down;
  radio.swb = radio.swc = base::Switch::Middle;
  radio.right_lr = 0.25;
  radio.right_ud = -0.60;
  radio.vra = 1.5;  // cut to the end of its way
  plant.bunker.set_radio(radio);
  plant.wait(20ms);
  EXPECT_EQ(plant.last(0x241), frame_of(0x241, {0x97, 0x19, 0xC4, 0, 0, 0x64, 0, 0}));
}

TEST(Bus, TheOdometerWrapsAsTheBasesCounterDoes) {
  EXPECT_EQ(wrapped_mm(2147483.647), 2147483647);
  EXPECT_EQ(wrapped_mm(2147483.648), -2147483647 - 1);
  EXPECT_EQ(wrapped_mm(-0.001), -1);
  EXPECT_EQ(wrapped_pulses(-2.0), -2048);
}

TEST(Bus, EveryFrameComesWithItsRealPeriod) {
  Plant plant;
  plant.wait(10s);
  for (const std::uint32_t id : {0x221u, 0x241u, 0x251u, 0x252u, 0x311u}) {
    EXPECT_EQ(plant.of(id).size(), 500u) << std::hex << id;
  }
  for (const std::uint32_t id : {0x211u, 0x261u, 0x262u}) {
    EXPECT_EQ(plant.of(id).size(), 100u) << std::hex << id;
  }
  EXPECT_EQ(plant.of(0x361).size(), 20u);
  EXPECT_EQ(plant.frames.size(), 5u * 500u + 3u * 100u + 20u);
  const auto state = plant.of(0x211);
  const auto radio = plant.of(0x241);
  for (std::size_t i = 0; i < state.size(); ++i) EXPECT_EQ(state[i].data[7], i % 256);
  for (std::size_t i = 0; i < radio.size(); ++i) EXPECT_EQ(radio[i].data[7], i % 256);
}

// 0x231 of the protocol sheet, but for the count.
TEST(Bus, LightsAreToldFromTheirFirstCommandOn) {
  Plant plant;
  plant.wait(1s);
  EXPECT_TRUE(plant.of(0x231).empty());
  plant.bunker.receive(frame_of(0x121, {1, 3, 60, 0, 0, 0, 0, 9}));
  ASSERT_EQ(plant.of(0x231).size(), 1u);
  EXPECT_EQ(plant.last(0x231), frame_of(0x231, {1, 3, 0x3C, 0, 0, 0, 0, 0}));
  plant.wait(1s);
  EXPECT_EQ(plant.of(0x231).size(), 11u);
  plant.bunker.receive(frame_of(0x121, {0, 1, 0, 1, 0, 0, 0, 10}));
  EXPECT_EQ(plant.last(0x231), frame_of(0x231, {0, 0, 0, 0, 0, 0, 0, 11}));
}

TEST(Bus, FramesOfOtherKindsAreIgnored) {
  Plant plant;
  CanFrame f = mode_frame(1);
  f.extended = true;
  plant.bunker.receive(f);
  f = mode_frame(1);
  f.remote = true;
  plant.bunker.receive(f);
  f = mode_frame(1);
  f.error = true;
  plant.bunker.receive(f);
  plant.bunker.receive(frame_of(0x7FF, {1, 2, 3}));
  plant.wait(100ms);
  EXPECT_EQ(plant.truth().control_mode, base::ControlMode::Standby);
  plant.enter_can();
  plant.bunker.receive(frame_of(0x111, {3, 232, 0, 0, 0, 0, 0}));  // seven bytes
  plant.wait(400ms);
  EXPECT_EQ(plant.truth().driven_m, 0.0);
  EXPECT_EQ(plant.truth().commands, 0u);
}

TEST(Bus, NothingPassesWhileTheBusIsOff) {
  Plant plant;
  plant.enter_can();
  plant.drive(0.5, 0.0, 1s);
  Faults f;
  f.bus_off = true;
  ASSERT_TRUE(plant.bunker.set_faults(f));
  plant.forget();
  plant.drive(0.5, 0.0, 2s);
  EXPECT_TRUE(plant.frames.empty());
  EXPECT_EQ(plant.truth().commands, 50u);
  EXPECT_EQ(plant.truth().twist.linear_mps, 0.0);  // the base's own watchdog
}

TEST(Bus, FrameLossIsAShareInEachDirection) {
  Plant plant;
  Faults f;
  f.loss_to_base = 0.3;
  f.loss_from_base = 0.1;
  ASSERT_TRUE(plant.bunker.set_faults(f));
  plant.drive(0.5, 0.0, 100s);
  EXPECT_NEAR(static_cast<double>(plant.truth().commands) / 5000.0, 0.7, 0.03);
  EXPECT_NEAR(static_cast<double>(plant.frames.size()) / 28200.0, 0.9, 0.01);
}

TEST(Bus, APowerCycleBeginsAnew) {
  Plant plant;
  plant.enter_can();
  plant.drive(0.5, 0.0, 2s);
  EXPECT_GT(i32(plant.last(0x311), 0), 0);
  plant.bunker.power_cycle();
  plant.wait(100ms);
  EXPECT_EQ(i32(plant.last(0x311), 0), 0);
  EXPECT_EQ(plant.truth().control_mode, base::ControlMode::Standby);
  EXPECT_EQ(plant.truth().twist.linear_mps, 0.0);
}

void wander(Plant& plant) {
  plant.enter_can();
  Faults f;
  f.loss_from_base = 0.1;
  f.loss_to_base = 0.1;
  ASSERT_TRUE(plant.bunker.set_faults(f));
  plant.drive(0.8, 0.2, 5s);
  plant.drive(0.0, -0.5, 5s);
}

TEST(Bus, TheSameSeedAndInputsGiveTheSameBytesAndAnotherSeedDoesNot) {
  Plant a(Params{}, 42);
  Plant b(Params{}, 42);
  Plant c(Params{}, 43);
  wander(a);
  wander(b);
  wander(c);
  EXPECT_EQ(a.frames, b.frames);
  EXPECT_EQ(a.times, b.times);
  EXPECT_EQ(a.gnss, b.gnss);
  EXPECT_EQ(a.truth().local, b.truth().local);
  EXPECT_NE(a.gnss, c.gnss);
  EXPECT_NE(a.truth().local, c.truth().local);
}

TEST(Bus, TheSizeOfTheStepsOfTheCallerDoesNotMatter) {
  Plant a(Params{}, 7);
  Plant b(Params{}, 7);
  a.wait(3s);
  for (int i = 0; i < 1000; ++i) b.wait(3ms);
  EXPECT_EQ(a.frames, b.frames);
  EXPECT_EQ(a.gnss, b.gnss);
}

TEST(Bus, PlacingTheRobotStopsItThere) {
  Plant plant;
  plant.enter_can();
  plant.drive(0.5, 0.0, 1s);
  const base::LatLon there = plant.bunker.frame().to_global({100.0, -50.0});
  plant.bunker.place(there, 180.0);
  EXPECT_NEAR(plant.truth().local.east_m, 100.0, 1e-6);
  EXPECT_NEAR(plant.truth().local.north_m, -50.0, 1e-6);
  EXPECT_NEAR(plant.truth().yaw_rad, -base::kPi / 2.0, 1e-9);
  EXPECT_EQ(plant.truth().twist.linear_mps, 0.0);
}

}  // namespace
}  // namespace roverd::sim
