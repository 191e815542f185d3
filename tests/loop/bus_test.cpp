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
  EXPECT_FALSE(rig.state()->armed);
  // When it is silent for a second, the operator may arm again and go on.
  rig.run(2.0);
  EXPECT_FALSE(rig.has_condition("driver_hazard"));
  rig.arm();
  ASSERT_TRUE(rig.ask(robot::ResumeMission{}));
  ASSERT_TRUE(rig.finish(60.0));
}

TEST_F(Bus, NobodyArmsBesideASecondCommander) {
  ASSERT_TRUE(rig.run_until([&] { return rig.state()->ready_to_arm; }, 30.0));
  const auto theirs = bunker::encode(bunker::MotionCommand{{.linear_mps = 0.3}});
  tick_with(theirs, 5);
  EXPECT_FALSE(rig.state()->ready_to_arm);
  const auto refused = rig.ask(robot::Arm{});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, base::Code::Conflict);
  ASSERT_EQ(refused.error().fields.size(), 1u);
  EXPECT_EQ(refused.error().fields[0].pointer, "/checks/driver_hazard");
  EXPECT_NE(refused.error().detail.find("somebody else sends motion commands (0x111)"),
            std::string::npos);
  rig.run(2.0);
  rig.arm();
}

TEST_F(Bus, ASecondCommanderWhoIsHeardAfterArmingOnlyDisarmsAtOnce) {
  ASSERT_TRUE(rig.run_until([&] { return rig.state()->ready_to_arm; }, 30.0));
  const auto theirs = bunker::encode(bunker::MotionCommand{{.linear_mps = 0.3}});
  // Between the checks that allowed it and the word of arming, and while it stands in HOLD.
  for (const int later : {0, 1, 50}) {
    rig.arm();
    const std::uint64_t events = rig.events.size();
    rig.run(0.02 * later);
    tick_with(theirs, 3);
    EXPECT_FALSE(rig.state()->armed) << later;
    EXPECT_FALSE(rig.state()->command.enabled) << later;
    EXPECT_TRUE(std::any_of(
        rig.events.begin() + static_cast<long>(events), rig.events.end(), [](const base::Event& e) {
          return e.kind == "disarmed" && e.detail.find("somebody else") != std::string::npos;
        }));
    rig.run(2.5);
  }
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
