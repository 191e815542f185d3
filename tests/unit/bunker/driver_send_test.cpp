// What the driver says to the base, and when it keeps quiet.

#include <cmath>

#include "driver_fixture.hpp"

namespace roverd::bunker {
namespace {

const CanFrame kCanMode = encode(ControlModeCommand{RequestedMode::Can});
const CanFrame kStandby = encode(ControlModeCommand{RequestedMode::Standby});
const CanFrame kZero = encode(MotionCommand{});

TEST_F(BunkerDriverTest, SaysNothingWhileNobodyWantsToDrive) {
  up(0);
  rounds(100, off());
  EXPECT_TRUE(commands.empty());
}

TEST_F(BunkerDriverTest, AsksABaseInStandbyForCanModeTwiceASecond) {
  up(0);
  rounds(100, ahead(0.5));
  EXPECT_EQ(sent(id::kControlMode).size(), 4u) << "in two seconds";
  EXPECT_EQ(sent(id::kControlMode).front(), kCanMode);
  EXPECT_TRUE(sent(id::kMotionCommand).empty()) << "standby obeys no motion";
}

TEST_F(BunkerDriverTest, CommandsEveryTwentyMillisecondsOnceTheBaseIsInCanMode) {
  up(0);
  round(ahead(0.15));
  base_mode = 1;
  rounds(10, ahead(0.15));
  EXPECT_EQ(sent(id::kControlMode).size(), 1u);
  EXPECT_EQ(sent(id::kMotionCommand).size(), 10u);
  EXPECT_DOUBLE_EQ(last_linear(), 0.15);
  rounds(10, ahead(0.0));
  EXPECT_EQ(sent(id::kMotionCommand).size(), 20u) << "standing still is commanded too";
  EXPECT_EQ(status().sent, 21u);
}

TEST_F(BunkerDriverTest, CutsCommandsToTheLimits) {
  up(1);
  rounds(20, ahead(9.0, -9.0));
  const auto m = std::get<MotionCommand>(decode(sent(id::kMotionCommand).back()).message);
  EXPECT_DOUBLE_EQ(m.linear_mps, 1.5);
  EXPECT_DOUBLE_EQ(m.angular_radps, -0.785);
  EXPECT_EQ(driver->gate_counts().refused_total(), 0u);
}

TEST_F(BunkerDriverTest, ASuddenWishBecomesAFewStepsAndAStopIsImmediate) {
  up(1);
  round(ahead(1.0));
  EXPECT_DOUBLE_EQ(last_linear(), 0.2);
  rounds(4, ahead(1.0));
  EXPECT_DOUBLE_EQ(last_linear(), 1.0);
  round(ahead(-1.0));
  EXPECT_DOUBLE_EQ(last_linear(), -0.2) << "a reversal begins at zero";
  round(ahead(0.0));
  EXPECT_DOUBLE_EQ(last_linear(), 0.0);
  EXPECT_EQ(driver->gate_counts().refused_total(), 0u);
}

TEST_F(BunkerDriverTest, ABrokenCommandIsAStop) {
  up(1);
  rounds(3, ahead(0.4));
  round(ahead(std::nan(""), 0.3));
  EXPECT_EQ(sent(id::kMotionCommand).back(), kZero);
}

TEST_F(BunkerDriverTest, KeepsQuietWhileTheRadioDrivesAndAsksAgainAfterwards) {
  up(1);
  rounds(5, ahead(0.5));
  // When the operator takes over
  commands.clear();
  base_mode = 3;
  rounds(200, ahead(0.5));
  EXPECT_TRUE(commands.empty());
  // and gives back: the base is in standby
  base_mode = 0;
  round(ahead(0.5));
  EXPECT_EQ(commands, std::vector<CanFrame>{kCanMode});
  base_mode = 1;
  round(ahead(0.5));
  EXPECT_DOUBLE_EQ(last_linear(), 0.2) << "speed begins at zero again";
}

TEST_F(BunkerDriverTest, KeepsQuietInSerialAndUnknownMode) {
  up(2);
  rounds(60, ahead(0.5));
  base_mode = 9;
  rounds(60, ahead(0.5));
  EXPECT_TRUE(commands.empty());
}

TEST_F(BunkerDriverTest, StopsWithSeveralZerosThenStandbyOnce) {
  up(1);
  rounds(5, ahead(0.5));
  commands.clear();
  rounds(100, off());
  ASSERT_EQ(commands.size(), 6u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(commands[i], kZero) << i;
  EXPECT_EQ(commands[5], kStandby);
}

TEST_F(BunkerDriverTest, StandbyWaitsUntilTheRadioHasGivenBack) {
  up(1);
  rounds(5, ahead(0.5));
  commands.clear();
  base_mode = 3;
  rounds(50, off());
  EXPECT_TRUE(commands.empty());
  base_mode = 0;
  rounds(50, off());
  ASSERT_FALSE(commands.empty());
  EXPECT_EQ(commands.back(), kStandby);
  EXPECT_EQ(sent(id::kControlMode).size(), 1u);
}

TEST_F(BunkerDriverTest, WithoutFreshFeedbackOnlyZerosLeave) {
  up(1);
  rounds(10, ahead(0.5));
  base_talks = false;
  rounds(15, ahead(0.5));  // 0.3 s
  EXPECT_DOUBLE_EQ(last_linear(), 0.5);
  commands.clear();
  rounds(5, ahead(0.5));
  ASSERT_EQ(commands.size(), 5u);
  for (const CanFrame& f : commands) EXPECT_EQ(f, kZero);
  // When the base is back before it counts as lost
  base_talks = true;
  rounds(5, ahead(0.5));
  EXPECT_DOUBLE_EQ(last_linear(), 0.5);
}

TEST_F(BunkerDriverTest, ALostBaseHearsNothingAndIsAskedAgainWhenItIsBack) {
  up(1);
  rounds(10, ahead(0.5));
  base_talks = false;
  rounds(30, ahead(0.5));
  EXPECT_EQ(status().phase, DriverPhase::Faulty);
  commands.clear();
  rounds(100, ahead(0.5));
  EXPECT_TRUE(commands.empty());
  base_talks = true;
  base_mode = 0;
  rounds(5, ahead(0.5));
  EXPECT_EQ(status().phase, DriverPhase::Up);
  EXPECT_EQ(commands, std::vector<CanFrame>{kCanMode});
}

TEST_F(BunkerDriverTest, AnEmergencyStopOfTheBaseLetsOnlyZerosOut) {
  up(1);
  rounds(10, ahead(0.5));
  commands.clear();
  now += 20ms;
  hear(encode(MotionState{}));
  hear(state(1, 1));
  driver->send(ahead(0.5), now);
  wire.b->deliver(now);
  EXPECT_EQ(commands, std::vector<CanFrame>{kZero});
}

TEST_F(BunkerDriverTest, AFullBusDoesNotMakeTheRobotJerk) {
  // Given a wire that is full for one round
  up(1);
  rounds(10, ahead(0.5));
  CanFrame filler = kZero;
  while (ours->send(filler) == link::SendResult::Sent) {
  }
  driver->send(ahead(0.5), now);
  wire.b->deliver(now);
  commands.clear();
  round(ahead(0.5));
  EXPECT_DOUBLE_EQ(last_linear(), 0.5) << "no new start from zero";
}

TEST_F(BunkerDriverTest, StoppingTheDriverSendsZerosAndStandbyFirst) {
  up(1);
  rounds(10, ahead(0.5));
  commands.clear();
  // The wire forgets what waits when an end closes, so the frames are caught as they are sent.
  ours->set_immediate([this] { return now; });
  driver->stop(now);
  EXPECT_EQ(commands, (std::vector<CanFrame>{kZero, kZero, kZero, kStandby}));
  EXPECT_EQ(status().phase, DriverPhase::Down);
  EXPECT_EQ(measured<base::DriverStatus>().back().phase, DriverPhase::Down);
  commands.clear();
  driver->send(ahead(0.5), now);
  driver->stop(now);
  driver->tick(now + 60s);
  EXPECT_TRUE(commands.empty());
  EXPECT_EQ(status().phase, DriverPhase::Down) << "down stays down";
}

TEST_F(BunkerDriverTest, ABaseThatWasNeverOursIsLeftAloneAtShutdown) {
  up(1);
  ours->set_immediate([this] { return now; });
  driver->stop(now);
  EXPECT_TRUE(commands.empty());
}

TEST_F(BunkerDriverTest, CanBeRestarted) {
  up(1);
  driver->restart(now);
  EXPECT_EQ(status().phase, DriverPhase::Opening);
  hear(state(0, 1));
  EXPECT_EQ(status().phase, DriverPhase::Up);
}

TEST_F(BunkerDriverTest, ClearsErrorsOnRequestWhileUp) {
  EXPECT_FALSE(driver->clear_errors(0, now));
  up(0);
  EXPECT_TRUE(driver->clear_errors(0, now));
  wire.b->deliver(now);
  EXPECT_EQ(commands, std::vector<CanFrame>{encode(ClearErrors{})});
}

}  // namespace
}  // namespace roverd::bunker
