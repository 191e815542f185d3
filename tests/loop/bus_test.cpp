// Others on the robot's bus: what is a danger makes the robot hold, what is noise does not.

#include "bunker/codec.hpp"
#include "rig.hpp"

namespace roverd::loop {
namespace {

class Bus : public testing::Test {
 protected:
  /// Somewhere on a 20 m line northwards.
  void driving() {
    rig.arm_and_start(rig.plan_of({{0, 20}}));
    ASSERT_TRUE(rig.run_until([&] { return rig.truth().driven_m > 5.0; }, 60.0));
  }
  void tick_with(const base::CanFrame& f, int n) {
    for (int i = 0; i < n; ++i) {
      rig.put_on_bus(f);
      rig.tick();
    }
  }
  Rig rig{RigOptions{}};
};

TEST_F(Bus, ASecondCommanderStopsTheMissionAndNobodyArmsBesideIt) {
  driving();
  const auto theirs = bunker::encode(bunker::MotionCommand{{.linear_mps = 0.3}});
  tick_with(theirs, 200);
  EXPECT_TRUE(rig.has_condition("driver_hazard"));
  EXPECT_EQ(rig.execution(), ExecutionState::Paused);
  EXPECT_TRUE(rig.stands());
  // When it is silent for a second, the operator may go on
  rig.run(2.0);
  EXPECT_FALSE(rig.has_condition("driver_hazard"));
  ASSERT_TRUE(rig.ask(robot::ResumeMission{}));
  ASSERT_TRUE(rig.finish(60.0));
}

TEST_F(Bus, ImpossibleAndForeignFramesDoNotDisturbTheMission) {
  driving();
  base::CanFrame battery = bunker::encode(bunker::SystemState{.battery_v = 6553.5});
  battery.data[0] = 1;  // an emergency stop that nobody believes
  base::CanFrame foreign;
  foreign.id = 0x123;
  foreign.len = 8;
  for (int i = 0; i < 100; ++i) {
    tick_with(battery, 1);
    tick_with(foreign, 1);
    tick_with(bunker::encode(bunker::MotionState{{.linear_mps = 32.0}}), 1);
    tick_with(bunker::encode(bunker::Odometer{100'000'000, 0}), 1);
  }
  EXPECT_FALSE(rig.state()->estop);
  ASSERT_TRUE(rig.finish(60.0));
  EXPECT_LT(rig.distance_to_m({0, 20}), 0.2);
}

}  // namespace
}  // namespace roverd::loop
