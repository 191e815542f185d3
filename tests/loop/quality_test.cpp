// Other receivers, other ground, long times.

#include "rig.hpp"

namespace roverd::loop {
namespace {

class Conditions : public testing::TestWithParam<std::uint64_t> {
 protected:
  RigOptions options() const {
    RigOptions o;
    o.seed = GetParam();
    return o;
  }
};
INSTANTIATE_TEST_SUITE_P(Loop, Conditions, testing::Values(1, 2));

TEST_P(Conditions, AConsumerReceiverKeepsTheCorridorAndDoesNotWeave) {
  RigOptions o = options();
  o.plant.gnss.profile = "consumer";
  Rig rig(o);
  rig.arm_and_start(rig.plan_of({{0, 25}, {15, 25}}));
  ASSERT_TRUE(rig.finish(150.0)) << rig.state()->mission.reason;
  EXPECT_LT(rig.nearest_m({0, 25}), 3.0);
  EXPECT_LT(rig.distance_to_m({15, 25}), 3.0);
  EXPECT_LT(rig.farthest_from_path_m({{0, 0}, {0, 25}, {15, 25}}), 3.0);
}

TEST_P(Conditions, SlipperyGroundStillMeetsEveryWaypoint) {
  RigOptions o = options();
  o.plant.drive.slip = 0.3;
  o.plant.drive.turn_loss = 1.5;
  Rig rig(o);
  const std::vector<Metres> way{{0, 8}, {8, 8}, {8, 0}};
  rig.arm_and_start(rig.plan_of(way));
  ASSERT_TRUE(rig.finish(200.0)) << rig.state()->mission.reason;
  for (const Metres& m : way) EXPECT_LT(rig.nearest_m(m), 0.3);
}

TEST_P(Conditions, SlowActuatorsDoNotMakeItWeave) {
  RigOptions o = options();
  o.plant.drive.delay_s = 0.2;
  o.plant.drive.lag_s = 0.2;
  o.robot.track.delay_s = 0.35;
  Rig rig(o);
  auto plan = rig.plan_of({{0, 25}}, 1.2);
  rig.arm_and_start(plan);
  ASSERT_TRUE(rig.finish(90.0)) << rig.state()->mission.reason;
  EXPECT_LT(rig.farthest_from_line_m({0, 0}, {0, 25}), 0.5);
  EXPECT_LT(rig.distance_to_m({0, 25}), 0.3);
}

TEST_P(Conditions, StandsForTenMinutesWithoutWandering) {
  RigOptions o = options();
  o.plant.gnss.profile = "consumer";
  Rig rig(o);
  rig.arm_and_start(rig.plan_of({{0, 5}}));
  ASSERT_TRUE(rig.finish(90.0));
  const auto pose = rig.state()->pose;
  ASSERT_TRUE(pose);
  rig.run(600.0);
  const auto later = rig.state()->pose;
  EXPECT_LT(base::distance_m(pose->at, later->at), 0.02);
  EXPECT_LT(std::abs(base::angle_diff_rad(pose->yaw_rad, later->yaw_rad)), 0.005);
  EXPECT_TRUE(rig.state()->armed);
}

TEST_P(Conditions, ALostRtkFixChangesToFloatAndSingleWithoutAJump) {
  Rig rig(options());
  rig.arm_and_start(rig.plan_of({{0, 40}}));
  ASSERT_TRUE(rig.run_until([&] { return rig.truth().driven_m > 8.0; }, 60.0));
  rig.fault([](sim::Faults& f) { f.gnss_fix = "rtk_float"; });
  rig.run(6.0);
  EXPECT_LT(rig.position_error_m(), 0.5);
  rig.fault([](sim::Faults& f) { f.gnss_fix = "gps"; });
  rig.run(6.0);
  EXPECT_LT(rig.position_error_m(), 1.0);
  rig.fault([](sim::Faults&) {});
  ASSERT_TRUE(rig.finish(90.0)) << rig.state()->mission.reason;
  EXPECT_LT(rig.farthest_from_line_m({0, 0}, {0, 40}), 1.2);
  EXPECT_LT(rig.distance_to_m({0, 40}), 0.3);
}

TEST_P(Conditions, AMissionsCorridorIsHeldByWhatIsKnownOfThePosition) {
  // Given a mission between rows that leave 25 cm to each side,
  Rig rig(options());
  auto plan = rig.plan_of({{0, 30}, {0, 150}});
  plan.settings.corridor_m = 0.25;
  rig.arm_and_start(plan);
  ASSERT_TRUE(rig.run_until([&] { return rig.truth().driven_m > 8.0; }, 60.0));
  EXPECT_FALSE(rig.has_condition("corridor"));
  // when the fix becomes too coarse for that,
  rig.fault([](sim::Faults& f) { f.gnss_fix = "gps"; });
  // then it creeps at first, and holds before it is beyond.
  ASSERT_TRUE(rig.run_until([&] { return rig.has_condition("corridor"); }, 120.0));
  ASSERT_TRUE(rig.run_until([&] { return rig.execution() == ExecutionState::Paused; }, 4.0));
  EXPECT_LT(rig.farthest_from_line_m({0, 0}, {0, 150}), 0.25);
  // With a good fix and the operator's word it goes on.
  rig.fault([](sim::Faults&) {});
  rig.run(12.0);
  ASSERT_TRUE(rig.ask(robot::ResumeMission{}));
  EXPECT_TRUE(rig.finish(240.0)) << rig.state()->mission.reason;
}

TEST_P(Conditions, AJumpThatStaysIsBelievedAfterTenSeconds) {
  Rig rig(options());
  rig.run(8.0);
  rig.fault([](sim::Faults& f) { f.gnss_jump_east_m = 3.0; });
  rig.run(5.0);
  EXPECT_LT(rig.position_error_m(), 0.3);
  rig.run(10.0);
  EXPECT_NEAR(rig.position_error_m(), 3.0, 0.2);
  EXPECT_TRUE(rig.has_event("estimate_reset"));
}

TEST_P(Conditions, AnAntennaBesideTheCentreIsAccountedFor) {
  RigOptions o = options();
  o.plant.gnss.antenna_forward_m = 0.3;
  o.plant.gnss.antenna_left_m = -0.2;
  o.robot.estimate.antenna_forward_m = 0.3;
  o.robot.estimate.antenna_left_m = -0.2;
  Rig rig(o);
  const std::vector<Metres> way{{0, 6}, {6, 6}, {6, 0}};
  rig.arm_and_start(rig.plan_of(way));
  ASSERT_TRUE(rig.finish(120.0)) << rig.state()->mission.reason;
  for (const Metres& m : way) EXPECT_LT(rig.nearest_m(m), 0.2);
}

}  // namespace
}  // namespace roverd::loop
