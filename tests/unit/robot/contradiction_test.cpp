// What follows from sensors that contradict each other, in words and deeds.

#include "field.hpp"
#include "robot/safety/made_up.hpp"
#include "robot/safety/reset_latch.hpp"
#include "robot/safety/safety.hpp"
#include "robot/safety/votes_watch.hpp"

namespace roverd::robot {
namespace {

using base::Sense;

base::Votes lying(Sense liar, base::Difference off, std::vector<Sense> against) {
  base::Votes v;
  auto& vote = v.of[static_cast<std::size_t>(liar)];
  vote.left_out = true;
  vote.off = off;
  for (const Sense s : against) vote.against[static_cast<std::size_t>(s)] = true;
  return v;
}

TEST(ContradictionWords, SayWhoDoesWhatBesideWhomAndByHowMuch) {
  EXPECT_EQ(contradiction_words(
                lying(Sense::Gyro, {base::Difference::Of::Turn, base::rad_from_deg(8.0), 4.0},
                      {Sense::Tracks, Sense::Velocity}),
                Sense::Gyro),
            "the gyro turns 2.0 deg/s farther left than odometry and the satellites' velocity say");
  EXPECT_EQ(contradiction_words(lying(Sense::Position, {base::Difference::Of::Way, 3.04, 2.5},
                                      {Sense::Tracks, Sense::Gyro, Sense::Velocity}),
                                Sense::Position),
            "the satellites' position tells of a way that within 2.5 s is off by 3.0 m from what "
            "odometry, the gyro and the satellites' velocity say");
  base::Votes v;
  v.undecided = {Sense::Gyro, Sense::Velocity};
  v.undecided_off = {base::Difference::Of::Turn, base::rad_from_deg(-30.0), 4.0};
  EXPECT_EQ(undecided_words(v),
            "the gyro and the satellites' velocity differ by 30.0 deg within 4.0 s, and it cannot "
            "be told which one is wrong");
}

TEST(VotesWatch, TellsOnceOfEachChange) {
  VotesWatch watch;
  EXPECT_TRUE(watch.step({}).empty());
  const auto v = lying(Sense::Gyro, {}, {});
  ASSERT_EQ(watch.step(v).size(), 1u);
  EXPECT_TRUE(watch.step(v).empty());
  ASSERT_EQ(watch.step({}).size(), 1u);
  EXPECT_TRUE(watch.step({}).empty());
}

class Latch : public testing::Test {
 protected:
  bool reset(double moved_m, double claimed_m, double at_s, double turned_deg = 0.0,
             double claimed_deg = 1.0) {
    ++h_.resets;
    base::EstimateReset r;
    r.what = "position";
    r.jump = {moved_m, 0.0};
    r.claimed_m = claimed_m;
    r.jump_rad = base::rad_from_deg(turned_deg);
    r.claimed_rad = base::rad_from_deg(claimed_deg);
    h_.last_reset = r;
    return latch.step(h_, armed, 60.0, Time{base::from_seconds(at_s)});
  }
  ResetLatch latch;
  bool armed = true;
  base::EstimatorHealth h_;
};

TEST_F(Latch, OverAMetreAndOverFiveSigmasLatches) {
  EXPECT_FALSE(reset(1.0, 0.01, 0.0));
  EXPECT_FALSE(reset(5.0, 1.0, 100.0));
  EXPECT_TRUE(latch.why().empty());
  EXPECT_TRUE(reset(1.01, 0.2, 200.0));
  EXPECT_NE(latch.why().find("1.0 m away"), std::string::npos) << latch.why();
  latch.acknowledge();
  EXPECT_FALSE(reset(0.0, 0.01, 300.0, 20.0));
  EXPECT_TRUE(reset(0.0, 0.01, 400.0, -20.5, 4.0));
}

TEST_F(Latch, TwiceWithinAMinuteLatchesAndAPersonsOwnWordDoesNot) {
  EXPECT_FALSE(reset(0.6, 0.01, 0.0));
  EXPECT_FALSE(reset(0.5, 0.01, 30.0));  // so little does not count
  EXPECT_FALSE(reset(0.6, 0.01, 60.0));
  EXPECT_TRUE(reset(0.6, 0.01, 119.9));
  latch.acknowledge();
  EXPECT_FALSE(reset(0.6, 0.01, 130.0));
  ++h_.resets;
  latch.moved_on_purpose(h_);
  EXPECT_FALSE(latch.step(h_, true, 60.0, Time{base::from_seconds(131.0)}));
  EXPECT_FALSE(reset(0.6, 0.01, 132.0));
}

TEST_F(Latch, WhatHappensWhileDisarmedIsToldToWhoeverArmsAndNoMore) {
  armed = false;
  EXPECT_FALSE(reset(30.0, 0.01, 0.0));
  EXPECT_TRUE(latch.why().empty());
  EXPECT_NE(latch.disarmed_why().find("30.0 m away"), std::string::npos) << latch.disarmed_why();
  latch.armed();
  EXPECT_TRUE(latch.disarmed_why().empty());
}

TEST(Contradiction, WhereItIsUnsureOfItsPlaceItDoesNotCreepOnWithoutPositions) {
  MadeUp m;
  m.estimate.votes = lying(Sense::Position, {}, {Sense::Tracks, Sense::Velocity});
  m.pose->horizontal_sigma_m = m.params.contradiction_sigma_m - 0.01;
  EXPECT_EQ(assess(m.facts, m.params, m.now).response, Response::Slow);
  m.pose->horizontal_sigma_m = m.params.contradiction_sigma_m + 0.01;
  EXPECT_EQ(assess(m.facts, m.params, m.now).response, Response::Hold);
  // A consumer's receiver that agrees with the others is never surer, and drives.
  m.estimate.votes = {};
  EXPECT_EQ(assess(m.facts, m.params, m.now).response, Response::None);
}

TEST(Contradiction, AReceiverThatJumpsBeforeItIsProvedHoldsAtOnce) {
  // Given a robot that has just begun to drive: what positions told while it stood proves nothing
  Field f;
  f.drive_mission();
  // When its receiver jumps
  f.receiver_off = {2.5, 0.0};
  f.run(2.0);
  // Then either place may be the wrong one
  EXPECT_TRUE(f.has_condition("sensor_left_out"));
  EXPECT_EQ(f.execution(), ExecutionState::Paused);
  EXPECT_GT(f.state()->pose->horizontal_sigma_m, 2.0);
}

TEST(Contradiction, AReceiverThatJumpsIsLeftOutHoldsAndItsReturnWantsAPerson) {
  // Given a robot on its way, for so long that a wrong receiver would have contradicted itself
  Field f;
  f.run(8.0);
  ASSERT_TRUE(f.load(plan_of({{0, 20}, {0, 60}})));
  ASSERT_TRUE(f.ask(Arm{}));
  ASSERT_TRUE(f.ask(StartMission{"m", 1}));
  f.run(14.0);
  // When its receiver jumps, then it claims no more than it knows until the liar is found
  f.receiver_off = {2.5, 0.0};
  f.run(0.5);
  EXPECT_GT(f.state()->pose->horizontal_sigma_m, 2.0);
  f.run(1.5);
  EXPECT_TRUE(f.has_condition("sensor_left_out"));
  EXPECT_TRUE(f.has_event("sensor_left_out"));
  // and then goes on as it would without the receiver, whose jump it never believed
  EXPECT_EQ(f.execution(), ExecutionState::Running);
  EXPECT_LT(f.state()->pose->horizontal_sigma_m, 0.2);
  // When it stays there
  f.run(8.0);
  // Then a person has to choose
  EXPECT_EQ(f.execution(), ExecutionState::Paused);
  ASSERT_TRUE(f.has_condition("base_moved"));
  EXPECT_GT(f.state()->pose->horizontal_sigma_m, 2.0);
  EXPECT_FALSE(f.ask(ResumeMission{}));
  ASSERT_TRUE(f.ask(SettleShift{true}));
  f.run(0.1);
  EXPECT_FALSE(f.has_condition("base_moved"));
  EXPECT_TRUE(f.ask(ResumeMission{}));
}

TEST(Contradiction, APlaceThatIsSetAnewFarAwayWantsAPerson) {
  Field f;
  f.drive_mission();
  f.receiver_off = {60.0, 0.0};
  f.run(20.0);
  EXPECT_EQ(f.execution(), ExecutionState::Paused);
  ASSERT_TRUE(f.has_condition("estimate_latched"));
  EXPECT_GT(f.state()->pose->horizontal_sigma_m, 2.0);
  const auto refused = f.ask(ResumeMission{});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().detail.find("acknowledge"), std::string::npos);
  ASSERT_TRUE(f.ask(Acknowledge{}));
  f.run(0.1);
  EXPECT_FALSE(f.has_condition("estimate_latched"));
  EXPECT_TRUE(f.ask(ResumeMission{}));
  EXPECT_TRUE(f.ask(Acknowledge{}));  // again: nothing to do
}

TEST(Contradiction, ALatchedEstimateIsNotArmedByUnlessAPersonLooked) {
  Field f;
  f.drive_mission();
  f.receiver_off = {60.0, 0.0};
  f.run(20.0);
  ASSERT_TRUE(f.has_condition("estimate_latched"));
  ASSERT_TRUE(f.ask(Disarm{}));
  f.run(0.1);
  EXPECT_FALSE(f.check("estimate").ok);
  EXPECT_FALSE(f.ask(Arm{}));
  ASSERT_TRUE(f.ask(Acknowledge{}));
  f.run(0.1);
  EXPECT_TRUE(f.ask(Arm{}));
}

}  // namespace
}  // namespace roverd::robot
