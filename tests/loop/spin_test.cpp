// Tracks that spin in mud: the robot must not believe the way that they count.

#include "rig.hpp"

namespace roverd::loop {
namespace {

void set_slip(Rig& rig, double slip) {
  sim::Params params = rig.plant.params();
  params.drive.slip = slip;
  rig.plant.set_params(params);
}

TEST(SpinningTracks, AreCaughtBeforeAWaypointCountsAsReachedAndTheMissionGoesOnLater) {
  // Given a robot half way to its first waypoint
  Rig rig{RigOptions{}};
  rig.arm_and_start(rig.plan_of({{0, 10}, {0, 20}}));
  ASSERT_TRUE(rig.run_until([&] { return rig.truth().driven_m > 5.0; }, 60.0));
  // When its tracks lose their grip
  set_slip(rig, 0.9);
  ASSERT_TRUE(rig.run_until([&] { return rig.has_condition("wheels_spin"); }, 6.0));
  rig.run(3.0);
  // Then it stands, far from the waypoint, which is still its goal
  EXPECT_TRUE(rig.stands());
  EXPECT_EQ(rig.execution(), ExecutionState::Paused);
  EXPECT_EQ(rig.state()->mission.current_item, 1);
  EXPECT_GT(rig.distance_to_m({0, 10}), 3.5);
  // and knows where it stands
  const auto& pose = rig.state()->pose;
  ASSERT_TRUE(pose);
  const auto believed = rig.plant.frame().to_local(pose->global);
  EXPECT_LT(base::distance_m(believed, rig.truth().local), 0.2);
  // When it is freed and told to go on, then it passes both waypoints
  set_slip(rig, 0.08);
  const auto resumed = rig.ask(robot::ResumeMission{});
  ASSERT_TRUE(resumed) << resumed.error().detail;
  ASSERT_TRUE(rig.finish(90.0));
  EXPECT_LT(rig.nearest_m({0, 10}), 0.3);
  EXPECT_LT(rig.distance_to_m({0, 20}), 0.3);
}

TEST(SpinningTracks, AreNotSeenInOrdinarySlipAndPivots) {
  for (const double slip : {0.0, 0.3}) {
    RigOptions o;
    o.plant.drive.slip = slip;
    Rig rig{o};
    rig.arm_and_start(rig.plan_of({{0, 6}, {6, 6}, {6, 0}}));
    ASSERT_TRUE(rig.finish(120.0));
    for (const auto& event : rig.events) EXPECT_NE(event.kind, "mission_paused") << event.detail;
  }
}

}  // namespace
}  // namespace roverd::loop
